// SPDX-License-Identifier: GPL-3.0-or-later
// The command mesh, on a run of a rendered desk. The renderer knows the true surface.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "files/bytes.h"
#include "files/read_file.h"
#include "hullslam/eval/ate.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "images/image_file.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/running_program.h"
#include "support/temporary_folder.h"
#include "synthetic/renderer.h"
#include "synthetic/scenes.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kFrames = 30;

// A run with depth, masks and a saved map, which all tests share.
struct MeshRun {
  RenderedDesk desk{kFrames};
  TemporaryFolder folder;
  fs::path run = folder.path() / "run";
  fs::path map = folder.path() / "desk.map";

  MeshRun() {
    const ProgramResult result =
        RunProgram("rgbd_tum", {desk.path(), "--masks", desk.path() / "masks", "--output", run,
                                "--save-map", map, "--quiet"});
    if (result.exit_code != 0) {
      throw std::runtime_error(result.errors);
    }
  }
};

struct ReadPly {
  std::vector<Eigen::Vector3d> positions;
  std::vector<int32_t> objects;
  size_t faces = 0;
  bool is_consistent = true;  // all faces have vertices of one object

  explicit ReadPly(const std::string& text) {
    const size_t header = text.find("end_header\n");
    size_t count = 0;
    std::sscanf(text.c_str(), "ply\nformat binary_little_endian 1.0\nelement vertex %zu", &count);
    std::sscanf(text.c_str() + text.find("element face"), "element face %zu", &faces);
    ByteReader reader(std::string_view(text).substr(header + 11), "mesh.ply");
    for (size_t i = 0; i < count; ++i) {
      positions.push_back(reader.GetMatrix<Eigen::Vector3f>(100.0F).cast<double>());
      reader.GetRaw(3);
      objects.push_back(reader.Get<int32_t>());
    }
    for (size_t i = 0; i < faces; ++i) {
      EXPECT_EQ(reader.Get<uint8_t>(), 3);
      const auto first = static_cast<size_t>(reader.Get<int32_t>());
      for (int k = 1; k < 3; ++k) {
        const auto next = static_cast<size_t>(reader.Get<int32_t>());
        is_consistent = is_consistent && objects.at(next) == objects.at(first);
      }
    }
    reader.ExpectEnd();
  }
};

class MeshCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { shared_ = std::make_unique<MeshRun>(); }
  static void TearDownTestSuite() { shared_.reset(); }

  fs::path Out(const std::string& name) const { return out_.path() / name; }
  static ProgramResult Run(std::vector<std::string> arguments, const std::string& setup = "") {
    return RunProgram("hullslam mesh", arguments, setup);
  }
  // Expects exit code 2, one line on stderr with all parts, and no output.
  void ExpectRefused(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& parts, const std::string& setup = "") const {
    const ProgramResult result = Run(arguments, setup);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos) << part << " in " << result.errors;
    }
    EXPECT_TRUE(fs::is_empty(out_.path()));
  }

  static std::unique_ptr<MeshRun> shared_;
  TemporaryFolder out_;
};
std::unique_ptr<MeshRun> MeshCommand::shared_;

// The surfaces of the desk as the renderer sees them in some of the frames.
class TrueDesk {
 public:
  TrueDesk() {
    const synthetic::Scene scene = synthetic::BuildScene(synthetic::SceneKind::kDesk, kFrames, 0);
    const synthetic::Renderer renderer(scene, camera_);
    for (int frame = 0; frame < kFrames; frame += kStep) {
      const double time = frame / synthetic::kFramesPerSecond;
      views_.push_back({Inverse(scene.world_from_cam(time)), renderer.Render(time)});
    }
  }

  // The least distance, m, of a point from the planes that the pixels on which it falls show.
  double DistanceOf(const Eigen::Vector3d& point) const {
    double least = 1.0;
    for (const auto& [cam_from_world, frame] : views_) {
      const Eigen::Vector3d in_cam = cam_from_world * point;
      const Eigen::Vector2d pixel = camera_.Project(in_cam);
      const int x = static_cast<int>(std::lround(pixel.x()));
      const int y = static_cast<int>(std::lround(pixel.y()));
      if (in_cam.z() > 0.1 && x >= 0 && y >= 0 && x < camera_.width && y < camera_.height) {
        const double off = static_cast<double>(frame.depth.at<float>(y, x)) - in_cam.z();
        const double cosine = std::abs(static_cast<double>(frame.cosine.at<float>(y, x)));
        least = std::min(least, std::abs(off) * in_cam.norm() / in_cam.z() * cosine);
      }
    }
    return least;
  }

