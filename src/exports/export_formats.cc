// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_formats.h"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "exports/colmap_model.h"
#include "exports/export_folder.h"
#include "exports/export_images.h"
#include "exports/single_files.h"
#include "files/staged_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

std::string WriteColmap(const ExportOptions& options, ExportInput& input) {
  const std::vector<KeyframeImage> images = FindImages(input);
  const ExportCamera view(input.map->sensor.camera);
  ExportFolder folder(options.output);
  WriteImages(images, view, input, folder);
  const bool are_pairs = input.map->sensor.kind == SensorKind::kStereo;
  if (are_pairs) {
    WriteRightImages(images, view, input, folder);
  }
  std::vector<Colour> colours;
  for (const ColouredPoint& point : input.model.points) {
    colours.push_back(point.colour);
  }
  const ColmapModel model = MakeColmapModel(input.map->map, input.map->located, colours, images,
                                            view, are_pairs ? input.map->sensor.baseline() : 0.0);
  for (FileContent& file : options.as_text ? FormatColmapText(model) : FormatColmapBinary(model)) {
    file.name = "sparse/0/" + file.name;
    folder.Write(file);
  }
  folder.Commit();
  return fmt::format("{}, {} with tracks", Counted(model.images.size(), "image"),
                     Counted(model.points.size(), "point"));
}

std::string WriteNerfstudio(const ExportOptions& options, ExportInput& input) {
  constexpr const char* kPointsFile = "points.ply";
  const std::vector<KeyframeImage> images = FindImages(input);
  const ExportCamera view(input.map->sensor.camera);
  ExportFolder folder(options.output);
  WriteImages(images, view, input, folder);
  const std::vector<NerfstudioFrame> frames =
      WriteDepthsAndMasks(images, view, options.masked_classes, input, folder);
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

// Writes the file of a scene, whose text or bytes `format` gives.
template <auto format>
std::string WriteSceneFile(const ExportOptions& options, ExportInput& input) {
  if (input.sequence) {
    ColourPoints(input);
  }
  WriteFileAtomically(options.output, format(input.model, options.shape));
  return DescribeScene(input.model);
}

std::string WriteG2o(const ExportOptions& options, ExportInput& input) {
  const MapOfRun& map = *input.map;
  WriteFileAtomically(options.output, FormatG2o(map.map, map.located, map.sensor));
  return fmt::format("{}, {}", Counted(map.map.keyframes().size(), "keyframe"),
                     Counted(map.located.positions.size(), "landmark"));
}

template <auto format>
std::string WritePoseFile(const ExportOptions& options, ExportInput& input) {
  WriteFileAtomically(options.output, format(input.model.trajectory));
  return Counted(input.model.trajectory.size(), "pose");
}

constexpr auto kFormats = std::to_array<ExportFormat>({
    {"colmap", "a folder with undistorted images and a sparse model with tracks",
     ExportNeed::kImages, WriteColmap},
    {"nerfstudio", "a folder with transforms.json, undistorted images, depths and masks",
     ExportNeed::kImages, WriteNerfstudio},
    {"g2o", "a text file with the pose graph and landmarks", ExportNeed::kMap, WriteG2o},
    {"gltf", "a binary glTF file (.glb) with points, path, cameras and objects", ExportNeed::kScene,
     WriteSceneFile<FormatGlb>},
    {"ply", "a PLY file with points, cameras and objects", ExportNeed::kScene,
     WriteSceneFile<FormatScenePly>},
    {"kitti", "a text file with a 3 x 4 matrix per pose", ExportNeed::kPoses,
     WritePoseFile<FormatKittiPoses>},
    {"euroc", "a CSV file with a pose per line", ExportNeed::kPoses,
     WritePoseFile<FormatEurocPoses>},
});

}  // namespace

std::span<const ExportFormat> ExportFormats() { return kFormats; }

std::vector<std::string> ExportFormatNames() {
  std::vector<std::string> names;
  for (const ExportFormat& format : kFormats) {
    names.emplace_back(format.name);
  }
  return names;
}

std::string DescribeExportFormats() {
  std::string text = "Formats:\n";
  for (const ExportFormat& format : kFormats) {
    text += fmt::format("  {:<11} {}\n", format.name, format.meaning);
  }
  return text;
}

}  // namespace hullslam
