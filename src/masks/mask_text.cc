// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_text.h"

#include <fmt/format.h>

#include <cmath>
#include <system_error>

#include "hullslam/util/error.h"
#include "masks/mask_checks.h"
#include "masks/mask_classes.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExtension = ".txt";

}  // namespace

std::set<std::string> ListFiles(const fs::path& folder, std::string_view extension) {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    const std::string name = file->path().filename();
    if (name.ends_with(extension)) {
      names.insert(name.substr(0, name.size() - extension.size()));
    }
  }
  if (error) {
    throw InputError(folder.string() + ": " + error.message() + ", expected a folder of masks");
  }
  return names;
}

bool IsTrackNumber(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos &&
         text.find_first_not_of('0') != std::string_view::npos;
}

TextMasks::TextMasks(const MaskRequest& request)
    : request_(request),
      classes_(ReadClasses(request.path)),
      names_(ListFiles(request.path, kExtension)) {
  names_.erase("classes");
}

std::string TextMasks::FileName(const MaskFrame& frame) const {
  return names_.contains(frame.stem) || !names_.contains(frame.video_name) ? frame.stem
                                                                           : frame.video_name;
}

bool TextMasks::HasTrack(const TextRow& row) const {
  if (row.columns.size() < 2 || !IsTrackNumber(row.columns.back())) {
    return false;
  }
  const bool is_odd = row.columns.size() % 2 == 1;
  TrackAnswer& answer = tracks_.at(is_odd ? 1 : 0);
  std::call_once(answer.once, [&] { answer.has_tracks = HaveTracks(is_odd); });
  return answer.has_tracks;
}

bool TextMasks::HaveTracks(bool is_odd) const {
  for (const std::string& name : names_) {
    bool have_tracks = true;
    ForEachRow(
        request_.path / (name + std::string(kExtension)),
        [&](const TextRow& row) {
          const bool is_asked = row.columns.size() > 1 && (row.columns.size() % 2 == 1) == is_odd;
          have_tracks = have_tracks && (!is_asked || IsTrackNumber(row.columns.back()));
        },
        kMostFrameFileBytes);
    if (!have_tracks) {
      return false;
    }
  }
  return true;
}

bool TextMasks::Contains(const MaskFrame& frame) const { return names_.contains(FileName(frame)); }

std::string TextMasks::Example() const {
  return names_.empty() ? std::string() : *names_.begin() + std::string(kExtension);
}

FrameMasks TextMasks::Read(const MaskFrame& frame) const {
  FrameMasks result;
  result.is_missing = !Contains(frame);
  if (result.is_missing) {
    return result;
  }
  const fs::path path = request_.path / (FileName(frame) + std::string(kExtension));
  const auto add = [&](const TextRow& row) {
    AddInstance(Parse(row), result);
    if (HasTooMany(result)) {
      row.Fail(fmt::format("too many instances, expected at most {} per frame", kMostInstances));
    }
  };
  ForEachRow(path, add, kMostFrameFileBytes);
  return result;
}

const std::string& TextMasks::ClassName(const TextRow& row, size_t column) const {
  const double number = row.Number(column, "class");
  if (number < 0.0 || number >= static_cast<double>(classes_.size()) ||
      number != std::floor(number)) {
    row.Fail(
        fmt::format("class is '{}', expected an integer from 0 to {} (classes.txt in the "
                    "folder may name others)",
                    number, classes_.size() - 1));
  }
  return classes_[static_cast<size_t>(number)];
}

double TextMasks::Score(const TextRow& row, size_t column) {
  const double score = row.Number(column, "confidence");
  if (score < 0.0 || score > 1.0) {
    row.Fail(fmt::format("confidence is '{}', expected a number from 0 to 1", score));
  }
  return score;
}

}  // namespace hullslam
