// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_probe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>
#include <system_error>

#include "files/json_file.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "masks/mask_checks.h"
#include "masks/mask_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostColumns = 64;  // enough to recognise a format

constexpr size_t kEnoughColumns = 5;  // of a box; fewer do not tell the format

// Stores the first row of a text file, or the first one with enough columns. Returns false if there
// is no such row.
bool ProbeRow(const fs::path& path, MaskProbe& probe) {
  CheckFileSize(path, kMostFrameFileBytes);
  ForEachRow(path, [&](const TextRow& row) {
    if (probe.columns == 0 ||
        (probe.columns < kEnoughColumns && row.columns.size() >= kEnoughColumns)) {
      probe.row_file = path.filename().string();
      probe.columns = row.columns.size();
      const size_t shown = std::min(row.columns.size(), kMostColumns);
      probe.row.assign(row.columns.begin(), row.columns.begin() + static_cast<ptrdiff_t>(shown));
    }
  });
  return probe.columns >= kEnoughColumns;
}

// The names that the files of these frames may have. The format `paper` numbers them.
std::set<std::string> NamesOf(std::span<const MaskFrame> frames) {
  std::set<std::string> names;
  for (const MaskFrame& frame : frames) {
    names.insert({frame.stem, frame.video_name, fmt::format("{:06}", frame.number)});
  }
  return names;
}

// The files with an ending that are no list of classes, and of these the ones named as frames.
struct NamedFiles {
  std::set<std::string> all;
  std::set<std::string> of_frames;
};

NamedFiles FindNamed(const fs::path& folder, const std::string& ending,
                     const std::set<std::string>& frames) {
  NamedFiles files{.all = ListFiles(folder, ending), .of_frames = {}};
  files.all.erase("classes");
  std::ranges::set_intersection(files.all, frames,
                                std::inserter(files.of_frames, files.of_frames.end()));
  return files;
}

void ProbeFolder(std::span<const MaskFrame> frames, MaskProbe& probe) {
  std::error_code error;
  probe.has_images = !ListFiles(probe.path, ".png").empty();
  probe.has_classes_json = fs::exists(probe.path / "classes.json", error);
  probe.has_paper_folder = fs::is_directory(probe.path / "segmentation_txt", error);
  const std::set<std::string> names = NamesOf(frames);
  NamedFiles jsons = FindNamed(probe.path, ".json", names);
  NamedFiles texts = FindNamed(probe.path, ".txt", names);
  probe.has_names_of_frames = !jsons.of_frames.empty() || !texts.of_frames.empty();
  const std::set<std::string>& counted = probe.has_names_of_frames ? texts.of_frames : texts.all;
  probe.jsons = (probe.has_names_of_frames ? jsons.of_frames : jsons.all).size();
  probe.texts = counted.size();
  if (counted.empty()) {
    return;
  }
  // Frames without instances have empty files, so another file may have to tell the format.
  for (const std::set<std::string>& tried : {counted, texts.all}) {
    for (const std::string& name : tried) {
      if (ProbeRow(probe.path / (name + ".txt"), probe)) {
        return;
      }
    }
  }
}

// Whether the line could be an outline in pixels.
bool IsInPixels(const MaskProbe& probe) {
  constexpr size_t kLeastColumns = 7;
  return probe.columns >= kLeastColumns &&
         std::all_of(probe.row.begin(), probe.row.end(), [](const std::string& column) {
           double value = 0.0;
           return ParseFinite(column, value) && value >= 0.0;
         });
}

// "; did you mean FOLDER?" for a folder whose masks are in a subfolder, as Ultralytics writes them.
std::string SuggestSubfolder(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored) &&
        (!ListFiles(entry->path(), ".txt").empty() || !ListFiles(entry->path(), ".json").empty())) {
      found.push_back(entry->path());
    }
  }
  return found.size() == 1 ? fmt::format("; did you mean {}?", found.front().string())
                           : std::string();
}

std::string DescribeFolderMisfit(const MaskProbe& probe) {
  std::error_code error;
  if (fs::is_empty(probe.path, error)) {
    return "the folder is empty, expected masks";
  }
  if (probe.columns > 0) {
    constexpr size_t kColumnsShown = 8;
    const size_t shown = std::min(probe.row.size(), kColumnsShown);
    return fmt::format(
        "'{}{}' in {} fits no format of masks, expected one that docs/masks.md shows{}",
        fmt::join(probe.row.begin(), probe.row.begin() + static_cast<ptrdiff_t>(shown), " "),
        probe.columns > shown ? " ..." : "", probe.row_file,
        IsInPixels(probe)
            ? "; if these are pixels, divide x by the width and y by the height (yolo-seg)"
            : "");
  }
  if (probe.texts > 0) {
    return fmt::format(
        "all {} text files are empty, so their format cannot be detected; give --masks-format",
        probe.texts);
  }
  if (probe.has_images) {
    return "has PNG files but no classes.json, which the format label-png needs" +
           SuggestSubfolder(probe.path);
  }
  if (probe.jsons > 0) {
    return "has a JSON file that is not named as a frame; give the path of the file";
  }
  for (const char* const ending : {".npy", ".npz"}) {
    if (!ListFiles(probe.path, ending).empty()) {
      return fmt::format(
          "has {} files, which HullSLAM does not read as masks; write a PNG per frame with the "
          "number of an instance in each pixel, and classes.json (label-png)",
          ending);
    }
  }
  return "has neither text files nor PNG or JSON files, expected masks" +
         SuggestSubfolder(probe.path);
}

void ProbeFile(std::span<const std::string_view> json_keys, MaskProbe& probe) {
  const std::string text = ReadText(probe.path, kMostJsonFileBytes);
  size_t first = std::string::npos;
  for (const std::string_view key : json_keys) {
    const size_t at = text.find('"' + std::string(key) + '"');
    if (at < first) {
      first = at;
      probe.json_key = key;
    }
  }
}

}  // namespace

MaskProbe ProbeMasks(const fs::path& path, std::span<const std::string_view> json_keys,
                     std::span<const MaskFrame> frames) {
  MaskProbe probe;
  probe.path = path;
  std::error_code error;
  if (!fs::exists(path, error)) {
    throw InputError(path.string() + ": no such folder or file, expected masks");
  }
  probe.is_folder = fs::is_directory(path, error);
  if (!probe.is_folder && !fs::is_regular_file(path, error)) {
    throw InputError(path.string() +
                     ": is neither a folder nor a file; give --masks-format to read it");
  }
  if (probe.is_folder) {
    ProbeFolder(frames, probe);
  } else {
    ProbeFile(json_keys, probe);
  }
  return probe;
}

std::string DescribeMisfit(const MaskProbe& probe, const std::string& json_keys) {
  if (probe.is_folder) {
    return DescribeFolderMisfit(probe);
  }
  ReadJson(probe.path, {.most_bytes = kMostJsonFileBytes});  // throws if the file is not valid JSON
  return "is JSON, but has none of the keys " + json_keys;
}

bool IsNormalized(const MaskProbe& probe, size_t column) {
  constexpr double kRounding = 0.01;
  for (; column < probe.row.size(); ++column) {
    const bool is_track = column + 1 == probe.columns && IsTrackNumber(probe.row[column]);
    double value = 0.0;
    if (is_track) {
      continue;
    }
    if (!ParseFinite(probe.row[column], value) || value < -kRounding || value > 1.0 + kRounding) {
      return false;
    }
  }
  return true;
}

}  // namespace hullslam
