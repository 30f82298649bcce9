// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "camera/wide_lens.h"
#include "hullslam/util/error.h"
#include "synthetic/scenes.h"
#include "synthetic/true_relations.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

double FrameTime(int frame) { return frame / kFramesPerSecond; }

std::string PoseText(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}", t.x(), t.y(), t.z(), q.x(),
                     q.y(), q.z(), q.w());
}

std::string FrameList(const SequencePlan& plan, const std::string& images) {
  const SequenceLayout& layout = plan.layout;
  std::string text = "# timestamp filename\n";
  for (int i = 0; i < plan.frames; ++i) {
    text += fmt::format("{:.6f} {}{}/{}.png\n", layout.Stamp(i), layout.ImagesFromTumFolder(),
                        images, layout.Stem(i));
  }
  return text;
}

std::string GroundTruth(const SequencePlan& plan) {
  std::string text = "# timestamp tx ty tz qx qy qz qw (world_from_cam)\n";
  for (int i = 0; i < plan.frames; ++i) {
    text += fmt::format("{:.6f} {}\n", plan.layout.Stamp(i),
                        PoseText(plan.scene.world_from_cam(FrameTime(i))));
  }
  return text;
}

// The pose of a camera whose y axis points up, in a world whose y axis is turned round too: F R F
// and F t with F = diag(1, -1, 1). ICL-NUIM's ground truth has such poses (docs/datasets.md).
Rigid3 WithYUp(const Rigid3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  const Eigen::Vector3d& t = pose.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), Eigen::Vector3d(t.x(), -t.y(), t.z())};
}

// As in ICL-NUIM, the first image has index 0 and the first pose index 1.
std::string IclGroundTruth(const SequencePlan& plan) {
  std::string text;
  for (int i = 1; i < plan.frames; ++i) {
    text += fmt::format("{} {}\n", i, PoseText(WithYUp(plan.scene.world_from_cam(FrameTime(i)))));
  }
  return text;
}

std::string IclAssociations(int frames) {
  std::string text;
  for (int i = 0; i < frames; ++i) {
    text += fmt::format("{0} depth/{0}.png {0} rgb/{0}.png\n", i);
  }
  return text;
}

std::string LensSettings(const PinholeCamera& camera) {
  if (!camera.IsFisheye() && !camera.IsDistorted()) {
    return "Camera.k1: 0.0\nCamera.k2: 0.0\nCamera.p1: 0.0\nCamera.p2: 0.0\n";
  }
  const WideModel* const wide = FindWideModel(camera.lens);
  std::string text = wide != nullptr ? fmt::format("Camera.type: \"{}\"\n", wide->type) : "";
  for (const LensCoefficient& one : CoefficientsOf(camera.lens)) {
    text += fmt::format("Camera.{}: {}\n", one.name, camera.*one.field);
  }
  return text;
}

std::string CameraSettings(const SequencePlan& plan) {
  const PinholeCamera& camera = plan.camera;
  std::string text = fmt::format(
      "%YAML:1.0\n---\nCamera.fx: {:.6f}\nCamera.fy: {:.6f}\nCamera.cx: {:.6f}\nCamera.cy: {:.6f}\n"
      "{}"
      "Camera.width: {}\nCamera.height: {}\nCamera.fps: 30.0\nCamera.bf: {:.{}f}\n"
      "ThDepth: 40.0\nDepthMapFactor: {:.1f}\n"
      "ORBextractor.nFeatures: 1000\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
      "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n",
      camera.fx, camera.fy, camera.cx, camera.cy, LensSettings(camera), camera.width, camera.height,
      camera.bf, plan.stereo_baseline > 0.0 || camera.IsFisheye() ? 6 : 1,
      plan.sensor.units_per_metre);
  if (plan.readout_time != 0.0) {
    text += fmt::format("Camera.readout_time: {}\n", plan.readout_time);
  }
  return text;
}

// Whether a part looks the same when its owner is turned about the z axis through its centre.
bool IsRound(const Part& part) {
  constexpr double kTolerance = 1e-6;
  const Shape& shape = part.shape;
  const bool can_be_round = shape.kind == ShapeKind::kCylinder ||
                            shape.kind == ShapeKind::kRevolved ||
                            shape.kind == ShapeKind::kEllipsoid ||
                            (shape.kind == ShapeKind::kSuperquadric && shape.east == 1.0);
  const Eigen::Vector3d axis = part.owner_from_part.rotation * Eigen::Vector3d::UnitZ();
  return can_be_round && shape.half.x() == shape.half.y() && axis.head<2>().norm() < kTolerance &&
         part.owner_from_part.translation.head<2>().norm() < kTolerance;
}