  // Points of all surfaces up to `most` m from the camera that its depth images show and that it
  // does not see at a grazing angle, without those at the border of the image.
  std::vector<Eigen::Vector3d> Points(const fs::path& sequence, double most) const {
    const ImageSequence images = OpenTumSequence(sequence);
    std::vector<Eigen::Vector3d> points;
    for (size_t view = 0; view < views_.size(); ++view) {
      const auto& [cam_from_world, frame] = views_[view];
      const cv::Mat measured = ReadDepthImage(images.frames.at(kStep * view).depth);
      for (int y = 10; y < camera_.height - 10; y += 7) {
        for (int x = 10; x < camera_.width - 10; x += 7) {
          const auto depth = static_cast<double>(frame.depth.at<float>(y, x));
          if (measured.at<uint16_t>(y, x) > 0 && depth < most &&
              std::abs(frame.cosine.at<float>(y, x)) > 0.3F) {
            points.push_back(Inverse(cam_from_world) * camera_.Unproject({x, y}, depth));
          }
        }
      }
    }
    return points;
  }

 private:
  static constexpr int kStep = 6;  // frames
  struct View {
    Rigid3 cam_from_world;
    synthetic::RenderedFrame frame;
  };
  PinholeCamera camera_ = synthetic::CameraOf(synthetic::SceneKind::kDesk);
  std::vector<View> views_;
};

// The share of the points that have one of the others within `most` m.
double ShareNear(const std::vector<Eigen::Vector3d>& points,
                 const std::vector<Eigen::Vector3d>& others, double most) {
  using Cell = std::tuple<int, int, int>;
  const auto cell_of = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3i at = (point / most).array().floor().cast<int>();
    return Cell(at.x(), at.y(), at.z());
  };
  std::map<Cell, std::vector<Eigen::Vector3d>> cells;
  for (const Eigen::Vector3d& other : others) {
    cells[cell_of(other)].push_back(other);
  }
  const auto is_near = [&](const Eigen::Vector3d& point) {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3d side(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const auto found = cells.find(cell_of(point + most * side));
      if (found != cells.end() &&
          std::any_of(found->second.begin(), found->second.end(),
                      [&](const auto& other) { return (other - point).norm() <= most; })) {
        return true;
      }
    }
    return false;
  };
  return static_cast<double>(std::count_if(points.begin(), points.end(), is_near)) /
         static_cast<double>(points.size());
}

TEST_F(MeshCommand, IsNearTheTrueSurface) {
  const ProgramResult result = Run({shared_->run, "--output", Out("mesh.ply")});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("triangles"), std::string::npos) << result.output;
  EXPECT_NE(result.errors.find("frame "), std::string::npos) << "the progress";
  const ReadPly mesh(ReadFile(Out("mesh.ply")));
  EXPECT_TRUE(mesh.is_consistent);
  EXPECT_GT(mesh.faces, 20'000U);
  EXPECT_GE(std::set(mesh.objects.begin(), mesh.objects.end()).size(), 3U) << "scene and objects";
  const AteResult ate = EvaluateAte(ReadTrajectory(shared_->desk.path() / "groundtruth.txt"),
                                    ReadTrajectory(shared_->run / "trajectory.txt"));
  const TrueDesk truth;
  std::vector<Eigen::Vector3d> aligned;
  double sum = 0.0;
  for (const Eigen::Vector3d& position : mesh.positions) {
    aligned.push_back(ate.reference_from_estimate * position);
    sum += truth.DistanceOf(aligned.back());
  }
  const double mean = sum / static_cast<double>(aligned.size());
  EXPECT_LT(mean, 0.005);
  const double share = ShareNear(truth.Points(shared_->desk.path(), 2.8), aligned, 0.02);
  EXPECT_GT(share, 0.95);
  RecordProperty("mean_mm", std::to_string(1e3 * mean));
  RecordProperty("share", std::to_string(share));
}

