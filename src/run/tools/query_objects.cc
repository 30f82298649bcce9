// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <vector>

#include "files/plausible.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/program.h"
#include "run/tools/commands.h"
#include "view/ask_scene.h"
#include "view/load_scene.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

struct QueryArguments {
  fs::path source;
  SceneQuery query;
  size_t most = 10;
  fs::path picture;
  bool json = false;
};

void AddArguments(CLI::App& app, QueryArguments& arguments) {
  app.add_option("RUN_DIR|MAP", arguments.source,
                 "output folder of a run with masks, or a map of --save-map")
      ->required();
  app.add_option("QUESTION", arguments.query.question,
                 "such as \"cup on the book near the laptop\"; docs/scene.md has the grammar");
  app.add_option("--like", arguments.query.like, "objects like the one with this number");
  app.add_option("--vector", arguments.query.vector,
                 "objects whose masks look like this vector: a .npy file with as many numbers as "
                 "the vectors beside the masks");
  app.add_option("--class", arguments.query.label, "objects of this class");
  auto* const within = app.add_option("--within", arguments.query.within,
                                      "at most this far, in the unit of the map (metres with "
                                      "depth), from the object of --of");
  ExpectNumber(*within, 0.0, kMostMetres);
  app.add_option("--of", arguments.query.of, "the number of an object")->needs(within);
  within->needs("--of");
  app.add_option("--classes", arguments.query.classes,
                 "file with one class per line: classes that the detector knows, although the map "
                 "may have no such object");
  app.add_option("--most", arguments.most, "print at most this many answers")
      ->check(CLI::Range(size_t{1}, size_t{1'000'000}).description(""))
      ->capture_default_str();
  app.add_option("--picture", arguments.picture,
                 "draw the answers into this image file (.jpg or .png), each with its best views; "
                 "needs the folder of a run and its images");
  app.add_flag("--json", arguments.json, "print JSON");
  AddVersionAndExitCodes(app, "an object fits", "no object fits, or the program failed");
}

// Throws InputError unless exactly one kind of question is asked.
void CheckArguments(const QueryArguments& arguments) {
  const bool asks_class = !arguments.query.label.empty() || arguments.query.within;
  const int kinds = (arguments.query.question.empty() ? 0 : 1) + (arguments.query.like ? 1 : 0) +
                    (arguments.query.vector.empty() ? 0 : 1) + (asks_class ? 1 : 0);
  if (kinds != 1) {
    throw InputError(
        "expected one of: a QUESTION in quotes, --like NUMBER, --vector FILE, or --class NAME "
        "and/or --within DISTANCE --of NUMBER");
  }
  const fs::path extension = arguments.picture.extension();
  if (!arguments.picture.empty() && extension != ".jpg" && extension != ".png") {
    throw InputError("--picture: '" + arguments.picture.string() +
                     "', expected a name that ends "
                     "with .jpg or .png");
  }
  if (!arguments.picture.empty() && !fs::is_directory(arguments.source)) {
    throw InputError("--picture: " + arguments.source.string() +
                     " is a map, which has no images, expected the output folder of a run");
  }
}

}  // namespace

int RunQueryObjects(int argc, char** argv) {
  CLI::App app("Answers questions about the objects of a run or of a saved map.", argv[0]);
  QueryArguments arguments;
  AddArguments(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  CheckArguments(arguments);
  const Scene scene = LoadScene(arguments.source);
  std::vector<Answer> answers = AskScene(scene, arguments.source, arguments.query);
  answers.resize(std::min(answers.size(), arguments.most));
  if (arguments.json) {
    Print("{}\n", AnswersJson(scene, answers));
  } else if (!answers.empty()) {
    Print("{}", AnswersText(scene, answers));
  }
  if (!arguments.picture.empty() && !answers.empty()) {
    WriteAnswerPicture(arguments.source, answers, arguments.picture);
  }
  if (answers.empty()) {
    PrintError("no object fits\n");
    return kFailed;
  }
  return kDone;
}

}  // namespace hullslam
