// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/report_output.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "files/atomic_file.h"
#include "files/content_hash.h"
#include "files/read_file.h"
#include "hullslam/util/error.h"
#include "run/messages.h"
#include "util/components.h"
#include "view/report.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

std::string PageOf(const Report& report) {
  for (const std::string& note : report.notes) {
    PrintError("report: {}\n", note);
  }
  return report.page;
}

// The last line of a report that a run itself has written, with the hash of the run's summary;
// empty without a summary.
std::string MarkOf(const fs::path& folder) {
  try {
    const std::string summary = ReadFile(folder / "summary.json");
    return fmt::format("<!-- written by the run with the summary {} -->\n",
                       ContentHash(summary.data(), summary.size()));
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

void AddReportFlag(CLI::App& app, bool& report) {
  app.add_flag("--report", report,
               "also write report.html to the output folder: the map in 3D, errors, times, images "
               "and objects, to be opened in a browser")
      ->each([](const std::string&) { RequireComponent("LIVE", "--report is given"); });
}

std::string WriteReport(const fs::path& folder, const Map& map, const SystemOptions& options,
                        const ImageSequence& sequence, bool is_quiet) {
  try {
    const fs::path file = folder / "report.html";
    WriteFileAtomically(file, PageOf(MakeReport(folder, map, options, sequence)) + MarkOf(folder));
    if (!is_quiet) {
      Print("the report is in {}\n", file.string());
    }
  } catch (const std::exception& error) {
    return fmt::format("the report could not be written: {}; the results are complete",
                       error.what());
  }
  return {};
}

bool HasOwnReport(const fs::path& folder) {
  constexpr size_t kMostBytes = 100'000'000;
  const std::string mark = MarkOf(folder);
  try {
    return !mark.empty() && ReadFile(folder / "report.html", kMostBytes).ends_with(mark);
  } catch (const InputError&) {
    return false;
  }
}

std::string ReportOf(const fs::path& source) {
  return PageOf(MakeReportOf(source, HULLSLAM_VERSION));
}

}  // namespace hullslam
