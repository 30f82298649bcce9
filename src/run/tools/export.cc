// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/tools/export.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "exports/colmap_model.h"
#include "exports/export_folder.h"
#include "exports/g2o_graph.h"
#include "exports/glb_file.h"
#include "exports/pose_files.h"
#include "exports/scene_ply.h"
#include "files/atomic_file.h"
#include "frame/dynamic_mask.h"
#include "hullslam/tracking/tracking_options.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/export_images.h"
#include "run/export_input.h"
#include "run/messages.h"
#include "run/program.h"
#include "util/counted.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  ExportSource source;
  std::string format;
  fs::path output;
  bool force = false;
  bool text = false;
  std::string shape = "ellipsoids";
  std::string masked_classes = TrackingOptions().dynamic_classes;
  bool quiet = false;
};

// Writes the export and returns a text about what is in it.
using ExportWriter = std::string (*)(const ExportArguments& arguments, ExportInput& input);

struct ExportFormat {
  const char* name;
  const char* meaning;
  ExportNeed need;
  ExportWriter write;
};

ObjectShape ShapeOf(const ExportArguments& arguments) {
  return arguments.shape == "boxes" ? ObjectShape::kBoxes : ObjectShape::kEllipsoids;
}

std::string WriteColmap(const ExportArguments& arguments, ExportInput& input) {
  const std::vector<KeyframeImage> images = FindImages(input);
  const PinholeView view(input.map->sensor.camera);
  ExportFolder folder(arguments.output);
  WriteImages(images, view, input, folder);
  std::vector<Colour> colours;
  for (const ColouredPoint& point : input.model.points) {
    colours.push_back(point.colour);
  }
  const ColmapModel model =
      MakeColmapModel(input.map->map, input.map->located, colours, images, view);
  for (FileContent& file : arguments.text ? FormatColmapText(model) : FormatColmapBinary(model)) {
    file.name = "sparse/0/" + file.name;
    folder.Write(file);
  }
  folder.Commit();
  return fmt::format("{}, {} with tracks", Counted(model.images.size(), "image"),
                     Counted(model.points.size(), "point"));
}

std::string WriteNerfstudio(const ExportArguments& arguments, ExportInput& input) {
  constexpr const char* kPointsFile = "points.ply";
  const std::vector<KeyframeImage> images = FindImages(input);
  const PinholeView view(input.map->sensor.camera);
  ExportFolder folder(arguments.output);
  WriteImages(images, view, input, folder);
  const std::vector<NerfstudioFrame> frames =
      WriteDepthsAndMasks(images, view, SplitNames(arguments.masked_classes), input, folder);
  folder.Write({kPointsFile, FormatPointsPly(input.model.points)});
  folder.Write({"transforms.json", FormatTransforms(view.camera(), frames, kPointsFile)});
  folder.Commit();
  return fmt::format(
      "{}{}{}, {}", Counted(frames.size(), "image"), frames.front().depth.empty() ? "" : ", depths",
      frames.front().mask.empty() ? "" : ", masks", Counted(input.model.points.size(), "point"));
}

std::string DescribeScene(const ExportModel& model) {
  return fmt::format("{}, {}, {}, {}", Counted(model.trajectory.size(), "pose"),
                     Counted(model.keyframes.size(), "keyframe"),
                     Counted(model.points.size(), "point"),
                     Counted(model.scene.objects.size(), "object"));
}

std::string WriteGlb(const ExportArguments& arguments, ExportInput& input) {
  if (input.sequence) {
    ColourPoints(input);
  }
  WriteFileAtomically(arguments.output, FormatGlb(input.model, ShapeOf(arguments)));
  return DescribeScene(input.model);
}

std::string WritePly(const ExportArguments& arguments, ExportInput& input) {
  if (input.sequence) {
    ColourPoints(input);
  }
  WriteFileAtomically(arguments.output, FormatScenePly(input.model, ShapeOf(arguments)));
  return DescribeScene(input.model);
}

