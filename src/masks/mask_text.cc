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

TextMasks::TextMasks(const MaskRequest& request)
    : request_(request),
      classes_(ReadClasses(request.path)),
      names_(ListFiles(request.path, kExtension)) {
  names_.erase("classes");
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
