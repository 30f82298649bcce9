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

#include "io/text_rows.h"
#include "util/random_seed.h"

namespace hullslam {

// A line of a file of type yolo-seg.
struct MaskLine {
  int class_id = 0;
  std::vector<double> corners;       // x, y, x, y ... as shares of the width and the height
  std::vector<double> confidence{};  // one number or none
};

// The lines by the files' names. Stamps of one sequence have one length, so names are in the order
// of time.
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

// All masks moved to the right by a share of the image's width; what leaves the image is pressed
// against its border.
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

// Each file has the lines of the one `later` files behind it; the last ones have those of the
// first.
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

// Every mask of every frame is of any of the 80 classes.
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

// Each mask stays with a probability of one half; a frame that keeps none has no file.
inline MaskFolder LoseHalfOfMasks(MaskFolder folder, uint64_t seed) {
  uint32_t index = 0;
  for (auto& [name, lines] : folder) {
    std::mt19937_64 random(HashSeed(seed, index++, "lost masks"));
    std::erase_if(lines, [&](const MaskLine&) { return random() % 2 == 0; });
  }
  std::erase_if(folder, [](const auto& file) { return file.second.empty(); });
  return folder;
}

// Adds to every frame a table over 49 % of the image, just under what is dropped as too large.
inline MaskFolder AddGiantMask(MaskFolder folder) {
  for (auto& [name, lines] : folder) {
    lines.push_back({60, {0.15, 0.15, 0.85, 0.15, 0.85, 0.85, 0.15, 0.85}, {0.99}});
  }
  return folder;
}

// The faults by name.
inline std::map<std::string, MaskFolder> MakeMaskFaults(const MaskFolder& good) {
  return {{"shifted by 40 px", ShiftMasks(good, 40.0 / 640.0)},
          {"of other frames", UseMasksOfLaterFiles(good, std::min<size_t>(100, good.size() / 2))},
          {"of any class", ShuffleClasses(good, 1)},
          {"half of them lost", LoseHalfOfMasks(good, 1)},
          {"with a giant one", AddGiantMask(good)}};
}

}  // namespace hullslam
