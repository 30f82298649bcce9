// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/ask_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "files/npy_file.h"
#include "files/read_file.h"
#include "files/staged_file.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "masks/mask_classes.h"
#include "results/finished_run.h"
#include "scene/question.h"
#include "util/text.h"
#include "view/view_of_run.h"

namespace hullslam {
namespace {

constexpr int kTile = 220;  // px, of the longer side of a cut-out
constexpr int kGap = 12;
constexpr int kTextWidth = 230;
constexpr size_t kTiles = 3;
const cv::Scalar kPaper(255, 255, 255);
const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kOutline(0, 140, 255);  // orange

// Empty if the picture is no image.
cv::Mat DecodeCutout(const ViewPicture& picture) {
  try {
    return DecodeColourImage("", picture.jpeg);
  } catch (const InputError&) {
    return {};
  }
}

cv::Mat DrawCutout(const ViewPicture& picture) {
  cv::Mat image = DecodeCutout(picture);
  if (image.empty()) {
    return image;
  }
  const double scale = static_cast<double>(kTile) / std::max(image.cols, image.rows);
  cv::resize(image, image, {}, scale, scale, cv::INTER_LINEAR);
  for (const ViewShape& outline : picture.outlines) {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& point : outline.points) {
      points.emplace_back(static_cast<int>(std::lround(scale * point.x())),
                          static_cast<int>(std::lround(scale * point.y())));
    }
    cv::polylines(image, points, true, kOutline, 2, cv::LINE_AA);
  }
  return image;
}

// Text of any length in a column of a fixed width: it becomes smaller if it is too long.
void Write(const std::string& text, const cv::Point& at, double size, cv::Mat& sheet) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  int baseline = 0;
  const int width = cv::getTextSize(text, kFont, size, 1, &baseline).width;
  const double fitting = size * std::min(1.0, static_cast<double>(kTextWidth) / std::max(width, 1));
  cv::putText(sheet, text, at, kFont, fitting, kInk, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat DrawAnswers(std::span<const Answer> answers, const ViewModel& model) {
  const int row = kTile + kGap;
  cv::Mat sheet(static_cast<int>(answers.size()) * row + kGap,
                kTextWidth + static_cast<int>(kTiles) * row + 2 * kGap, CV_8UC3, kPaper);
  int top = kGap;
  int rank = 1;
  for (const Answer& answer : answers) {
    const auto shown =
        std::find_if(model.objects.begin(), model.objects.end(),
                     [&](const ViewObject& object) { return object.object.id == answer.object; });
    if (shown != model.objects.end()) {
      Write(fmt::format("{}. {} {}", rank, shown->object.label, answer.object.value),
            {kGap, top + 40}, 0.9, sheet);
      Write(fmt::format("score {:.2f}", answer.score), {kGap, top + 75}, 0.6, sheet);
      int left = kTextWidth + 2 * kGap;
      const size_t count = std::min(shown->cutouts.size(), kTiles);
      for (const ViewPicture& picture : std::span(shown->cutouts).first(count)) {
        const cv::Mat tile = DrawCutout(picture);
        if (tile.empty()) {
          continue;
        }
        tile.copyTo(sheet(cv::Rect(cv::Point(left, top), tile.size())));
        left += row;
      }
    }
    top += row;
    ++rank;
  }
  return sheet;
}

namespace {

namespace fs = std::filesystem;

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

}  // namespace

std::vector<Answer> AskScene(const Scene& scene, const fs::path& source, const SceneQuery& query) {
  const std::set<std::string> labels = KnownClasses(scene, query.classes);
  const auto parse = [&](const std::string& question) {
    return ParseKnown(question, labels, NetworkClasses(source));
  };
  if (!query.question.empty()) {
    return AnswerQuestion(scene, parse(query.question));
  }
  if (query.like) {
    return FindLike(scene, ObjectId(*query.like));
  }
  if (!query.vector.empty()) {
    return AnswerVector(scene, query.vector);
  }
  AskedThing thing;
  if (!query.label.empty()) {
    thing = parse(query.label);
    if (thing.kind != ThingKind::kClass || !thing.conditions.empty()) {
      throw InputError("--class: '" + query.label + "', expected a class");
    }
  }
  return query.within ? FindWithin(scene, thing.labels, *query.within, ObjectId(*query.of))
                      : AnswerQuestion(scene, thing);
}

std::string AnswersJson(const Scene& scene, const std::vector<Answer>& answers) {
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
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string AnswersText(const Scene& scene, const std::vector<Answer>& answers) {
  std::string text =
      fmt::format("{:>4} {:<16} {:>5} {:>23}  {}\n", "id", "class", "score", "centre", "why");
  for (const Answer& answer : answers) {
    const SceneObject& object = *scene.Find(answer.object);
    const Eigen::Vector3d& center = object.ellipsoid.world_from_object.translation;
    text +=
        fmt::format("{:>4} {:<16} {:>5.2f} {:>7.2f} {:>7.2f} {:>7.2f}  {}\n", answer.object.value,
                    object.label, answer.score, center.x(), center.y(), center.z(), answer.reason);
  }
  return text;
}

void WriteAnswerPicture(const fs::path& run, const std::vector<Answer>& answers,
                        const fs::path& file) {
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

}  // namespace hullslam
