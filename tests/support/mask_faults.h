// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "files/text_rows.h"
#include "util/hash.h"

namespace hullslam {

// One line of a file in the format yolo-seg.
struct MaskLine {
  int class_id = 0;
  std::vector<double> corners;       // x, y, x, y, ..., as shares of the image's width and height
  std::vector<double> confidence{};  // one number, or empty if the line has none
};

// The lines of each file, by the file's name. All stamps of a sequence have the same length, so the
// names are in the order of time.
using MaskFolder = std::map<std::string, std::vector<MaskLine>>;

inline MaskFolder ReadMaskFolder(const std::filesystem::path& path) {
  MaskFolder folder;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() != ".txt") {
      continue;
    }
    std::vector<MaskLine>& lines = folder[entry.path().filename()];
    ForEachRow(entry.path(), [&](const TextRow& row) {
      MaskLine& line = lines.emplace_back();
      line.class_id = static_cast<int>(row.Number(0, "class"));
      for (size_t i = 1; i < row.columns.size(); ++i) {
        line.corners.push_back(row.Number(i, "corner"));
      }
      if (line.corners.size() % 2 == 1) {
        line.confidence = {line.corners.back()};
        line.corners.pop_back();
      }
    });
  }
  return folder;
}

inline void WriteMaskFolder(const std::filesystem::path& path, const MaskFolder& folder) {
  std::filesystem::create_directories(path);
  for (const auto& [name, lines] : folder) {
    std::ofstream stream(path / name);
    for (const MaskLine& line : lines) {
      stream << line.class_id;
      for (const double number : line.corners) {
        stream << ' ' << number;
      }
      for (const double number : line.confidence) {
        stream << ' ' << number;
      }
      stream << '\n';
    }
  }
}

// Moves all masks to the right by a share of the image's width. Corners that leave the image are
// put on its border.
inline MaskFolder ShiftMasks(MaskFolder folder, double share) {
  for (auto& [name, lines] : folder) {
    for (MaskLine& line : lines) {
      for (size_t i = 0; i < line.corners.size(); i += 2) {
        line.corners[i] = std::min(line.corners[i] + share, 1.0);
      }
    }
  }
  return folder;
}

// Gives each file the lines of the file that is `later` files after it. After the last file the
// count goes on with the first one.
inline MaskFolder UseMasksOfLaterFiles(const MaskFolder& folder, size_t later) {
  MaskFolder moved;
  size_t index = later;
  for (const auto& [name, lines] : folder) {
    moved[name] =
        std::next(folder.begin(), static_cast<std::ptrdiff_t>(index % folder.size()))->second;
    ++index;
  }
  return moved;
}

// Gives every mask a random one of the 80 classes.
inline MaskFolder ShuffleClasses(MaskFolder folder, uint64_t seed) {
  uint32_t index = 0;
  for (auto& [name, lines] : folder) {
    std::mt19937_64 random(HashSeed(seed, index++, "classes"));
    for (MaskLine& line : lines) {
      line.class_id = static_cast<int>(random() % 80);
    }
  }
  return folder;
}

// Removes each mask with a probability of one half. A frame without masks has no file.
inline MaskFolder LoseHalfOfMasks(MaskFolder folder, uint64_t seed) {
  uint32_t index = 0;
  for (auto& [name, lines] : folder) {
    std::mt19937_64 random(HashSeed(seed, index++, "lost masks"));
    std::erase_if(lines, [&](const MaskLine&) { return random() % 2 == 0; });
  }
  std::erase_if(folder, [](const auto& file) { return file.second.empty(); });
  return folder;
}

// Adds to every frame a table that covers 49 % of the image. This is just below the limit above
// which masks are rejected as too large.
inline MaskFolder AddGiantMask(MaskFolder folder) {
  for (auto& [name, lines] : folder) {
    lines.push_back({60, {0.15, 0.15, 0.85, 0.15, 0.85, 0.85, 0.15, 0.85}, {0.99}});
  }
  return folder;
}

// One folder of masks for each kind of fault, by the fault's name.
inline std::map<std::string, MaskFolder> MakeMaskFaults(const MaskFolder& good) {
  return {{"shifted by 40 px", ShiftMasks(good, 40.0 / 640.0)},
          {"of other frames", UseMasksOfLaterFiles(good, std::min<size_t>(100, good.size() / 2))},
          {"of any class", ShuffleClasses(good, 1)},
          {"half of them lost", LoseHalfOfMasks(good, 1)},
          {"with a giant one", AddGiantMask(good)}};
}

}  // namespace hullslam
