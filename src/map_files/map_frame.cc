// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <utility>

#include "files/plausible.h"
#include "frame/keypoint_grid.h"
#include "map_files/map_records.h"

namespace hullslam {

void WriteWords(const Frame& frame, ByteWriter& out) {
  out.PutFlag(!frame.words.empty());
  for (const WordId word : frame.words.get()) {
    out.Put(word.value);
  }
}

void ReadWords(Frame& frame, ByteReader& in) {
  if (!in.GetFlag()) {
    return;
  }
  in.Require(frame.features.size() <= in.left() / sizeof(uint32_t),
             "has fewer words than keypoints");
  std::vector<WordId> words;
  words.reserve(frame.features.size());
  for (size_t i = 0; i < frame.features.size(); ++i) {
    words.emplace_back(in.Get<uint32_t>());
  }
  frame.words = std::move(words);
}

namespace {

constexpr auto kMostPixel = static_cast<float>(kMostPixels);
constexpr auto kMostDepth = static_cast<float>(kMostMetres);
// Older versions wrote the column in the right image, which follows from the depth.
constexpr float kNoColumn = -1.0f;

void WriteFeatures(const FrameFeatures& features, ByteWriter& out) {
  out.PutCount(features.size());
  for (size_t i = 0; i < features.size(); ++i) {
    const Keypoint& keypoint = features.keypoints[i];
    out.PutMatrix(keypoint.undistorted);
    out.Put(keypoint.angle);
    out.Put(static_cast<uint8_t>(keypoint.level));
    out.Put(features.depth[i]);
    out.Put(kNoColumn);
    for (const uint64_t word : features.descriptors[i]) {
      out.Put(word);
    }
  }
}

FrameFeatures ReadFeatures(const MapSettings& settings, ByteReader& in) {
  constexpr size_t kBytes = 5 * sizeof(float) + 1 + sizeof(Descriptor);
  constexpr float kMostAngle = 100.0f;  // radians
  FrameFeatures features;
  const size_t count = in.GetCount(kBytes);
  in.Require(count <= std::numeric_limits<uint16_t>::max(), "has too many keypoints");
  features.keypoints.reserve(count);
  features.descriptors.reserve(count);
  features.depth.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    Keypoint keypoint;
    keypoint.undistorted = in.GetMatrix<Eigen::Vector2f>(kMostPixel);
    keypoint.angle = in.GetFinite(kMostAngle);
    keypoint.level = in.Get<uint8_t>();
    in.Require(keypoint.level < settings.level_count, "has a keypoint of a level that is not used");
    features.keypoints.push_back(keypoint);
    features.depth.push_back(in.GetFinite(kMostDepth));
    in.GetFinite(std::numeric_limits<float>::max());
    Descriptor descriptor{};
    for (uint64_t& word : descriptor) {
      word = in.Get<uint64_t>();
    }
    features.descriptors.push_back(descriptor);
  }
  features.grid = MakeKeypointGrid(features.keypoints, settings.camera);
  return features;
}

void WriteDepth(const DepthGrid& grid, ByteWriter& out) {
  out.PutFlag(!grid.empty());
  for (const uint16_t sample : grid.samples()) {
    out.Put(sample);
  }
}

// The size of the grid is not written, because it follows from the size of the image.
DepthGrid ReadDepth(const PinholeCamera& camera, ByteReader& in) {
  if (!in.GetFlag()) {
    return {};
  }
  const int columns = DepthGrid::CountAlong(camera.width);
  const auto count =
      static_cast<size_t>(columns) * static_cast<size_t>(DepthGrid::CountAlong(camera.height));
  in.Require(count > 0 && in.left() / sizeof(uint16_t) >= count, "is cut off");
  std::vector<uint16_t> samples(count);
  for (uint16_t& sample : samples) {
    sample = in.Get<uint16_t>();
  }
  return {columns, std::move(samples)};
}

}  // namespace

void WriteFrame(const Frame& frame, ByteWriter& out) {
  out.Put(frame.id.value);
  out.Put(frame.timestamp);
  WriteFeatures(frame.features, out);
  WriteWords(frame, out);
  out.PutCount(frame.detections.size());
  for (const Detection& detection : frame.detections) {
    WriteDetection(detection, out);
  }
  WriteDepth(frame.depth, out);
}

std::shared_ptr<const Frame> ReadFrame(const MapHeader& header, ByteReader& in) {
  const MapSettings& settings = header.settings;
  auto frame = std::make_shared<Frame>();
  frame->id = FrameId(in.Get<uint32_t>());
  frame->timestamp = in.GetFinite(kMostSeconds);
  frame->features = ReadFeatures(settings, in);
  ReadWords(*frame, in);
  const size_t detections = in.GetCount(sizeof(uint64_t));
  for (size_t i = 0; i < detections; ++i) {
    frame->detections.push_back(ReadDetection(frame->features.size(), in));
  }
  frame->depth = ReadDepth(settings.camera, in);
  return frame;
}

}  // namespace hullslam
