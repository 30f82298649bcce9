# SPDX-License-Identifier: GPL-3.0-or-later
"""Scratch extensions for recipes_test.py: the files that the recipes of docs/architecture.md ask for."""

import dataclasses

HEAD = "// SPDX-License-Identifier: GPL-3.0-or-later\n"


@dataclasses.dataclass
class Extension:
    """What is added to HullSLAM by a recipe."""
    recipe: str  # the first column of the table of recipes
    most: int  # files that are edited
    new: dict  # of new files: name -> text
    edits: dict  # of edited files: name -> [(text before, inserted text, text behind)]


MASKS = Extension("a mask format", 3, {
    "src/masks/mask_scratch.cc": HEAD + """#include "masks/mask_checks.h"
#include "masks/mask_format.h"
#include "masks/mask_text.h"
namespace hullslam {
namespace {
class ScratchMasks : public TextMasks {
 public:
  using TextMasks::TextMasks;
  std::string format() const override { return "scratch"; }

 private:
  InstanceMask Parse(const TextRow& row) const override {
    const double x = row.Number(1, "x");
    const double y = row.Number(2, "y");
    const double size = row.Number(3, "size");
    return {.label = ClassName(row, 0),
            .shape = MaskShape::kBox,
            .outlines = {BoxOutline(x, y, x + size, y + size, request())}};
  }
};
bool IsScratch(const MaskProbe& probe) { return probe.columns == 4; }
std::unique_ptr<MaskSource> OpenScratch(const MaskRequest& request) {
  return std::make_unique<ScratchMasks>(request);
}
}  // namespace
const MaskFormat kScratchFormat = {.name = "scratch", .is_meant = IsScratch, .open = OpenScratch};
}  // namespace hullslam
"""}, {
    "src/masks/mask_format.h": [
        ("extern const MaskFormat kBoxesFormat;\n",
         "// Format scratch: `<stem>.txt` with lines `class x y size`, a square in pixels.\n"
         "extern const MaskFormat kScratchFormat;\n", "")],
    "src/masks/open_masks.cc": [("&kBoxesFormat", ", &kScratchFormat", "")],
    "docs/masks.md": [
        ("YOLO's boxes in shares |\n", "| `scratch` | folder | `<stem>.txt` | `class x y size`, pixels |\n",
         "")]})

DATASET = Extension("a data set", 3, {
    "src/datasets/scratch_dataset.cc": HEAD + """#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/image_stream.h"
namespace hullslam {
namespace {
DatasetHelp HelpOfScratch(SensorKind /*sensor*/) {
  return {.sequence = "folder with scratch.txt", .settings = "must be given"};
}
bool IsScratch(const std::filesystem::path& path, SensorKind /*sensor*/) {
  return IsThere(path / "scratch.txt");
}
OpenedDataset OpenScratch(const DatasetRequest& request) {
  OpenedDataset opened;
  opened.settings = LoadSettings(request.settings, request.preset, request.overrides);
  opened.sequence = OpenImageStream(request.path / "frames").images;
  opened.sequence.dataset = "scratch";
  return opened;
}
ImageSequence OpenScratchImages(const ImagesRequest& request) {
  return OpenImageStream(request.path / "frames").images;
}
}  // namespace
Dataset ScratchDataset() {
  return {.name = "scratch", .program = "", .meaning = "a scratch sequence",
          .sensors = {SensorKind::kMonocular}, .help = HelpOfScratch, .options = {},
          .is_meant = IsScratch, .open = OpenScratch, .open_images = OpenScratchImages};
}
}  // namespace hullslam
"""}, {
    "src/datasets/rows.h": [("", "Dataset ScratchDataset();\n", "Dataset VideoDataset();")],
    "src/datasets/dataset.cc": [("", "ScratchDataset(), ", "VideoDataset()};")],
    "docs/datasets.md": [
        ("", "| scratch | `OpenImageStream` | |\n", "| a folder of images, a video file |")]})

