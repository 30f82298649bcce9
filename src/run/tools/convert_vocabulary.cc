// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "run/command_line.h"
#include "run/messages.h"
#include "run/program.h"
#include "run/tools/commands.h"
#include "run/vocabularies.h"

namespace hullslam {

int RunConvertVocabulary(int argc, char** argv) {
  CLI::App app(
      "Converts a vocabulary between the text format of ORB-SLAM2 and the binary form of HullSLAM.",
      argv[0]);
  std::filesystem::path input;
  std::filesystem::path output;
  std::string form;
  bool quiet = false;
  app.add_option("IN", input, "vocabulary in either form; its content tells which")->required();
  app.add_option("OUT", output, "vocabulary file to write; replaces an earlier one")->required();
  AddVocabularyForm(app, form);
  app.add_flag("--quiet", quiet, "print nothing but errors");
  AddVersionAndExitCodes(
      app, "done", "the program failed (then nothing is written)",
      "bad usage, an IN that is no vocabulary, or an OUT that cannot be written");
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const VocabularyForm output_form = FormOf(output, form);
  const Vocabulary vocabulary = LoadVocabulary(input, quiet);
  WriteVocabulary(output, vocabulary, output_form);
  if (!quiet) {
    Print("{}: {}\n", output.string(), Describe(vocabulary));
  }
  return kDone;
}

}  // namespace hullslam
