// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "exports/export_input.h"

namespace hullslam {

struct ExportOptions {
  std::filesystem::path output;                  // the file or folder to write
  ObjectShape shape = ObjectShape::kEllipsoids;  // gltf, ply
  bool as_text = false;                          // colmap: text files instead of binary ones
  std::set<std::string> masked_classes = {};     // nerfstudio: left out of training
};

// A format of other programs. A new format is a row of ExportFormats().
struct ExportFormat {
  const char* name;
  const char* meaning;
  ExportNeed need;  // what `write` is given
  // Writes the export and returns a text about its content. `options.output` has passed
  // CheckExportPath(). Throws InputError if something cannot be read or written.
  std::string (*write)(const ExportOptions& options, ExportInput& input);
};

std::span<const ExportFormat> ExportFormats();
std::vector<std::string> ExportFormatNames();
// One line per format: its name and meaning.
std::string DescribeExportFormats();

}  // namespace hullslam