std::string WriteG2o(const ExportArguments& arguments, ExportInput& input) {
  const MapOfRun& map = *input.map;
  WriteFileAtomically(arguments.output, FormatG2o(map.map, map.located, map.sensor));
  return fmt::format("{}, {}", Counted(map.map.keyframes().size(), "keyframe"),
                     Counted(map.located.positions.size(), "landmark"));
}

std::string WriteKitti(const ExportArguments& arguments, ExportInput& input) {
  WriteFileAtomically(arguments.output, FormatKittiPoses(input.model.trajectory));
  return Counted(input.model.trajectory.size(), "pose");
}

std::string WriteEuroc(const ExportArguments& arguments, ExportInput& input) {
  WriteFileAtomically(arguments.output, FormatEurocPoses(input.model.trajectory));
  return Counted(input.model.trajectory.size(), "pose");
}

constexpr std::array<ExportFormat, 7> kFormats = {{
    {"colmap", "a folder with undistorted images and a sparse model with tracks",
     ExportNeed::kImages, WriteColmap},
    {"nerfstudio", "a folder with transforms.json, undistorted images, depths and masks",
     ExportNeed::kImages, WriteNerfstudio},
    {"g2o", "a text file with the pose graph and landmarks", ExportNeed::kMap, WriteG2o},
    {"gltf", "a binary glTF file (.glb) with points, path, cameras and objects", ExportNeed::kScene,
     WriteGlb},
    {"ply", "a PLY file with points, cameras and objects", ExportNeed::kScene, WritePly},
    {"kitti", "a text file with a 3 x 4 matrix per pose", ExportNeed::kPoses, WriteKitti},
    {"euroc", "a CSV file with a pose per line", ExportNeed::kPoses, WriteEuroc},
}};

std::vector<std::string> FormatNames() {
  std::vector<std::string> names;
  for (const ExportFormat& format : kFormats) {
    names.emplace_back(format.name);
  }
  return names;
}

std::string DescribeFormats() {
  std::string text = "Formats:\n";
  for (const ExportFormat& format : kFormats) {
    text += fmt::format("  {:<11} {}\n", format.name, format.meaning);
  }
  return text;
}

void AddArguments(CLI::App& app, ExportArguments& arguments) {
  app.add_option("RUN_DIR|MAP", arguments.source.input,
                 "output folder of a run, or a file of --save-map")
      ->required();
  app.add_option("--to", arguments.format, "the format; see below")
      ->required()
      ->check(CLI::IsMember(FormatNames()));
  app.add_option("--output", arguments.output, "the file or folder to write")->required();
  app.add_flag("--force", arguments.force, "write to a file that exists or a folder with files");
  app.add_flag("--text", arguments.text, "colmap: write text files in place of binary ones");
  app.add_option("--objects-as", arguments.shape, "gltf, ply: the shape of the objects")
      ->check(CLI::IsMember({"boxes", "ellipsoids"}))
      ->capture_default_str();
  app.add_option("--masked-classes", arguments.masked_classes,
                 "nerfstudio: classes whose masks are left out of training, separated by commas")
      ->capture_default_str();
  app.add_option("--map", arguments.source.map,
                 "the map that the run has saved (default: as summary.json says)");
  app.add_option("--sequence", arguments.source.sequence,
                 "where the sequence of the run is now (default: as summary.json says)");
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
}

}  // namespace

int RunExport(int argc, char** argv) {
  CLI::App app("Writes a finished run or a saved map in a format of other programs.", "export");
  ExportArguments arguments;
  AddArguments(app, arguments);
  AddVersionAndExitCodes(app);
  app.footer(DescribeFormats() + app.get_footer());
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const auto* const format = std::find_if(
      kFormats.begin(), kFormats.end(),
      [&](const ExportFormat& candidate) { return arguments.format == candidate.name; });
  ExportInput input = ReadExportInput(arguments.source, format->need);
  CheckExportPath(arguments.output, input.read, arguments.force);
  const std::string content = format->write(arguments, input);
  for (const std::string& note : input.notes) {
    PrintError("note: {}\n", note);
  }
  if (!arguments.quiet) {
    Print("wrote {}: {}\n", arguments.output.string(), content);
  }
  return kDone;
}

}  // namespace hullslam