TEST_F(MeshCommand, GlbHasANodePerObjectAndTheSameBytesAgain) {
  ASSERT_EQ(
      Run({shared_->run, "--output", Out("mesh.glb"), "--quiet", "--voxel", "0.02"}).exit_code, 0);
  const std::string bytes = ReadFile(Out("mesh.glb"));
  ByteReader reader(bytes, "mesh.glb");
  reader.GetRaw(12);
  const auto size = reader.Get<uint32_t>();
  const Json json = Json::parse(bytes.substr(20, size));
  const Json& nodes = json["nodes"];
  ASSERT_GE(nodes.size(), 4U);
  EXPECT_EQ(nodes[1]["name"], "scene");
  const Json objects = Json::parse(ReadFile(shared_->run / "objects.json"));
  std::set<std::string> names;
  for (const Json& object : objects["objects"]) {
    names.insert(object["class"].get<std::string>() + " " +
                 std::to_string(object["id"].get<int>()));
  }
  for (size_t i = 2; i < nodes.size(); ++i) {
    EXPECT_TRUE(names.contains(nodes[i]["name"])) << nodes[i];
  }
  const std::string setup = "taskset -c 0 ";
  ASSERT_EQ(RunShell(setup + ShellCommand("hullslam mesh") + " '" + shared_->run.string() +
                     "' --quiet --force --voxel 0.02 --output '" + Out("mesh.glb").string() + "'"),
            0);
  EXPECT_TRUE(ReadFile(Out("mesh.glb")) == bytes) << "on one core";
}

TEST_F(MeshCommand, AMapNeedsItsSequence) {
  ExpectRefused({shared_->map, "--output", Out("mesh.glb")}, {"--sequence PATH"});
  const ProgramResult result = Run({shared_->map, "--sequence", shared_->desk.path(), "--output",
                                    Out("mesh.ply"), "--voxel", "0.02"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GT(ReadPly(ReadFile(Out("mesh.ply"))).faces, 5'000U);
}

TEST_F(MeshCommand, RefusesBadInput) {
  ExpectRefused({shared_->run, "--output", Out("mesh.obj")}, {"mesh.obj", ".glb or .ply"});
  ExpectRefused({out_.path(), "--output", Out("mesh.glb")}, {"summary.json"});
  ExpectRefused({shared_->run, "--output", Out("mesh.glb"), "--voxel", "0"}, {"--voxel"});
  ExpectRefused({shared_->run, "--output", Out("mesh.glb"), "--sequence", Out("none")}, {"none"});
  ExpectRefused({shared_->run, "--output", shared_->desk.path() / "mesh.glb"}, {"inside"});
}

TEST_F(MeshCommand, AFullDiskLeavesTheFormerFile) {
  out_.Write("mesh.ply", "former");
  const ProgramResult exists = Run({shared_->run, "--output", Out("mesh.ply")});
  EXPECT_EQ(exists.exit_code, 2);
  EXPECT_NE(exists.errors.find("--force"), std::string::npos) << exists.errors;
  const ProgramResult full =
      Run({shared_->run, "--output", Out("mesh.ply"), "--force", "--voxel", "0.02", "--quiet"},
          "ulimit -f 8; ");
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_NE(full.errors.find("cannot be written"), std::string::npos) << full.errors;
  EXPECT_EQ(ReadFile(Out("mesh.ply")), "former");
}

TEST_F(MeshCommand, AnInterruptionWritesNothing) {
  RunningProgram program("hullslam mesh",
                         {shared_->run, "--output", Out("mesh.glb"), "--every", "1"});
  EXPECT_FALSE(program.ReadLine("frame ").empty());
  program.Send(SIGINT);
  EXPECT_FALSE(program.ReadLine("error: ").empty());
  EXPECT_EQ(program.Wait(), 1);
  EXPECT_TRUE(fs::is_empty(out_.path()));
}

}  // namespace
}  // namespace hullslam
