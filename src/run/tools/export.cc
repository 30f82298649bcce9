// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "exports/export_formats.h"
#include "exports/export_input.h"
#include "exports/export_run.h"
#include "hullslam/tracking/tracking_options.h"
#include "run/command_line.h"
#include "run/program.h"
#include "run/tools/commands.h"
#include "util/text.h"

namespace hullslam {
namespace {

struct ExportArguments {
  ExportSource source;
  std::string format;
  ExportOptions options;
  bool force = false;
  std::string masked_classes = TrackingOptions().dynamic_classes;
  bool quiet = false;
};

void AddArguments(CLI::App& app, ExportArguments& arguments) {
  app.add_option("RUN_DIR|MAP", arguments.source.input,
                 "output folder of a run, or a file of --save-map")
      ->required();
  app.add_option("--to", arguments.format, "the format; see below")
      ->required()
      ->check(CLI::IsMember(ExportFormatNames()));
  app.add_option("--output", arguments.options.output, "the file or folder to write")->required();
  app.add_flag("--force", arguments.force, "write to a file that exists or a folder with files");
  app.add_flag("--text", arguments.options.as_text,
               "colmap: write text files in place of binary ones");
  const std::map<std::string, ObjectShape> shapes = {{"boxes", ObjectShape::kBoxes},
                                                     {"ellipsoids", ObjectShape::kEllipsoids}};
  app.add_option_function<std::string>(
         "--objects-as",
         [&arguments, shapes](const std::string& name) {
           arguments.options.shape = shapes.at(name);
         },
         "gltf, ply: the shape of the objects")
      ->check(CLI::IsMember({"boxes", "ellipsoids"}))
      ->default_str("ellipsoids");
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
  CLI::App app("Writes a finished run or a saved map in a format of other programs.", argv[0]);
  ExportArguments arguments;
  AddArguments(app, arguments);
  AddVersionAndExitCodes(app);
  app.footer(DescribeExportFormats() + app.get_footer());
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  arguments.options.masked_classes = SplitNames(arguments.masked_classes);
  const FinishedExport written =
      ExportRun(arguments.source, arguments.format, arguments.options, arguments.force);
  for (const std::string& note : written.notes) {
    PrintError("note: {}\n", note);
  }
  if (!arguments.quiet) {
    Print("wrote {}: {}\n", arguments.options.output.string(), written.content);
  }
  return kDone;
}

}  // namespace hullslam
