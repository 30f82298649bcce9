// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "files/staged_file.h"
#include "run/command_line.h"
#include "run/more_outputs.h"
#include "run/program.h"
#include "run/tools/commands.h"
#include "run/view_arguments.h"
#include "view/report.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
  fs::path input;
  bool report = false;
  fs::path output;  // empty: beside the input
  int port = 0;
  std::string address = "127.0.0.1";
  bool quiet = false;
};

void WritePage(const ViewArguments& arguments, const std::string& page) {
  const fs::path output =
      arguments.output.empty() ? DefaultReportPath(arguments.input) : arguments.output;
  if (arguments.output.empty() && HasOwnReport(arguments.input)) {
    if (!arguments.quiet) {
      Print("{}: this report of the run is complete; it stays (--output FILE writes a copy)\n",
            output.string());
    }
    return;
  }
  WriteFileAtomically(output, page);
  if (!arguments.quiet) {
    Print("the report is in {}\n", output.string());
  }
}

}  // namespace

int RunView(int argc, char** argv) {
  CLI::App app(
      "Shows a finished run or a saved map in a browser until Ctrl-C, or writes the page to a "
      "file.",
      argv[0]);
  ViewArguments arguments;
  app.add_option("RUN_DIR|MAP", arguments.input, "output folder of a run, or a file of --save-map")
      ->required();
  app.add_flag("--report", arguments.report,
               "write a file that shows everything without a server, and end");
  app.add_option("--output", arguments.output,
                 "the file of --report (default: report.html in RUN_DIR, or MAP with the ending "
                 ".html)");
  AddPageArguments(app, arguments.port, arguments.address);
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
  AddVersionAndExitCodes(app, "done", "the program failed");
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const std::string page = ReportOf(arguments.input);
  if (arguments.report) {
    WritePage(arguments, page);
  } else {
    ServePage(page, arguments.port, arguments.address);
  }
  return kDone;
}

}  // namespace hullslam
