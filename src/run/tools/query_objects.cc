// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "files/atomic_file.h"
#include "files/npy_file.h"
#include "files/plausible.h"
#include "files/read_text.h"
#include "hullslam/util/error.h"
#include "masks/mask_classes.h"
#include "results/finished_run.h"
#include "run/command_line.h"
#include "run/messages.h"
#include "run/program.h"
#include "run/tools/commands.h"
#include "scene/answer.h"
#include "scene/question.h"
#include "sequences/image_file.h"
#include "util/printable.h"
#include "util/trim.h"
#include "view/answer_sheet.h"
#include "view/load_scene.h"
#include "view/view_of_run.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

struct QueryArguments {
  fs::path source;
  std::string question;
  std::optional<uint32_t> like;
  fs::path vector;
  std::string label;
  std::optional<double> within;
  std::optional<uint32_t> of;
  fs::path classes;
  size_t most = 10;
  fs::path picture;
  bool json = false;
};

void AddArguments(CLI::App& app, QueryArguments& arguments) {
  app.add_option("RUN_DIR|MAP", arguments.source,
                 "output folder of a run with masks, or a map of --save-map")
      ->required();
  app.add_option("QUESTION", arguments.question,
                 "such as \"cup on the book near the laptop\"; docs/scene.md has the grammar");
  app.add_option("--like", arguments.like, "objects like the one with this number");
  app.add_option("--vector", arguments.vector,
                 "objects whose masks look like this vector: a .npy file with as many numbers as "
                 "the vectors beside the masks");
  app.add_option("--class", arguments.label, "objects of this class");
  auto* const within = app.add_option("--within", arguments.within,
                                      "at most this far, in the unit of the map (metres with "
                                      "depth), from the object of --of");
  ExpectNumber(*within, 0.0, kMostMetres);
  app.add_option("--of", arguments.of, "the number of an object")->needs(within);
  within->needs("--of");
  app.add_option("--classes", arguments.classes,
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
  const bool asks_class = !arguments.label.empty() || arguments.within;
  const int kinds = (arguments.question.empty() ? 0 : 1) + (arguments.like ? 1 : 0) +
                    (arguments.vector.empty() ? 0 : 1) + (asks_class ? 1 : 0);
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

// The classes of the objects, and those of the file of --classes.
std::set<std::string> KnownClasses(const Scene& scene, const fs::path& file) {
  std::set<std::string> labels;
  for (const SceneObject& object : scene.objects) {
    for (const auto& [label, share] : object.shares) {
      labels.insert(label);
    }
  }
  if (!file.empty()) {
    const std::string text = ReadText(file);
    CheckUtf8(file, text);
    for (const std::string_view line : LinesOf(text)) {
      if (const std::string label(Trim(line)); !label.empty()) {
        labels.insert(Printable(label));
      }
    }
  }
  return labels;
}

std::vector<Answer> AnswerVector(const Scene& scene, const fs::path& file) {
  const FloatRows vector = ReadNpy(file);
  if (vector.rows != 1) {
    throw InputError(fmt::format("{}: {} rows, expected one vector", file.string(), vector.rows));
  }
  try {
    return FindByEmbedding(scene, vector.values);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

// The classes of the network that made the masks of the run: those of classes.txt beside the masks
// if they are still there, else those of COCO, which most networks know.
std::vector<std::string> NetworkClasses(const fs::path& source) {
  std::error_code error;
  try {
    if (fs::exists(source / "summary.json", error)) {
      const FinishedRun run = OpenFinishedRun(source);
      if (const auto masks = run.Find(run.masks)) {
        return ReadClasses(*masks);
      }
    }
  } catch (const InputError&) {
    // The answer does not need them.
  }
  return CocoClasses();
}

// A question about a class that the network knows has the answer that there is none if the map
// lacks it. The message about an unknown word lists the classes of the map.
AskedThing ParseKnown(const std::string& question, const std::set<std::string>& labels,
                      const std::vector<std::string>& network) {
  std::set<std::string> known(network.begin(), network.end());
  known.insert(labels.begin(), labels.end());
  try {
    return ParseQuestion(question, known);
  } catch (const InputError&) {
    return ParseQuestion(question, labels);
  }
}

std::vector<Answer> FindAnswers(const Scene& scene, const QueryArguments& arguments) {
  const std::set<std::string> labels = KnownClasses(scene, arguments.classes);
  const auto parse = [&](const std::string& question) {
    return ParseKnown(question, labels, NetworkClasses(arguments.source));
  };
  if (!arguments.question.empty()) {
    return AnswerQuestion(scene, parse(arguments.question));
  }
  if (arguments.like) {
    return FindLike(scene, ObjectId(*arguments.like));
  }
  if (!arguments.vector.empty()) {
    return AnswerVector(scene, arguments.vector);
  }
  AskedThing thing;
  if (!arguments.label.empty()) {
    thing = parse(arguments.label);
    if (thing.kind != ThingKind::kClass || !thing.conditions.empty()) {
      throw InputError("--class: '" + arguments.label + "', expected a class");
    }
  }
  return arguments.within
             ? FindWithin(scene, thing.labels, *arguments.within, ObjectId(*arguments.of))
             : AnswerQuestion(scene, thing);
}

void PrintAnswersAsJson(const Scene& scene, const std::vector<Answer>& answers) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Answer& answer : answers) {
    const SceneObject& object = *scene.Find(answer.object);
    const Eigen::Vector3d& center = object.ellipsoid.world_from_object.translation;
    list.push_back({{"object", answer.object.value},
                    {"class", object.label},
                    {"score", answer.score},
                    {"reason", answer.reason},
                    {"centre", {center.x(), center.y(), center.z()}}});
  }
  const nlohmann::ordered_json json = {{"answers", list}};
  Print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

// The image file appears complete or not at all.
void WritePicture(const fs::path& run, const std::vector<Answer>& answers, const fs::path& file) {
  const ViewModel model = ViewOfRun(run);
  const bool has_images =
      std::any_of(model.objects.begin(), model.objects.end(),
                  [](const ViewObject& object) { return !object.cutouts.empty(); });
  if (!has_images) {
    throw InputError(
        fmt::format("--picture: the images of {} are not found, or the run has no "
                    "views of its objects",
                    model.sequence));
  }
  WriteFileAtomically(file, EncodeImage(DrawAnswers(answers, model), file.extension()));
}

void PrintAnswers(const Scene& scene, const std::vector<Answer>& answers) {
  Print("{:>4} {:<16} {:>5} {:>23}  {}\n", "id", "class", "score", "centre", "why");
  for (const Answer& answer : answers) {
    const SceneObject& object = *scene.Find(answer.object);
    const Eigen::Vector3d& center = object.ellipsoid.world_from_object.translation;
    Print("{:>4} {:<16} {:>5.2f} {:>7.2f} {:>7.2f} {:>7.2f}  {}\n", answer.object.value,
          object.label, answer.score, center.x(), center.y(), center.z(), answer.reason);
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
  std::vector<Answer> answers = FindAnswers(scene, arguments);
  answers.resize(std::min(answers.size(), arguments.most));
  if (arguments.json) {
    PrintAnswersAsJson(scene, answers);
  } else if (!answers.empty()) {
    PrintAnswers(scene, answers);
  }
  if (!arguments.picture.empty() && !answers.empty()) {
    WritePicture(arguments.source, answers, arguments.picture);
  }
  if (answers.empty()) {
    PrintError("no object fits\n");
    return kFailed;
  }
  return kDone;
}

}  // namespace hullslam
