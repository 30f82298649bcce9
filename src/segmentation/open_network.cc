// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/open_network.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "files/data_path.h"

namespace hullslam {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLibrary = "libhullslam_network.so";

// Where the library may be: in the installation that this code is in, in that of the configuration,
// and where it was built.
std::vector<fs::path> Candidates() {
  std::vector<fs::path> files;
  for (fs::path folder = FileOfThisCode().parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    files.push_back(folder / HULLSLAM_NETWORK_LIBDIR / kLibrary);
  }
  files.push_back(fs::path(HULLSLAM_NETWORK_INSTALLED) / kLibrary);
  files.push_back(fs::path(HULLSLAM_NETWORK_BUILT) / kLibrary);
  return files;
}

decltype(&HullslamMakeNetwork) LoadFunction() {
  for (const fs::path& file : Candidates()) {
    std::error_code error;
    if (!fs::exists(file, error)) {
      continue;
    }
    void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const function = library == nullptr ? nullptr : dlsym(library, "HullslamMakeNetwork");
    if (function == nullptr) {
      throw std::runtime_error(
          fmt::format("masks need OpenCV's module dnn, and it cannot be loaded: {}", dlerror()));
    }
    return reinterpret_cast<decltype(&HullslamMakeNetwork)>(function);
  }
  throw std::runtime_error(
      fmt::format("masks need {}, which belongs to HullSLAM and is not installed", kLibrary));
}

}  // namespace

std::unique_ptr<Network> OpenNetwork(std::string_view bytes) {
  static const auto make = LoadFunction();
  return std::unique_ptr<Network>(make(bytes.data(), bytes.size()));
}

}  // namespace hullslam
