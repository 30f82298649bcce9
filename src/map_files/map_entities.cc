// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "files/plausible.h"
#include "map_files/map_records.h"
#include "util/text.h"

namespace hullslam {
namespace {

// Reads a length in metres or pixels. Refuses negative ones.
double ReadLength(ByteReader& in) {
  const double length = in.GetFinite(kMostMapNumber);
  in.Require(length >= 0.0, "has a negative length");
  return length;
}

double ReadScale(ByteReader& in) {
  constexpr double kMost = 1e9;
  const double scale = in.GetFinite(kMost);
  in.Require(scale >= 1.0 / kMost, "has a scale that is out of range");
  return scale;
}

constexpr int32_t kMostTimes = 1 << 29;  // the sum of two such numbers does not overflow

// Writes how many times something was seen. A longer count stays at the largest one, so that what
// is written can be read.
template <typename Count>
void PutTimes(Count times, ByteWriter& out) {
  out.Put(static_cast<int32_t>(std::min<Count>(times, kMostTimes)));
}

int ReadTimes(ByteReader& in) {
  const auto times = in.Get<int32_t>();
  in.Require(times >= 0 && times <= kMostTimes, "has a count that is out of range");
  return times;
}

template <typename IdType>
void WriteIds(const std::vector<IdType>& ids, ByteWriter& out) {
  for (const IdType id : ids) {
    out.Put(id.value);
  }
}

template <typename IdType>
std::vector<IdType> ReadIds(size_t count, ByteReader& in) {
  in.Require(count <= in.left() / sizeof(uint32_t), "is cut off");
  std::vector<IdType> ids;
  ids.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    ids.push_back(IdType(in.Get<uint32_t>()));
  }
  return ids;
}

// Reads the id of a keyframe. Every id belongs to a keyframe or to a culled keyframe, so it is
// smaller than the number of both.
KeyframeId ReadKeyframeId(const MapHeader& header, KeyframeId next, ByteReader& in) {
  const KeyframeId id(in.Get<uint32_t>());
  in.Require(!(id < next) && id.value < uint64_t{header.keyframes} + header.culled,
             "has an id that is out of order");
  return id;
}

void WriteEllipsoid(const Ellipsoid& ellipsoid, ByteWriter& out) {
  WritePose(ellipsoid.world_from_object, out);
  out.PutMatrix(ellipsoid.half_axes);
}

Ellipsoid ReadEllipsoid(ByteReader& in) {
  Ellipsoid ellipsoid;
  ellipsoid.world_from_object = ReadPose(in);
  ellipsoid.half_axes = in.GetMatrix<Eigen::Vector3d>(kMostMetres);
  in.Require(ellipsoid.half_axes.minCoeff() > 0.0, "has half axes that are not positive");
  return ellipsoid;
}

void WriteVotes(const std::map<std::string, double>& votes, ByteWriter& out) {
  out.PutCount(votes.size());
  for (const auto& [label, sum] : votes) {
    out.PutText(label);
    out.Put(sum);
  }
}

std::map<std::string, double> ReadVotes(ByteReader& in) {
  std::map<std::string, double> votes;
  const size_t count = in.GetCount(sizeof(uint32_t) + sizeof(double));
  std::string last;
  for (size_t i = 0; i < count; ++i) {
    std::string label = in.GetText();
    in.Require(i == 0 || last < label, "has votes out of order");
    votes[Printable(label)] += in.GetFinite(kMostMapNumber);
    last = std::move(label);
  }
  return votes;
}

void WriteSamples(const std::vector<MisfitSample>& samples, ByteWriter& out) {
  out.PutCount(samples.size());
  for (const MisfitSample& sample : samples) {
    out.PutMatrix(sample.normal);
    out.Put(sample.excess);
    out.Put(sample.keyframe.value);
  }
}

std::vector<MisfitSample> ReadSamples(ByteReader& in) {
  std::vector<MisfitSample> samples(in.GetCount(4 * sizeof(float) + sizeof(uint32_t)));
  for (MisfitSample& sample : samples) {
    sample.normal = in.GetMatrix<Eigen::Vector3f>(2.0f);
    sample.excess = in.GetFinite(static_cast<float>(kMostMapNumber));
    sample.keyframe = KeyframeId(in.Get<uint32_t>());
  }
  return samples;
}

// The bits of the first byte of an object. Its name and its known size come last, if it has them.
enum ObjectBits : uint8_t { kMappedBit = 1, kNamedBit = 2, kLockedBit = 4, kSizedBit = 8 };

}  // namespace

