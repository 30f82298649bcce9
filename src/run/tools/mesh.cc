// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <string>

#include "exports/export_folder.h"
#include "exports/single_files.h"
#include "files/plausible.h"
#include "files/staged_file.h"
#include "mesh/make_mesh.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/tools/commands.h"

namespace hullslam {
namespace {

struct MeshArguments {
  MeshSource source;
  MeshOptions options;
  std::filesystem::path output;
  bool force = false;
  bool quiet = false;
};

void AddArguments(CLI::App& app, MeshArguments& arguments) {
  MeshSource& source = arguments.source;
  app.add_option("RUN_DIR|MAP", source.input, "output folder of a run, or a file of --save-map")
      ->required();
  app.add_option("--output", arguments.output, "the file to write, FILE.glb or FILE.ply")
      ->required()
      ->check([](const std::string& name) {
        return name.ends_with(".glb") || name.ends_with(".ply")
                   ? std::string()
                   : "expected a name that ends in .glb or .ply, not '" + name + "'";
      });
  app.add_flag("--force", arguments.force, "replace a file that exists");
  app.add_option("--sequence", source.sequence,
                 "where the sequence is now (default: as summary.json says; a map needs it)");
  AddSettingsArgument(app, "default: those of the run, or of the sequence of a map",
                      source.settings);
  AddOverrides(app, source.overrides);
  AddMaskArguments(app, source.masks, source.masks_format);
  ExpectNumber(*app.add_option("--voxel", arguments.options.voxel,
                               "distance between voxels, m (default: from the depths of the scene, "
                               "such as 0.01); distances up to four of them are kept"),
               1e-4, 100.0);
  ExpectNumber(*app.add_option("--max-depth", arguments.options.max_depth,
                               "largest depth that is used, m (default: that of close points, "
                               "ThDepth times the baseline)"),
               1e-2, kMostMetres);
  app.add_option("--every", arguments.options.every,
                 "use every n-th frame that has a pose (default: the keyframes)")
      ->check(WholeNumber(1));
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
  AddVersionAndExitCodes(app, "done", "the program failed or was interrupted");
}

}  // namespace

int RunMesh(int argc, char** argv) {
  CLI::App app("Makes a coloured surface of the scene and of its objects from depth images.",
               argv[0]);
  MeshArguments arguments;
  AddArguments(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const MeshInput input = OpenMeshInput(arguments.source);
  CheckExportPath(arguments.output, input.read, arguments.force);
  ProbeFile(arguments.output);
  PrintWarnings(input.notes);
  CatchInterrupts();
  std::optional<Progress> progress;
  ParallelRunner runner(0);
  const auto go_on = [&](size_t done, size_t all) {
    progress ? void() : void(progress.emplace(all, arguments.quiet));
    progress->Show(done);
    return !IsInterrupted();
  };
  const std::optional<Mesh> mesh = MakeMesh(input, arguments.options, runner, go_on);
  if (progress) {
    progress->Clear();
  }
  if (!mesh || IsInterrupted()) {
    PrintFailure("the program was interrupted; no mesh was written");
    return kFailed;
  }
  WriteFileAtomically(arguments.output, arguments.output.extension() == ".glb"
                                            ? FormatMeshGlb(*mesh)
                                            : FormatMeshPly(*mesh));
  if (!arguments.quiet) {
    Print(
        "wrote {}: {} triangles and {} objects from {} views; voxels of {:g} m, distances up to "
        "{:g} m, depths up to {:.3g} m\n",
        arguments.output.string(), mesh->scene.triangles.size(), mesh->objects.size(), mesh->views,
        mesh->voxel, mesh->truncation, mesh->max_depth);
  }
  return kDone;
}

}  // namespace hullslam
