// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "camera/point_measurement.h"
#include "exports/single_files.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

// What a program reads from a file of g2o, written from the description of the format alone.
struct ReadGraph {
  struct Edge {
    Rigid3 first_from_second;
    Matrix6d information = Matrix6d::Zero();
  };
  std::map<int, Rigid3> poses;
  std::map<int, Eigen::Vector3d> points;
  std::map<std::pair<int, int>, Edge> edges;
  std::set<int> fixed;

  explicit ReadGraph(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream row(line);
      std::string tag;
      int id = 0;
      row >> tag >> id;
      if (tag == "VERTEX_SE3:QUAT") {
        poses[id] = ReadPose(row);
      } else if (tag == "VERTEX_TRACKXYZ") {
        Eigen::Vector3d& point = points[id];
        row >> point.x() >> point.y() >> point.z();
      } else if (tag == "EDGE_SE3:QUAT") {
        int second = 0;
        row >> second;
        Edge& edge = edges[{id, second}];
        edge.first_from_second = ReadPose(row);
        for (int i = 0; i < 6; ++i) {
          for (int j = i; j < 6; ++j) {
            row >> edge.information(i, j);
            edge.information(j, i) = edge.information(i, j);
          }
        }
      } else if (tag == "FIX") {
        fixed.insert(id);
      } else {
        ADD_FAILURE() << line;
      }
      EXPECT_TRUE(row) << line;
      std::string rest;
      EXPECT_FALSE(row >> rest) << line;
    }
  }

  static Rigid3 ReadPose(std::istream& row) {
    Rigid3 pose;
    Eigen::Vector3d& t = pose.translation;
    Eigen::Quaterniond& q = pose.rotation;
    row >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
    return pose;
  }
};

class G2o : public ::testing::Test {
 protected:
  G2o() : made_(MakeSyntheticMap(world_, {0, 10, 20, 30})) {
    made_.map.AddLoop(KeyframeId(0), KeyframeId(3));
    located_ = LocateLandmarks(made_.map, world_.sensor());
  }
  ReadGraph Read() const { return ReadGraph(FormatG2o(made_.map, located_, world_.sensor())); }

  SyntheticWorld world_;
  SyntheticMap made_;
  LocatedLandmarks located_;
};

TEST_F(G2o, PosesAndLandmarksAreReadBack) {
  const ReadGraph graph = Read();
  ASSERT_EQ(graph.poses.size(), 4U);
  EXPECT_EQ(graph.fixed, std::set<int>{0});
  for (const auto& [id, world_from_cam] : graph.poses) {
    const Rigid3 expected = Inverse(SyntheticWorld::CamFromWorld(10.0 * id));
    EXPECT_NEAR((world_from_cam.translation - expected.translation).norm(), 0.0, 1e-8);
    EXPECT_NEAR(AngularDistance(world_from_cam.rotation, expected.rotation), 0.0, 1e-7);
  }
  ASSERT_EQ(graph.points.size(), located_.positions.size());
  EXPECT_EQ(graph.points.begin()->first, 4);
  EXPECT_NEAR((graph.points.begin()->second - located_.positions[0]).norm(), 0.0, 1e-8);
}

TEST_F(G2o, EdgesAgreeWithThePoses) {
  const ReadGraph graph = Read();
  EXPECT_TRUE(graph.edges.contains({0, 3}));
  EXPECT_GE(graph.edges.size(), 4U);
  for (const auto& [ids, edge] : graph.edges) {
    const Rigid3 difference = Inverse(edge.first_from_second) * Inverse(graph.poses.at(ids.first)) *
                              graph.poses.at(ids.second);
    EXPECT_NEAR(difference.translation.norm(), 0.0, 1e-7);
    EXPECT_NEAR(AngularDistance(difference.rotation, Eigen::Quaterniond::Identity()), 0.0, 1e-6);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(edge.information).eigenvalues().minCoeff(),
              0.0);
  }
}

// The sum of the squared residuals of the common landmarks in the second keyframe, if it is moved
// by `error` as g2o defines the error of an edge.
double CostOf(const Map& map, const Sensor& sensor, const Vector6d& error) {
  const Keyframe& first = map.keyframes().At(KeyframeId(0));
  const Keyframe& second = map.keyframes().At(KeyframeId(1));
  const std::set<LandmarkId> shared(first.landmarks.begin(), first.landmarks.end());
  const Eigen::Vector3d vector = error.tail<3>();
  const Rigid3 motion(
      Eigen::Quaterniond(std::sqrt(1.0 - vector.squaredNorm()), vector.x(), vector.y(), vector.z()),
      error.head<3>());
  const Rigid3 moved = Inverse(motion) * second.cam_from_world;
  double cost = 0.0;
  for (size_t i = 0; i < second.landmarks.size(); ++i) {
    if (!second.landmarks[i].IsValid() || !shared.contains(second.landmarks[i])) {
      continue;
    }
    const Eigen::Vector3d& position = map.landmarks().At(second.landmarks[i]).position;
    const FrameFeatures& features = second.frame->features;
    const double depth = features.depth[i];
    const PointMeasurement measurement = PointMeasurement::Create(
        features.keypoints[i].undistorted.cast<double>(),
        sensor.levels.scale[static_cast<size_t>(features.keypoints[i].level)],
        depth > 0.0 ? std::optional(sensor.camera.bf / depth) : std::nullopt, sensor.depth_error);
    cost += PointResidual(sensor.camera, measurement, moved * position).squaredNorm();
  }
  return cost;
}

TEST_F(G2o, TheInformationIsTheCurvatureOfTheReprojectionErrors) {
  const Matrix6d information = Read().edges.at({0, 1}).information;
  for (int i = 0; i < 6; ++i) {
    constexpr double kStep = 1e-4;
    Vector6d error = Vector6d::Constant(0.2 * kStep);
    error[i] = kStep;
    const double cost = CostOf(made_.map, world_.sensor(), error);
    EXPECT_NEAR(cost / error.dot(information * error), 1.0, 0.02) << i;
  }
}

}  // namespace
}  // namespace hullslam
