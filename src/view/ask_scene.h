// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/answer.h"
#include "scene/scene.h"
#include "view/view_model.h"

namespace hullslam {

// One picture of several answers (CV_8UC3, blue first): a row per answer with its rank, class, id
// and score, and with the cut-outs of the object with the outline of its mask. An object without
// cut-outs has a row without them.
cv::Mat DrawAnswers(std::span<const Answer> answers, const ViewModel& model);

// A query for objects: by one of a question, `like`, `vector`, and `label` with `within` or either.
struct SceneQuery {
  std::string question = {};                    // in the grammar of docs/scene.md
  std::optional<uint32_t> like = std::nullopt;  // the number of an object
  std::filesystem::path vector = {};            // a .npy file
  std::string label = {};                       // a class
  std::optional<double> within = std::nullopt;  // m, of the object `of`
  std::optional<uint32_t> of = std::nullopt;
  std::filesystem::path classes = {};  // file of classes that the detector knows, one per line
};

// The answers, best first. `source` is the run or the map of the scene: the classes that its
// network knows may be asked for. Throws InputError for a query that is not understood.
std::vector<Answer> AskScene(const Scene& scene, const std::filesystem::path& source,
                             const SceneQuery& query);

std::string AnswersJson(const Scene& scene, const std::vector<Answer>& answers);
std::string AnswersText(const Scene& scene, const std::vector<Answer>& answers);  // a table
// Draws the answers, each with its best views, into an image file (.jpg or .png), which appears
// complete or not at all. Throws InputError if the images of the run are not found.
void WriteAnswerPicture(const std::filesystem::path& run, const std::vector<Answer>& answers,
                        const std::filesystem::path& file);

}  // namespace hullslam