void WritePose(const Rigid3& pose, ByteWriter& out) {
  out.PutMatrix(pose.rotation.coeffs());
  out.PutMatrix(pose.translation);
}

Rigid3 ReadPose(ByteReader& in) {
  constexpr double kTolerance = 1e-6;
  Rigid3 pose;
  pose.rotation.coeffs() = in.GetMatrix<Eigen::Vector4d>(2.0);
  in.Require(std::abs(pose.rotation.norm() - 1.0) < kTolerance, "has a rotation that is none");
  pose.translation = in.GetMatrix<Eigen::Vector3d>(kMostMetres);
  return pose;
}

void WriteKeyframe(KeyframeId id, const Keyframe& keyframe, ByteWriter& out) {
  out.Put(id.value);
  WriteFrame(*keyframe.frame, out);
  WritePose(keyframe.cam_from_world, out);
  out.Put(keyframe.scale);
  WriteIds(keyframe.landmarks, out);
  WriteIds(keyframe.objects, out);
  out.PutCount(keyframe.covisible.size());
  for (const Covisible& edge : keyframe.covisible) {
    out.Put(edge.keyframe.value);
    PutTimes(edge.shared, out);
  }
  out.Put(keyframe.parent.value);
  out.Put(keyframe.island.value);
  out.PutCount(keyframe.loops.size());
  WriteIds(keyframe.loops, out);
}

void ReadKeyframe(const MapHeader& header, ByteReader& in, MapTables& tables) {
  const KeyframeId id = ReadKeyframeId(header, tables.keyframes.NextId(), in);
  Keyframe keyframe;
  keyframe.frame = ReadFrame(header, in);
  keyframe.cam_from_world = ReadPose(in);
  keyframe.scale = ReadScale(in);
  keyframe.landmarks = ReadIds<LandmarkId>(keyframe.frame->features.size(), in);
  keyframe.objects = ReadIds<ObjectId>(keyframe.frame->detections.size(), in);
  keyframe.covisible.resize(in.GetCount(2 * sizeof(uint32_t)));
  for (Covisible& edge : keyframe.covisible) {
    edge.keyframe = KeyframeId(in.Get<uint32_t>());
    edge.shared = ReadTimes(in);
  }
  keyframe.parent = KeyframeId(in.Get<uint32_t>());
  keyframe.island = IslandId(in.Get<uint32_t>());
  keyframe.loops = ReadIds<KeyframeId>(in.GetCount(sizeof(uint32_t)), in);
  tables.keyframes.Put(id, std::move(keyframe));
}

void WriteCulled(KeyframeId id, const CulledKeyframe& culled, ByteWriter& out) {
  out.Put(id.value);
  out.Put(culled.frame.value);
  out.Put(culled.pose.reference.value);
  WritePose(culled.pose.cam_from_reference, out);
  out.Put(culled.pose.reference_scale);
  out.Put(culled.scale);
}

void ReadCulled(const MapHeader& header, ByteReader& in, MapTables& tables) {
  const KeyframeId id = ReadKeyframeId(header, tables.culled.NextId(), in);
  CulledKeyframe culled;
  culled.frame = FrameId(in.Get<uint32_t>());
  culled.pose.reference = KeyframeId(in.Get<uint32_t>());
  culled.pose.cam_from_reference = ReadPose(in);
  culled.pose.reference_scale = ReadScale(in);
  culled.scale = ReadScale(in);
  tables.culled.Put(id, culled);
}

