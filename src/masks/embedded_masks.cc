// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/embedded_masks.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "files/npy_file.h"
#include "hullslam/util/error.h"
#include "masks/mask_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNpyExtension = ".npy";

bool IsZero(std::span<const float> vector) {
  return std::all_of(vector.begin(), vector.end(), [](float element) { return element == 0.0F; });
}

class EmbeddedMasks : public MaskSource {
 public:
  EmbeddedMasks(std::unique_ptr<const MaskSource> source, fs::path folder,
                std::set<std::string> stems, size_t length)
      : source_(std::move(source)),
        folder_(std::move(folder)),
        stems_(std::move(stems)),
        length_(length) {}

  std::string format() const override { return source_->format(); }
  bool Contains(const MaskFrame& frame) const override { return source_->Contains(frame); }
  std::string Example() const override { return source_->Example(); }

  FrameMasks Read(const MaskFrame& frame) const override {
    FrameMasks result = source_->Read(frame);
    if (!stems_.contains(frame.stem)) {
      return result;
    }
    const fs::path path = folder_ / (frame.stem + std::string(kNpyExtension));
    const FloatRows rows = ReadNpy(path);
    const size_t count = result.masks.size() + result.without_area;
    if (rows.rows != count || (count > 0 && rows.columns != length_)) {
      throw InputError(fmt::format(
          "{}: {} vector(s) of {} numbers, expected one for each of the {} instance(s) of the "
          "frame, and {} numbers as in the first such file",
          path.string(), rows.rows, rows.columns, count, length_));
    }
    for (size_t i = 0; i < result.masks.size(); ++i) {
      const auto row = rows.Row(result.rows[i]);
      result.masks[i].embedding.assign(row.begin(), row.end());
      if (IsZero(row)) {
        throw InputError(
            fmt::format("{}: row {} has only zeros, expected a vector with a direction",
                        path.string(), result.rows[i]));
      }
    }
    return result;
  }

 private:
  std::unique_ptr<const MaskSource> source_;
  fs::path folder_;
  std::set<std::string> stems_;
  size_t length_;
};

}  // namespace

fs::path EmbeddingFolder(const fs::path& masks) {
  std::error_code error;
  return fs::is_directory(masks, error) ? masks : masks.parent_path() / masks.stem();
}

std::unique_ptr<const MaskSource> AddEmbeddings(std::unique_ptr<const MaskSource> source,
                                                const fs::path& folder,
                                                std::span<const MaskFrame> frames) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return source;
  }
  std::set<std::string> stems = ListFiles(folder, kNpyExtension);
  size_t length = 0;
  for (const MaskFrame& frame : frames) {
    if (length == 0 && stems.contains(frame.stem)) {
      length = ReadNpy(folder / (frame.stem + std::string(kNpyExtension))).columns;
    }
  }
  if (length == 0) {
    return source;
  }
  return std::make_unique<EmbeddedMasks>(std::move(source), folder, std::move(stems), length);
}

}  // namespace hullslam
