// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_classes.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "files/read_file.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

// The identifiers between 1 and 90 that the annotations of COCO never use.
constexpr std::array<int64_t, 10> kGaps = {12, 26, 29, 30, 45, 66, 68, 69, 71, 83};

}  // namespace

const std::vector<std::string>& CocoClasses() {
  static const std::vector<std::string> names = {"person",        "bicycle",      "car",
                                                 "motorcycle",    "airplane",     "bus",
                                                 "train",         "truck",        "boat",
                                                 "traffic light", "fire hydrant", "stop sign",
                                                 "parking meter", "bench",        "bird",
                                                 "cat",           "dog",          "horse",
                                                 "sheep",         "cow",          "elephant",
                                                 "bear",          "zebra",        "giraffe",
                                                 "backpack",      "umbrella",     "handbag",
                                                 "tie",           "suitcase",     "frisbee",
                                                 "skis",          "snowboard",    "sports ball",
                                                 "kite",          "baseball bat", "baseball glove",
                                                 "skateboard",    "surfboard",    "tennis racket",
                                                 "bottle",        "wine glass",   "cup",
                                                 "fork",          "knife",        "spoon",
                                                 "bowl",          "banana",       "apple",
                                                 "sandwich",      "orange",       "broccoli",
                                                 "carrot",        "hot dog",      "pizza",
                                                 "donut",         "cake",         "chair",
                                                 "couch",         "potted plant", "bed",
                                                 "dining table",  "toilet",       "tv",
                                                 "laptop",        "mouse",        "remote",
                                                 "keyboard",      "cell phone",   "microwave",
                                                 "oven",          "toaster",      "sink",
                                                 "refrigerator",  "book",         "clock",
                                                 "vase",          "scissors",     "teddy bear",
                                                 "hair drier",    "toothbrush"};
  return names;
}

std::optional<std::string> CocoCategory(int64_t id) {
  const auto gap = std::lower_bound(kGaps.begin(), kGaps.end(), id);
  if (id < 1 || id > 90 || (gap != kGaps.end() && *gap == id)) {
    return std::nullopt;
  }
  return CocoClasses()[static_cast<size_t>(id - 1 - (gap - kGaps.begin()))];
}

std::vector<std::string> ReadClasses(const std::filesystem::path& folder) {
  constexpr size_t kMostBytes = 1'000'000;
  const std::filesystem::path path = folder / "classes.txt";
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return CocoClasses();
  }
  const std::string text = ReadText(path, kMostBytes);
  CheckUtf8(path, text);
  std::vector<std::string> names;
  for (const std::string_view line : LinesOf(text)) {
    names.emplace_back(Trim(line));
  }
  while (!names.empty() && names.back().empty()) {
    names.pop_back();
  }
  if (names.empty()) {
    throw InputError(path.string() + ": has no names, expected one per line");
  }
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) {
      throw InputError(path.string() + ':' + std::to_string(i + 1) +
                       ": is empty, expected the name of class " + std::to_string(i));
    }
  }
  return names;
}

}  // namespace hullslam