void WriteLandmark(LandmarkId id, const Landmark& landmark, ByteWriter& out) {
  out.Put(id.value);
  out.PutMatrix(landmark.position);
  out.PutMatrix(landmark.viewing_direction);
  out.Put(landmark.min_distance);
  out.Put(landmark.max_distance);
  for (const uint64_t word : landmark.descriptor) {
    out.Put(word);
  }
  out.Put(landmark.reference.value);
  out.Put(landmark.created_by.value);
  PutTimes(landmark.visible, out);
  PutTimes(landmark.found, out);
}

void ReadLandmark(const MapHeader& header, ByteReader& in, MapTables& tables) {
  const LandmarkId id(in.Get<uint32_t>());
  in.Require(tables.landmarks.used_slots() <= id.slot() && id.slot() < header.landmark_slots,
             "has an id that is out of order");
  Landmark landmark;
  landmark.position = in.GetMatrix<Eigen::Vector3d>(kMostMapNumber);
  landmark.viewing_direction = in.GetMatrix<Eigen::Vector3d>(2.0);
  landmark.min_distance = ReadLength(in);
  landmark.max_distance = ReadLength(in);
  for (uint64_t& word : landmark.descriptor) {
    word = in.Get<uint64_t>();
  }
  landmark.reference = KeyframeId(in.Get<uint32_t>());
  landmark.created_by = KeyframeId(in.Get<uint32_t>());
  landmark.visible = ReadTimes(in);
  landmark.found = ReadTimes(in);
  tables.landmarks.Put(id, std::move(landmark));
}

void WriteObject(ObjectId id, const ObjectLandmark& object, ByteWriter& out) {
  out.Put(id.value);
  out.Put(static_cast<uint8_t>((object.state == ObjectState::kMapped ? kMappedBit : 0) |
                               (object.name.empty() ? 0 : kNamedBit) |
                               (object.is_locked ? kLockedBit : 0) |
                               (object.known_size > 0.0 ? kSizedBit : 0)));
  out.PutFlag(object.has_shape);
  WriteEllipsoid(object.ellipsoid, out);
  WriteEllipsoid(object.start, out);
  WriteVotes(object.votes, out);
  out.Put(object.reference.value);
  PutTimes(object.shaped_views, out);
  out.Put(object.misfit_px);
  out.Put(object.compensated_px);
  WriteSamples(object.misfit_samples, out);
  PutTimes(object.visible, out);
  PutTimes(object.found, out);
  if (!object.name.empty()) {
    out.PutText(object.name);
  }
  if (object.known_size > 0.0) {
    out.Put(object.known_size);
  }
}

void ReadObject(const MapHeader& header, ByteReader& in, MapTables& tables) {
  const ObjectId id(in.Get<uint32_t>());
  in.Require(!(id < tables.objects.NextId()) && id.value < header.next_object,
             "has an id that is out of order");
  ObjectLandmark object;
  const auto bits = in.Get<uint8_t>();
  in.Require(bits < 2 * kSizedBit, "has a state that is none");
  object.state = (bits & kMappedBit) != 0 ? ObjectState::kMapped : ObjectState::kCandidate;
  object.is_locked = (bits & kLockedBit) != 0;
  object.has_shape = in.GetFlag();
  object.ellipsoid = ReadEllipsoid(in);
  object.start = ReadEllipsoid(in);
  object.votes = ReadVotes(in);
  object.reference = KeyframeId(in.Get<uint32_t>());
  object.shaped_views = static_cast<size_t>(ReadTimes(in));
  object.misfit_px = ReadLength(in);
  object.compensated_px = ReadLength(in);
  object.misfit_samples = ReadSamples(in);
  object.visible = ReadTimes(in);
  object.found = ReadTimes(in);
  if ((bits & kNamedBit) != 0) {
    object.name = in.GetText();
    in.Require(!object.name.empty() && ObjectLandmark::IsName(object.name),
               "has a name that is empty, too long or not printable UTF-8");
  }
  if ((bits & kSizedBit) != 0) {
    object.known_size = in.Get<double>();
    in.Require(ObjectLandmark::IsSize(object.known_size),
               "has a known size that is not from 0.001 to 100 m");
  }
  tables.objects.Put(id, std::move(object));
}

}  // namespace hullslam
