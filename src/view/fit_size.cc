// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/fit_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "files/base64.h"

namespace hullslam {
namespace {

// Bytes of the text of small parts, such as the settings and the names of keys.
constexpr size_t kOther = 20'000;

template <typename T>
void HalveList(std::vector<T>& list) {
  size_t kept = 0;
  for (size_t i = 0; i < list.size(); i += 2) {
    if (kept != i) {
      list[kept] = std::move(list[i]);
    }
    ++kept;
  }
  list.resize(std::min(kept, list.size()));
}

double MeanEdge(const PlySurface& surface) {  // m
  double sum = 0.0;
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    sum += (surface.positions[triangle[1]] - surface.positions[triangle[0]]).norm();
  }
  return sum / static_cast<double>(surface.triangles.size());
}

// The surface with one vertex for all those in a cube of a grid: their mean. Triangles with two
// corners in one cube are left out.
PlySurface JoinInCubes(const PlySurface& surface, double side) {
  struct Sum {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d colour = Eigen::Vector3d::Zero();
    double count = 0.0;
  };
  std::map<std::array<int64_t, 3>, uint32_t> cubes;
  std::vector<Sum> sums;
  std::vector<uint32_t> joined;  // the vertex of the result for each of the surface
  for (size_t i = 0; i < surface.positions.size(); ++i) {
    const Eigen::Vector3d position = surface.positions[i].cast<double>();
    std::array<int64_t, 3> cube{};
    for (int axis = 0; axis < 3; ++axis) {
      cube.at(static_cast<size_t>(axis)) = std::llround(position[axis] / side);
    }
    const auto [found, is_new] = cubes.try_emplace(cube, static_cast<uint32_t>(sums.size()));
    Sum& sum = is_new ? sums.emplace_back() : sums[found->second];
    const Colour& colour = surface.colours[i];
    sum.position += position;
    sum.colour += Eigen::Vector3d(colour[0], colour[1], colour[2]);
    sum.count += 1.0;
    joined.push_back(found->second);
  }
  PlySurface result;
  for (const Sum& sum : sums) {
    const Eigen::Vector3d colour = (sum.colour / sum.count).array().round();
    result.positions.push_back((sum.position / sum.count).cast<float>());
    result.colours.push_back({static_cast<uint8_t>(colour[0]), static_cast<uint8_t>(colour[1]),
                              static_cast<uint8_t>(colour[2])});
  }
  for (const auto& [a, b, c] : surface.triangles) {
    if (joined[a] != joined[b] && joined[b] != joined[c] && joined[c] != joined[a]) {
      result.triangles.push_back({joined[a], joined[b], joined[c]});
    }
  }
  return result;
}

// Makes the triangles larger, until half of them are left or fewer.
void HalveSurface(PlySurface& surface) {
  constexpr double kGrowth = 1.25;
  constexpr double kLeastSide = 1e-6;  // m
  constexpr int kMostTries = 60;
  const size_t most = surface.triangles.size() / 2;
  double side = surface.triangles.empty() ? 0.0 : std::max(kLeastSide, MeanEdge(surface));
  for (int i = 0; i < kMostTries && surface.triangles.size() > most; ++i) {
    PlySurface joined = JoinInCubes(surface, side);
    if (joined.triangles.size() <= most) {
      surface = std::move(joined);
    }
    side *= kGrowth;
  }
  if (surface.triangles.size() > most || surface.triangles.empty()) {
    surface = {};
  }
}

size_t BytesOf(const std::vector<ViewShape>& shapes) {
  constexpr size_t kPerPoint = 12;
  size_t bytes = 0;
  for (const ViewShape& shape : shapes) {
    bytes += 60 + shape.label.size() + kPerPoint * shape.points.size();
  }
  return bytes;
}

size_t BytesOf(const std::vector<ViewPicture>& pictures) {
  size_t bytes = 0;
  for (const ViewPicture& picture : pictures) {
    bytes += 150 + Base64Size(picture.jpeg.size()) + BytesOf(picture.outlines) +
             BytesOf(picture.ellipses);
  }
  return bytes;
}

// A part of the model that can be thinned.
struct Part {
  const char* name;
  std::function<size_t()> bytes;
  std::function<size_t()> count;
  std::function<void()> halve;
};

Part LandmarksPart(ViewLandmarks& landmarks) {
  return {"landmarks", [&] { return Base64Size(19 * landmarks.positions.size()); },
          [&] { return landmarks.positions.size(); },
          [&] {
            HalveList(landmarks.positions);
            HalveList(landmarks.colours);
            HalveList(landmarks.created);
          }};
}

// A vertex with three floats and three bytes, and three numbers per triangle.
Part SurfacePart(PlySurface& surface) {
  return {"triangles of the surface",
          [&] { return Base64Size(15 * surface.positions.size() + 12 * surface.triangles.size()); },
          [&] { return surface.triangles.size(); }, [&] { HalveSurface(surface); }};
}

Part PosesPart(const char* name, Trajectory& poses) {
  return {name, [&] { return Base64Size(32 * poses.size()); }, [&] { return poses.size(); },
          [&] { HalveList(poses); }};
}

Part CutoutsPart(std::vector<ViewObject>& objects) {
  const auto count = [&objects] {
    size_t sum = 0;
    for (const ViewObject& object : objects) {
      sum += object.cutouts.size();
    }
    return sum;
  };
  const auto bytes = [&objects] {
    size_t sum = 0;
    for (const ViewObject& object : objects) {
      sum += BytesOf(object.cutouts);
    }
    return sum;
  };
  // Each object keeps its best cut-out as long as it has others; then every second object loses it.
  const auto halve = [&objects] {
    const bool is_last = std::all_of(objects.begin(), objects.end(), [](const ViewObject& object) {
      return object.cutouts.size() <= 1;
    });
    for (size_t i = 0; i < objects.size(); ++i) {
      const size_t kept = is_last && i % 2 == 1 ? 0 : (objects[i].cutouts.size() + 1) / 2;
      objects[i].cutouts.resize(is_last && kept == 1 && objects.size() == 1 ? 0 : kept);
    }
  };
  return {"cut-outs of objects", bytes, count, halve};
}

std::vector<Part> PartsOf(ViewModel& model) {
  return {LandmarksPart(model.landmarks),
          SurfacePart(model.surface),
          PosesPart("poses of frames", model.trajectory),
          PosesPart("poses of the ground truth", model.groundtruth),
          {"pictures", [&] { return BytesOf(model.pictures); },
           [&] { return model.pictures.size(); }, [&] { HalveList(model.pictures); }},
          CutoutsPart(model.objects),
          {"covisibility edges", [&] { return Base64Size(8 * model.edges.covisibility.size()); },
           [&] { return model.edges.covisibility.size(); },
           [&] { HalveList(model.edges.covisibility); }},
          {"errors", [&] { return Base64Size(8 * model.errors.metres.size()); },
           [&] { return model.errors.metres.size(); },
           [&] {
             HalveList(model.errors.metres);
             HalveList(model.errors.timestamps);
           }}};
}

size_t FixedBytes(const ViewModel& model) {
  constexpr size_t kPerObject = 700;
  size_t bytes = kOther + Base64Size(36 * model.keyframes.poses.size());
  for (const ViewObject& object : model.objects) {
    bytes += kPerObject + 40 * object.object.votes.size();
  }
  return bytes + 80 * model.relations.size();
}

size_t SumOf(const std::vector<Part>& parts) {
  size_t sum = 0;
  for (const Part& part : parts) {
    sum += part.bytes();
  }
  return sum;
}

}  // namespace

void ThinToFit(size_t most_bytes, ViewModel& model) {
  const std::vector<Part> parts = PartsOf(model);
  std::vector<size_t> counts;
  for (const Part& part : parts) {
    counts.push_back(part.count());
  }
  while (FixedBytes(model) + SumOf(parts) > most_bytes) {
    const auto largest =
        std::max_element(parts.begin(), parts.end(),
                         [](const Part& a, const Part& b) { return a.bytes() < b.bytes(); });
    const size_t before = largest->count();
    largest->halve();
    if (largest->count() == before) {
      break;
    }
  }
  for (size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].count() < counts[i]) {
      model.notes.push_back(
          fmt::format("thinned to {} of {} {}, because a report has at most {} MB",
                      parts[i].count(), counts[i], parts[i].name, kMostReportBytes / 1'000'000));
    }
  }
}

}  // namespace hullslam
