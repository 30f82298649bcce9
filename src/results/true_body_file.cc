// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/true_body_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/json_file.h"
#include "files/plausible.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "results/json_text.h"
#include "results/pose_file.h"
#include "results/true_object_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr double kMetresPerMm = 1e-3;
constexpr double kLengthTolerance = 1e-2;  // of quaternions, whose numbers may have 2 decimals

// ---- a list of bodies

void CheckKeys(const JsonNode& node, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : node.Members()) {
    if (std::ranges::find(known, key) == known.end()) {
      value.Fail(fmt::format("no such key; the keys are {}", fmt::join(known, ", ")));
    }
  }
}

BodyKind ReadKind(const JsonNode& node) {
  const std::string text = node.Text();
  for (const BodyKind kind : {BodyKind::kBox, BodyKind::kCylinder, BodyKind::kEllipsoid}) {
    if (text == ToString(kind)) {
      return kind;
    }
  }
  node.Fail("box, cylinder or ellipsoid");
}

// A pose whose quaternion has unit length: another length is a sign of another order of columns.
Rigid3 ReadUnitPose(const JsonNode& node) {
  Rigid3 pose = PoseOf(node);
  const std::vector<double> v = node.Numbers(7);
  if (std::abs(std::hypot(std::hypot(v[3], v[4]), std::hypot(v[5], v[6])) - 1.0) >
      kLengthTolerance) {
    node.Fail("tx, ty, tz, qx, qy, qz, qw with a quaternion of length 1");
  }
  return pose;
}

void ReadSymmetry(const JsonNode& list, TrueBody& truth) {
  for (const JsonNode& node : list.Elements()) {
    const std::string text = node.Text();
    constexpr std::string_view kRound = "round about axis ";
    if (text == "sphere") {
      truth.is_round = {true, true, true};
    } else if (text.starts_with(kRound) && text.size() == kRound.size() + 1 && text.back() >= 'x' &&
               text.back() <= 'z') {
      truth.is_round.at(static_cast<size_t>(text.back() - 'x')) = true;
    } else if (text != "none" && text != "flip") {
      node.Fail("none, flip, round about axis x (or y, z) or sphere");
    }
  }
}

// What follows from the shape: two equal half axes of an ellipsoid or of a cylinder's section.
void AddRoundAxes(TrueBody& truth) {
  const Eigen::Vector3d& half = truth.body.half_axes;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = half[(axis + 1) % 3];
    const bool is_equal = std::abs(first - half[(axis + 2) % 3]) <= 1e-6 * first;
    const bool may_be = truth.body.kind == BodyKind::kEllipsoid ||
                        (truth.body.kind == BodyKind::kCylinder && axis == 2);
    truth.is_round.at(static_cast<size_t>(axis)) |= may_be && is_equal;
  }
}

TrueBody ReadBody(const JsonNode& node, std::set<uint32_t>& ids) {
  CheckKeys(node, {"id", "class", "kind", "world_from_object", "half_axes", "symmetry", "seen"});
  TrueBody truth;
  truth.id = node.At("id").Count();
  if (!ids.insert(truth.id).second) {
    node.At("id").Fail("an id that no other object has");
  }
  truth.label = node.At("class").Text();
  truth.body.kind = ReadKind(node.At("kind"));
  truth.shape = ToString(truth.body.kind);
  truth.body.world_from_body = ReadUnitPose(node.At("world_from_object"));
  truth.body.half_axes = node.At("half_axes").Lengths();
  if (node.Has("symmetry")) {
    ReadSymmetry(node.At("symmetry"), truth);
  }
  AddRoundAxes(truth);
  truth.is_counted = !node.Has("seen") || node.At("seen").Flag();
  return truth;
}

// ---- make_synthetic

std::vector<TrueBody> ReadSyntheticBodies(const fs::path& path) {
  std::vector<TrueBody> truths;
  for (const TrueObject& object : ReadTrueScene(path).objects) {
    if (object.is_dynamic) {
      continue;
    }
    const BodyKind kind = object.shape == "ellipsoid" ? BodyKind::kEllipsoid
                          : object.is_round           ? BodyKind::kCylinder
                                                      : BodyKind::kBox;
    TrueBody& truth = truths.emplace_back();
    truth.id = object.id;
    truth.label = object.label;
    truth.shape = kind == BodyKind::kCylinder ? "cylinder" : object.shape;
    truth.body = {kind, object.world_from_object, object.half_extents};
    truth.masks = object.masks;
    AddRoundAxes(truth);
  }
  return truths;
}