EXPORT = Extension("an export", 3, {
    "src/exports/export_scratch.h": HEAD + """#pragma once
#include "exports/export_formats.h"
namespace hullslam {
std::string WriteScratch(const ExportOptions& options, ExportInput& input);
}  // namespace hullslam
""",
    "src/exports/export_scratch.cc": HEAD + """#include "exports/export_scratch.h"
#include "files/staged_file.h"
#include "util/text.h"
namespace hullslam {
std::string WriteScratch(const ExportOptions& options, ExportInput& input) {
  WriteFileAtomically(options.output, std::to_string(input.model.trajectory.size()));
  return Counted(input.model.trajectory.size(), "pose");
}
}  // namespace hullslam
"""}, {
    "src/exports/export_formats.cc": [
        ('#include "exports/export_images.h"\n', '#include "exports/export_scratch.h"\n', ""),
        ('     WritePoseFile<FormatEurocPoses>},\n',
         '    {"scratch", "the number of poses", ExportNeed::kPoses, WriteScratch},\n', "")],
    "tests/integration/export_test.cc": [
        ("", 'TEST_F(Export, Scratch) { ExportTo("scratch", Out("n")); }\n\n', "TEST_F(Export, GraphAndPly")],
    "docs/exports.md": [
        ("EuRoC's tools, evo |\n", "| `scratch` | the number of poses | RUN_DIR or MAP | nobody |\n", "")]})

RESIDUAL = Extension("a residual", 4, {
    "src/costs/quadric_scratch.h": HEAD + """#pragma once
#include "costs/residual_kind.h"
namespace hullslam {
extern const ResidualKind kScratchResidual;
}  // namespace hullslam
""",
    "src/costs/quadric_scratch.cc": HEAD + """#include "costs/quadric_scratch.h"
namespace hullslam {
const ResidualKind kScratchResidual = {
    .name = "scratch",
    .primitives = kAllPrimitives,
    .takes_lines = true,
    .of_pixel_error = [](double error_px, const ProjectedSize& /*size*/) { return error_px; },
    .make_cost = [](const ObjectCostInput& input) {
      return KindOf(ObjectResidual::kTangent).make_cost(input);
    }};
}  // namespace hullslam
"""}, {
    "include/hullslam/costs/object_residual.h": [("kFilteredPoint", ", kScratch", "")],
    "src/costs/object_residual.cc": [
        ('#include "costs/quadric_tangent.h"\n', '#include "costs/quadric_scratch.h"\n', ""),
        ("&kFilteredPointResidual", ", &kScratchResidual", "")],
    "docs/objects.md": [("chi-square test at the start | 1 | `contour` | QISO-SLAM |\n",
                         "| `scratch` | as `tangent` | px | those with lines | ours |\n", "")]})

LENS = Extension("a lens", 3, {}, {
    "include/hullslam/camera/pinhole.h": [("  kExtendedUnified,\n", "  kScratch,  // stereographic, with k1\n", "")],
    "src/camera/wide_lens.cc": [
        ("", """LensRadius RadiusOfScratch(const PinholeCamera& camera, double angle) {
  const double half = std::tan(0.5 * angle);
  return {.radius = 2.0 * half + camera.k1 * half * half,
          .slope = (1.0 + half * half) * (1.0 + camera.k1 * half)};
}
double LargestOfScratch(const PinholeCamera& /*camera*/, double limit) { return limit; }
constexpr std::array<std::string_view, 1> kScratchNames = {"scratch"};
constexpr std::array<LensCoefficient, 1> kScratchCoefficients = {{{"k1", &PinholeCamera::k1}}};
""", "// ---- all of them"),
        ("     LargestOfExtendedUnified},\n",
         '{LensModel::kScratch, "Scratch", "a scratch lens", kScratchNames, kScratchCoefficients,\n'
         " RadiusOfScratch, LargestOfScratch},\n", "")],
    "docs/settings.md": [("`EUCM`", ", `Scratch`", "")]})

EXTENSIONS = (MASKS, DATASET, EXPORT, RESIDUAL, LENS)
