// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>

#include "map_files/map_records.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr double kMostDouble =
    std::numeric_limits<double>::max();  // an empty box has corners of this size
constexpr auto kMostFloat = static_cast<float>(kMostMapNumber);

// Bits of one byte, which says whether lines of the right image follow.
constexpr uint8_t kIsBox = 1;
constexpr uint8_t kHasRightLines = 2;

template <int N>
void WritePoints(const PackedPoints<N>& points, ByteWriter& out) {
  out.PutMatrix(points.min());
  out.PutMatrix(points.step());
  out.PutCount(points.size());
  for (const auto& point : points.packed()) {
    for (const uint16_t coordinate : point) {
      out.Put(coordinate);
    }
  }
}

template <int N>
PackedPoints<N> ReadPoints(ByteReader& in) {
  using Corner = typename PackedPoints<N>::Corner;
  const Corner min = in.GetMatrix<Corner>(kMostFloat);
  const Corner step = in.GetMatrix<Corner>(kMostFloat);
  std::vector<typename PackedPoints<N>::Packed> packed(in.GetCount(N * sizeof(uint16_t)));
  for (auto& point : packed) {
    for (uint16_t& coordinate : point) {
      coordinate = in.Get<uint16_t>();
    }
  }
  return PackedPoints<N>(min, step, std::move(packed));
}

void WriteLines(const std::vector<SilhouetteLine>& lines, ByteWriter& out) {
  out.PutCount(lines.size());
  for (const SilhouetteLine& line : lines) {
    out.PutMatrix(line.line.normal);
    out.Put(line.line.offset);
    out.PutFlag(line.is_one_sided);
  }
}

std::vector<SilhouetteLine> ReadLines(ByteReader& in) {
  std::vector<SilhouetteLine> lines(in.GetCount(3 * sizeof(double) + 1));
  for (SilhouetteLine& line : lines) {
    line.line.normal = in.GetMatrix<Eigen::Vector2d>(2.0);
    line.line.offset = in.GetFinite(kMostMapNumber);
    line.is_one_sided = in.GetFlag();
  }
  return lines;
}

}  // namespace

void WriteDetection(const Detection& detection, ByteWriter& out) {
  out.PutText(detection.label);
  out.Put(detection.score);
  WritePoints(detection.contour, out);
  out.PutCount(detection.hull.size());
  for (const Eigen::Vector2d& corner : detection.hull) {
    out.PutMatrix(corner);
  }
  out.PutMatrix(detection.box.min());
  out.PutMatrix(detection.box.max());
  out.Put(static_cast<uint8_t>(detection.primitive));
  WriteLines(detection.lines, out);
  out.PutFlag(detection.ellipse.has_value());
  if (detection.ellipse) {
    out.PutMatrix(detection.ellipse->center);
    out.PutMatrix(detection.ellipse->shape);
  }
  out.PutCount(detection.embedding.size());
  for (const float element : detection.embedding) {
    out.Put(element);
  }
  out.PutFlag(detection.is_cut);
  const bool has_right = !detection.right_lines.empty();
  out.Put(static_cast<uint8_t>((detection.is_box ? kIsBox : 0) | (has_right ? kHasRightLines : 0)));
  if (has_right) {
    WriteLines(detection.right_lines, out);
  }
  WritePoints(detection.points, out);
  out.PutCount(detection.keypoints.size());
  for (const uint32_t keypoint : detection.keypoints) {
    out.Put(keypoint);
  }
}

Detection ReadDetection(size_t keypoints, ByteReader& in) {
  Detection detection;
  detection.label = Printable(in.GetText());
  detection.score = in.GetFinite(kMostMapNumber);
  detection.contour = ReadPoints<2>(in);
  detection.hull.resize(in.GetCount(2 * sizeof(double)));
  for (Eigen::Vector2d& corner : detection.hull) {
    corner = in.GetMatrix<Eigen::Vector2d>(kMostMapNumber);
  }
  detection.box.min() = in.GetMatrix<Eigen::Vector2d>(kMostDouble);
  detection.box.max() = in.GetMatrix<Eigen::Vector2d>(kMostDouble);
  const auto primitive = in.Get<uint8_t>();
  in.Require(primitive < ObjectPrimitiveNames().size(), "has an unknown primitive");
  detection.primitive = static_cast<ObjectPrimitive>(primitive);
  detection.lines = ReadLines(in);
  if (in.GetFlag()) {
    Ellipse& ellipse = detection.ellipse.emplace();
    ellipse.center = in.GetMatrix<Eigen::Vector2d>(kMostMapNumber);
    ellipse.shape = in.GetMatrix<Eigen::Matrix2d>(kMostMapNumber);
  }
  detection.embedding.resize(in.GetCount(sizeof(float)));
  for (float& element : detection.embedding) {
    element = in.GetFinite(1.0F);
  }
  detection.is_cut = in.GetFlag();
  const auto flags = in.Get<uint8_t>();
  in.Require(flags <= (kIsBox | kHasRightLines), "has an unknown flag of a detection");
  detection.is_box = (flags & kIsBox) != 0;
  if ((flags & kHasRightLines) != 0) {
    detection.right_lines = ReadLines(in);
  }
  detection.points = ReadPoints<3>(in);
  detection.keypoints.resize(in.GetCount(sizeof(uint32_t)));
  for (uint32_t& keypoint : detection.keypoints) {
    keypoint = in.Get<uint32_t>();
    in.Require(keypoint < keypoints, "has a detection with a keypoint that does not exist");
  }
  return detection;
}

}  // namespace hullslam