// ---- BOP

// The pose of a matrix by rows in one member, and a translation (mm) in another one.
Rigid3 ReadBopPose(const JsonNode& node, const char* rotation, const char* translation) {
  const std::vector<double> r = node.At(rotation).Numbers(9);
  const std::vector<double> t = node.At(translation).Numbers(3);
  Eigen::Matrix<double, 3, 4> matrix;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<size_t>(i);
    matrix.row(i) << r[3 * row], r[3 * row + 1], r[3 * row + 2], kMetresPerMm * t[row];
  }
  const std::optional<Rigid3> pose = PoseOfMatrix(matrix);
  if (!pose) {
    node.At(rotation).Fail("a rotation by rows (determinant 1, rows of length 1)");
  }
  if (!(pose->translation.cwiseAbs().maxCoeff() <= kMostMetres)) {
    node.At(translation).Fail(fmt::format("a position up to {:g} m", kMostMetres));
  }
  return *pose;
}

struct BopModel {
  Eigen::Vector3d center;     // of its box in its frame, m
  Eigen::Vector3d half_axes;  // m
  std::array<bool, 3> is_round = {false, false, false};
};

BopModel ReadBopModel(const JsonNode& node) {
  BopModel model;
  constexpr double kMost = kMostMetres / kMetresPerMm;
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, static_cast<char>('x' + i));
    model.half_axes[i] = 0.5 * kMetresPerMm * node.At("size_" + axis).PositiveNumber(kMost);
    model.center[i] = kMetresPerMm * node.At("min_" + axis).Number(kMost) + model.half_axes[i];
  }
  if (node.Has("symmetries_continuous")) {
    for (const JsonNode& symmetry : node.At("symmetries_continuous").Elements()) {
      const std::vector<double> axis = symmetry.At("axis").Numbers(3);
      for (size_t i = 0; i < 3; ++i) {
        model.is_round[i] |= std::abs(axis[i]) > 0.999 * std::hypot(axis[0], axis[1], axis[2]);
      }
    }
  }
  return model;
}

std::map<std::string, BopModel> ReadBopModels(const fs::path& scene) {
  std::error_code error;
  for (const char* const folder : {"", "../../models", "../../models_eval"}) {
    const fs::path path = scene / folder / "models_info.json";
    if (fs::exists(path, error)) {
      const nlohmann::json json = ReadJson(path);
      std::map<std::string, BopModel> models;
      for (const auto& [id, model] : JsonNode(path, json).Members()) {
        models[id] = ReadBopModel(model);
      }
      return models;
    }
  }
  throw InputError(scene.string() +
                   ": has no models_info.json, expected it there, in ../../models or in "
                   "../../models_eval");
}

// One body, from its annotations in several images.
struct BopInstance {
  uint32_t model = 0;
  std::vector<Rigid3> world_from_model;
  size_t last_image = 0;  // whose annotation was added last
  bool is_visible = false;
};