bool IsRound(const SceneObject& object) {
  return std::ranges::all_of(object.parts, [](const Part& part) { return IsRound(part); });
}

nlohmann::ordered_json PoseJson(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

nlohmann::ordered_json ObjectJson(const SceneObject& object) {
  return {{"id", object.id},
          {"class", object.class_name},
          {"class_id", object.class_id},
          {"shape", object.shape},
          {"round", IsRound(object)},
          {"dynamic", object.IsDynamic()},
          {"world_from_object", PoseJson(object.world_from_object)},
          {"half_extents",
           {object.half_extents.x(), object.half_extents.y(), object.half_extents.z()}}};
}

// Adds the status that the rearrangement gave the object.
void AddStatus(const SceneObject& object, nlohmann::ordered_json& entry) {
  switch (object.status) {
    case ObjectStatus::kUnchanged:
      entry["status"] = "unchanged";
      return;
    case ObjectStatus::kMoved:
      entry["status"] = "moved";
      entry["former_world_from_object"] = PoseJson(object.former_world_from_object);
      return;
    case ObjectStatus::kNew:
      entry["status"] = "new";
      return;
  }
}

// The supports of objects, also those that are no objects (floors and tables).
void AddRelations(const Scene& scene, nlohmann::ordered_json& file) {
  file["supports"] = nlohmann::ordered_json::array();
  for (const Support& support : scene.supports) {
    file["supports"].push_back({{"min", {support.min.x(), support.min.y()}},
                                {"max", {support.max.x(), support.max.y()}},
                                {"height", support.height}});
  }
  file["relations"] = nlohmann::ordered_json::array();
  for (const TrueRelation& relation : FindTrueRelations(scene)) {
    nlohmann::ordered_json entry = {{"subject", relation.subject}, {"relation", relation.relation}};
    if (relation.object) {
      entry["object"] = *relation.object;
    } else {
      entry["support"] = *relation.support;
    }
    file["relations"].push_back(std::move(entry));
  }
}

std::string ObjectsJson(const SequencePlan& plan, const std::vector<uint32_t>& masks) {
  nlohmann::ordered_json file = {{"generator", "make_synthetic"},
                                 {"scene", plan.name},
                                 {"seed", plan.seed},
                                 {"frames", plan.frames}};
  if (plan.rearranged) {
    file["rearranged"] = *plan.rearranged;
  }
  file["objects"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < plan.scene.objects.size(); ++i) {
    const SceneObject& object = plan.scene.objects[i];
    nlohmann::ordered_json entry = ObjectJson(object);
    if (!masks.empty()) {
      entry["masks"] = masks.at(i);
    }
    if (plan.rearranged) {
      AddStatus(object, entry);
    }
    for (int frame = 0; object.IsDynamic() && frame < plan.frames; ++frame) {
      entry["poses"].push_back(
          {{"timestamp", plan.layout.Stamp(frame)},
           {"world_from_object", PoseJson(object.WorldFromObject(FrameTime(frame)))}});
    }
    file[object.HasClass() ? "objects" : "unclassed"].push_back(std::move(entry));
  }
  if (plan.rearranged) {
    file["gone"] = nlohmann::ordered_json::array();
    for (const SceneObject& object : plan.scene.gone) {
      file["gone"].push_back(ObjectJson(object));
    }
  }
  AddRelations(plan.scene, file);
  return file.dump(1) + "\n";
}

}  // namespace

void WriteNewFile(const fs::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    throw InputError(path.string() + ": cannot be written; is the disk full?");
  }
}

void WriteSequenceFiles(const fs::path& folder, const SequencePlan& plan,
                        const std::vector<uint32_t>& masks) {
  const fs::path tum = folder / plan.layout.TumFolder();
  WriteNewFile(tum / "rgb.txt", FrameList(plan, "rgb"));
  WriteNewFile(tum / "depth.txt", FrameList(plan, "depth"));
  WriteNewFile(tum / "groundtruth.txt", GroundTruth(plan));
  WriteNewFile(tum / "camera.yaml", CameraSettings(plan));
  WriteNewFile(tum / "groundtruth_objects.json", ObjectsJson(plan, masks));
  if (plan.layout.form == DatasetForm::kIcl) {
    WriteNewFile(folder / "associations.txt", IclAssociations(plan.frames));
    WriteNewFile(folder / (plan.name + ".gt.freiburg"), IclGroundTruth(plan));
  }
}

}  // namespace hullslam::synthetic
