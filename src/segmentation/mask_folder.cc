// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/mask_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/content_hash.h"
#include "files/json_file.h"
#include "files/paths.h"
#include "files/staged_file.h"
#include "hullslam/masks/mask_source.h"
#include "hullslam/util/error.h"
#include "masks/yolo_text.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

constexpr const char* kRecord = "segment.json";

// Names of files may be in any encoding, but JSON is in UTF-8.
std::string AsText(const fs::path& path) {
  const std::string name = path.string();
  if (IsUtf8(name)) {
    return name;
  }
  std::string text;
  for (const char byte : name) {
    const bool is_ascii = static_cast<unsigned char>(byte) < 0x80;
    text += is_ascii ? std::string(1, byte)
                     : fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
  }
  return text;
}

std::string ClassLines(const Segmenter& segmenter) {
  std::string lines;
  for (const std::string& name : segmenter.class_names()) {
    lines += name + '\n';
  }
  return lines;
}

// The hash of the pixels of a frame; null if it cannot be read.
Json HashOfFrame(const ImageSequence& sequence, size_t frame) {
  try {
    const cv::Mat image = sequence.load_colour(sequence.frames.at(frame)).clone();
    return ContentHash(image.data, image.total() * image.elemSize());
  } catch (const InputError&) {
    return nullptr;
  }
}

// The frame by which an input is known again: that of the former record, because a folder may get
// more images, else the first one. Null if the input has no such frame.
Json KnownFrame(const SegmentSource& source, const Json& former) {
  const std::vector<MaskFrame> frames = MaskFrames(source.sequence);
  const Json stem = former.value(Json::json_pointer("/frame/name"), Json());
  const auto found = stem.is_string() ? std::ranges::find_if(frames,
                                                             [&](const MaskFrame& frame) {
                                                               return AsText(frame.stem) ==
                                                                      stem.get<std::string>();
                                                             })
                                      : frames.begin();
  if (found == frames.end()) {
    return nullptr;
  }
  const auto index = static_cast<size_t>(found - frames.begin());
  return {{"name", AsText(found->stem)}, {"pixels", HashOfFrame(source.sequence, index)}};
}

Json MakeRecord(const SegmentSource& source, const Json& former) {
  std::error_code error;
  const bool is_file = fs::is_regular_file(source.input, error);
  const std::string classes = ClassLines(source.segmenter);
  return {{"input", AsText(CanonicalPath(source.input))},
          {"bytes", is_file ? Json(fs::file_size(source.input, error)) : Json()},
          {"frame", KnownFrame(source, former)},
          {"side_by_side", source.choices.contains("side_by_side")},
          {"choices", source.sequence.choices},  // such as the topic of a recording
          {"network", AsText(source.network.filename())},
          {"network_hash", source.segmenter.network_hash()},
          {"min_score", source.options.min_score},
          {"size", source.options.size},
          {"classes", source.options.classes},
          {"names", ContentHash(classes.data(), classes.size())},
          {"boxes", source.options.use_boxes}};
}

// The values of a record that differ from those of the other one, for a message. The name of the
// network's file is for people; its hash decides.
std::string DescribeDifference(const Json& record, const Json& other) {
  std::string text;
  for (const auto& [key, value] : record.items()) {
    if (key != "network" && (!other.contains(key) || other[key] != value)) {
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value.dump());
    }
  }
  return text;
}

void CheckRecord(const fs::path& folder, const Json& former, const Json& record) {
  const std::string now = DescribeDifference(record, former);
  if (!now.empty()) {
    throw InputError(
        fmt::format("{}: has masks that were made with {}, not with {}; choose another --output, "
                    "or delete them",
                    folder.string(), DescribeDifference(former, record), now));
  }
}

// Whether the folder has files, but for what a call has left that was killed while it wrote the
// record.
bool HasFiles(const fs::path& folder) {
  StagingFolder::Abandoned(folder, fmt::format(".{}.", kRecord));
  std::error_code error;
  return !fs::is_empty(folder, error);
}

}  // namespace

void PrepareMaskFolder(const fs::path& folder, const SegmentSource& source) {
  const fs::path file = folder / kRecord;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": cannot be made, expected a folder");
  }
  const FolderLock lock(folder);  // of two calls at once, one writes the record
  if (fs::exists(file, error)) {
    const Json former = ReadJson(file);
    if (!former.is_object()) {
      throw InputError(file.string() + ": is no record of this command");
    }
    CheckRecord(folder, former, MakeRecord(source, former));
  } else if (HasFiles(folder)) {
    throw InputError(folder.string() +
                     ": contains files, but no masks of this command; choose another --output");
  } else {
    WriteFileAtomically(file, MakeRecord(source, Json::object()).dump() + '\n');
  }
  // A former call may have been killed before it came here.
  WriteFileAtomically(folder / kClassNames, ClassLines(source.segmenter));
}

MaskFolderWork FindMaskWork(const fs::path& folder, const ImageSequence& sequence, size_t every) {
  MaskFolderWork work;
  const std::vector<MaskFrame> names = MaskFrames(sequence);
  for (size_t i = 0; i < names.size(); i += every) {
    ++work.frames;
    const fs::path file = folder / (names[i].stem + ".txt");
    std::error_code error;
    if (file.filename() == kClassNames) {
      work.unread.push_back(
          fmt::format("{}: its masks would be in {}, which has the names of the classes",
                      sequence.frames[i].image.string(), file.string()));
    } else if (fs::exists(file, error)) {
      ++work.done;
    } else {
      work.left.emplace_back(&sequence.frames[i], file);
    }
  }
  return work;
}

void MakeMaskFile(const ImageSequence& sequence, size_t left, Segmenter& segmenter,
                  MaskFolderWork& work) {
  const auto& [frame, file] = work.left.at(left);
  cv::Mat image;
  try {
    image = sequence.load_colour(*frame);
  } catch (const InputError& error) {
    work.unread.emplace_back(error.what());
    return;
  }
  std::vector<InstanceMask> masks;
  try {
    masks = segmenter.Segment(image);
  } catch (const InputError& error) {
    if (work.failed++ == 0) {
      work.first_failure = fmt::format("{}: {}", frame->image.filename().string(), error.what());
    }
    return;
  }
  WriteFileAtomically(file, YoloText(masks, segmenter.class_names(), image.size()));
  ++work.made;
  ++work.done;
  for (const InstanceMask& mask : masks) {
    ++work.instances[mask.label];
  }
}

}  // namespace hullslam
