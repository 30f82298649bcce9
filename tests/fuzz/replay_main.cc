// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: fuzz_replay READER FOLDER: gives every file in the folder to the reader.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "fuzz/readers.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "Usage: fuzz_replay READER FOLDER\n");
    return 2;
  }
  const hullslam::FuzzedReader& reader = hullslam::FindFuzzedReader(argv[1]);
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[2])) {
    files.insert(entry.path());
  }
  for (const std::filesystem::path& path : files) {
    std::printf("%s\n", path.c_str());
    std::fflush(stdout);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    reader.read(bytes);
  }
  return files.empty() ? 1 : 0;
}
