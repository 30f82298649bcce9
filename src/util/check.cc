// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/check.h"

#include <string>

namespace hullslam::internal {
namespace {

// A path relative to the folder of the project, which is elsewhere on the computers of users.
std::string_view InProject(std::string_view file) {
  std::string_view project = __FILE__;
  project.remove_suffix(std::string_view("src/util/check.cc").size());
  if (file.starts_with(project)) {
    file.remove_prefix(project.size());
  }
  return file;
}

}  // namespace

void FailCheck(std::string_view what, const char* file, int line) {
  throw CheckError(std::string(InProject(file)) + ":" + std::to_string(line) + ": " +
                   std::string(what));
}

}  // namespace hullslam::internal