Rigid3 MedianPose(const std::vector<Rigid3>& poses) {
  Eigen::Vector3d median;
  for (int i = 0; i < 3; ++i) {
    std::vector<double> values;
    values.reserve(poses.size());
    for (const Rigid3& pose : poses) {
      values.push_back(pose.translation[i]);
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[i] = *middle;
  }
  return *std::ranges::min_element(
      poses, {}, [&](const Rigid3& pose) { return (pose.translation - median).squaredNorm(); });
}

// Finds the nearest instance of the model that has no annotation in this image yet, or adds one.
BopInstance& InstanceAt(const Eigen::Vector3d& position, uint32_t model, size_t image,
                        double most_distance, std::vector<BopInstance>& instances) {
  BopInstance* nearest = nullptr;
  for (BopInstance& instance : instances) {
    const double distance = (instance.world_from_model.front().translation - position).norm();
    if (instance.model == model && instance.last_image != image && distance <= most_distance) {
      most_distance = distance;
      nearest = &instance;
    }
  }
  return nearest != nullptr ? *nearest : instances.emplace_back(BopInstance{model, {}});
}

// A file beside scene_gt.json.
struct SceneFile {
  fs::path path;
  nlohmann::json json;
  JsonNode Top() const { return {path, json}; }
};

SceneFile ReadSceneFile(const fs::path& path) { return {path, ReadJson(path)}; }

// Whether the annotations of an image are visible; all are if there is no scene_gt_info.json.
std::vector<bool> ReadVisible(const SceneFile& info, const std::string& image, size_t count) {
  constexpr double kLeast = 0.1;
  if (info.path.empty()) {
    return std::vector<bool>(count, true);
  }
  const JsonNode list = info.Top().At(image);
  std::vector<bool> is_visible;
  for (const JsonNode& annotation : list.Elements()) {
    is_visible.push_back(annotation.At("visib_fract").Number(1.0) >= kLeast);
  }
  if (is_visible.size() != count) {
    list.Fail(fmt::format("{} annotations as in scene_gt.json", count));
  }
  return is_visible;
}

std::vector<TrueBody> ReadBopBodies(const fs::path& path, const JsonNode& top) {
  const fs::path scene = path.parent_path();
  const std::map<std::string, BopModel> models = ReadBopModels(scene);
  const SceneFile cameras = ReadSceneFile(scene / "scene_camera.json");
  std::error_code error;
  const bool has_info = fs::exists(scene / "scene_gt_info.json", error);
  const SceneFile info = has_info ? ReadSceneFile(scene / "scene_gt_info.json") : SceneFile();
  std::vector<BopInstance> instances;
  size_t image = 0;
  for (const auto& [name, annotations] : top.Members()) {
    ++image;
    const Rigid3 world_from_cam =
        Inverse(ReadBopPose(cameras.Top().At(name), "cam_R_w2c", "cam_t_w2c"));
    const std::vector<JsonNode> list = annotations.Elements();
    const std::vector<bool> is_visible = ReadVisible(info, name, list.size());
    for (size_t i = 0; i < list.size(); ++i) {
      const uint32_t id = list[i].At("obj_id").Count();
      const auto model = models.find(std::to_string(id));
      if (model == models.end()) {
        list[i].At("obj_id").Fail("a model of models_info.json");
      }
      const Rigid3 pose = world_from_cam * ReadBopPose(list[i], "cam_R_m2c", "cam_t_m2c");
      BopInstance& instance =
          InstanceAt(pose.translation, id, image, model->second.half_axes.mean(), instances);
      instance.last_image = image;
      instance.world_from_model.push_back(pose);
      instance.is_visible = instance.is_visible || is_visible[i];
    }
  }
  std::vector<TrueBody> truths;
  for (const BopInstance& instance : instances) {
    const BopModel& model = models.at(std::to_string(instance.model));
    const Rigid3 model_from_body(Eigen::Quaterniond::Identity(), model.center);
    TrueBody& truth = truths.emplace_back();
    truth.id = static_cast<uint32_t>(truths.size());
    truth.label = fmt::format("obj_{:06}", instance.model);
    truth.shape = ToString(BodyKind::kBox);
    truth.body = {BodyKind::kBox, MedianPose(instance.world_from_model) * model_from_body,
                  model.half_axes};
    truth.is_round = model.is_round;
    truth.is_counted = instance.is_visible;
  }
  return truths;
}

bool IsNumber(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

// ---- Cube-Diorama

constexpr size_t kClassAndPose = 8;  // columns: class tx ty tz qx qy qz qw

// The row with the box of an object: three half axes, or two corners in the frame of the object.
TrueBody ReadDioramaBox(const TextRow& row) {
  if (row.columns.size() != kClassAndPose + 3 && row.columns.size() != kClassAndPose + 6) {
    row.Fail(
        fmt::format("has {} columns, expected class tx ty tz qx qy qz qw and three half axes "
                    "or the corners xmin ymin zmin xmax ymax zmax",
                    row.columns.size()));
  }
  TrueBody truth;
  truth.label = std::string(row.columns[0]);
  if (!IsNumber(truth.label)) {
    row.Fail(fmt::format("the class is '{}', expected a number", ShowText(truth.label)));
  }
  truth.shape = ToString(BodyKind::kBox);
  const auto vector_at = [&](size_t column, const char* name) {
    return Eigen::Vector3d(row.Number(column, name, kMostMetres),
                           row.Number(column + 1, name, kMostMetres),
                           row.Number(column + 2, name, kMostMetres));
  };
  const Rigid3 pose(row.Rotation(7, 4, 5, 6), vector_at(1, "position"));
  const double length = std::hypot(std::hypot(row.Number(4, "qx"), row.Number(5, "qy")),
                                   std::hypot(row.Number(6, "qz"), row.Number(7, "qw")));
  if (std::abs(length - 1.0) > kLengthTolerance) {
    row.Fail(fmt::format("the quaternion has length {:g}, expected 1", length));
  }
  Eigen::Vector3d low = -vector_at(kClassAndPose, "half axis");
  Eigen::Vector3d high = -low;
  if (row.columns.size() == kClassAndPose + 6) {
    low = -low;
    high = vector_at(kClassAndPose + 3, "corner");
  }
  const Eigen::Vector3d half = 0.5 * (high - low);
  if (half.minCoeff() <= 0.0) {
    row.Fail(
        "the box has a size that is 0 or negative, expected half axes > 0 or the lower corner "
        "first");
  }
  truth.body = {BodyKind::kBox, pose * Rigid3(Eigen::Quaterniond::Identity(), 0.5 * (low + high)),
                half};
  return truth;
}

// After the box, a file has a row for each image that shows the object: its stamp, and the box in
// the image.
TrueBody ReadDioramaBody(const fs::path& path) {
  std::optional<TrueBody> truth;
  uint32_t images = 0;
  ForEachRow(path, [&](const TextRow& row) {
    if (!truth) {
      truth = ReadDioramaBox(row);
      return;
    }
    if (row.columns.size() != 5) {
      row.Fail(
          fmt::format("has {} columns, expected stamp x y height width of the object in an "
                      "image",
                      row.columns.size()));
    }
    row.Stamp(0);
    for (size_t i = 1; i < row.columns.size(); ++i) {
      row.Number(i, "box", kMostPixels);
    }
    ++images;
  });
  if (!truth) {
    throw InputError(path.string() +
                     ": has no object, expected a line with its class, pose and "
                     "box");
  }
  truth->masks = images;
  return *truth;
}

std::vector<TrueBody> ReadDioramaBodies(const fs::path& folder) {
  std::map<uint32_t, fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".txt" && IsNumber(stem) && stem.size() < 9) {
      files[static_cast<uint32_t>(std::stoul(stem))] = entry.path();
    }
  }
  if (files.empty()) {
    throw InputError(folder.string() +
                     ": has no file 0.txt, 1.txt, ..., expected the folder obj_offline of a "
                     "sequence of Cube-Diorama");
  }
  std::vector<TrueBody> truths;
  for (const auto& [id, file] : files) {
    truths.push_back(ReadDioramaBody(file));
    truths.back().id = id;
  }
  return truths;
}

}  // namespace

std::vector<TrueBody> ReadTrueBodies(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return ReadDioramaBodies(path);
  }
  const nlohmann::json json = ReadJson(path);
  const JsonNode top(path, json);
  std::vector<TrueBody> truths;
  if (top.Has("objects")) {
    const std::vector<JsonNode> objects = top.At("objects").Elements();
    if (std::ranges::any_of(objects,
                            [](const JsonNode& node) { return node.Has("half_extents"); })) {
      truths = ReadSyntheticBodies(path);
    } else {
      std::set<uint32_t> ids;
      for (const JsonNode& node : objects) {
        truths.push_back(ReadBody(node, ids));
      }
    }
  } else {
    const auto images = top.Members();
    if (images.empty() || !IsNumber(images.front().first)) {
      top.Fail("\"objects\", or the images of a scene_gt.json of BOP");
    }
    truths = ReadBopBodies(path, top);
  }
  if (truths.empty()) {
    throw InputError(path.string() + ": has no object that stands still, expected one at least");
  }
  return truths;
}

}  // namespace hullslam
