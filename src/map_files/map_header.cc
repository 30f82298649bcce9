// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <utility>

#include "camera/wide_lens.h"
#include "map_files/map_records.h"

namespace hullslam {
namespace {

// The numbers of the sensors in the file.
constexpr uint8_t kRgbd = 1;
constexpr uint8_t kMonocular = 2;
constexpr uint8_t kStereo = 3;
// Added to the number of the sensor if the camera has more than Brown's five coefficients. Then
// these follow the camera.
constexpr uint8_t kMoreOfLens = 16;
// Added instead of it for a lens that was not known when the format began. Then its type and its
// coefficients follow the camera.
constexpr uint8_t kNamedLens = 32;

uint8_t NumberOf(SensorKind sensor) {
  return sensor == SensorKind::kMonocular ? kMonocular
         : sensor == SensorKind::kStereo  ? kStereo
                                          : kRgbd;
}

constexpr int kMostLevels = 64;
constexpr double kMostScaleFactor = 16.0;

void WriteCamera(const PinholeCamera& camera, ByteWriter& out) {
  for (const double number : {camera.fx, camera.fy, camera.cx, camera.cy, camera.k1, camera.k2,
                              camera.p1, camera.p2, camera.k3, camera.bf}) {
    out.Put(number);
  }
  out.Put(static_cast<int32_t>(camera.width));
  out.Put(static_cast<int32_t>(camera.height));
}

uint8_t LensFlagOf(const PinholeCamera& camera) {
  const bool is_known =
      camera.lens == LensModel::kBrown || camera.lens == LensModel::kKannalaBrandt;
  return !is_known ? kNamedLens
         : camera.IsFisheye() || camera.k4 != 0.0 || camera.k5 != 0.0 || camera.k6 != 0.0
             ? kMoreOfLens
             : 0;
}

void WriteNamedLens(const PinholeCamera& camera, ByteWriter& out) {
  const WideModel& model = *FindWideModel(camera.lens);
  out.PutText(std::string(model.type));
  for (const LensCoefficient& one : model.coefficients) {
    out.Put(camera.*one.field);
  }
}

void ReadNamedLens(ByteReader& in, PinholeCamera& camera) {
  const WideModel* const model = FindWideModel(in.GetText());
  in.Require(model != nullptr, "has a lens that this version does not know");
  camera.lens = model->lens;
  for (const LensCoefficient& one : model->coefficients) {
    camera.*one.field = in.GetFinite(kMostMapNumber);
  }
}

void WriteMoreOfLens(const PinholeCamera& camera, ByteWriter& out) {
  out.PutFlag(camera.IsFisheye());
  for (const double number : {camera.k4, camera.k5, camera.k6}) {
    out.Put(number);
  }
}

PinholeCamera ReadCamera(uint8_t lens_flag, ByteReader& in) {
  PinholeCamera camera;
  for (double* number : {&camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.k1, &camera.k2,
                         &camera.p1, &camera.p2, &camera.k3, &camera.bf}) {
    *number = in.GetFinite(kMostMapNumber);
  }
  constexpr int kMostSide = 65'536;  // px; the options of the camera have a smaller bound
  camera.width = in.Get<int32_t>();
  camera.height = in.Get<int32_t>();
  if (lens_flag == kNamedLens) {
    ReadNamedLens(in, camera);
  } else if (lens_flag == kMoreOfLens) {
    camera.lens = in.GetFlag() ? LensModel::kKannalaBrandt : LensModel::kBrown;
    for (double* number : {&camera.k4, &camera.k5, &camera.k6}) {
      *number = in.GetFinite(kMostMapNumber);
    }
  }
  in.Require(camera.width > 0 && camera.width <= kMostSide && camera.height > 0 &&
                 camera.height <= kMostSide && camera.FindFault().empty(),
             "has a camera that cannot be");
  return camera;
}

}  // namespace

void WriteHeader(const MapHeader& header, ByteWriter& out) {
  const PinholeCamera& camera = header.settings.camera;
  const uint8_t lens_flag = LensFlagOf(camera);
  out.Put(static_cast<uint8_t>(NumberOf(header.settings.sensor) + lens_flag));
  WriteCamera(camera, out);
  if (lens_flag == kNamedLens) {
    WriteNamedLens(camera, out);
  } else if (lens_flag == kMoreOfLens) {
    WriteMoreOfLens(camera, out);
  }
  out.Put(static_cast<int32_t>(header.settings.level_count));
  out.Put(header.settings.scale_factor);
  out.Put(header.settings.vocabulary);
  out.PutCount(header.sessions.size());
  for (const Session& session : header.sessions) {
    out.PutText(session.name);
    out.Put(session.first_frame.value);
  }
  for (const uint32_t number :
       {header.correction_count, header.keyframes, header.culled, header.landmarks,
        header.landmark_slots, header.objects, header.next_object}) {
    out.Put(number);
  }
}

MapHeader ReadHeader(ByteReader& in) {
  MapHeader header;
  const auto number = in.Get<uint8_t>();
  const uint8_t lens_flag = number > kNamedLens    ? kNamedLens
                            : number > kMoreOfLens ? kMoreOfLens
                                                   : 0;
  const auto sensor = static_cast<uint8_t>(number - lens_flag);
  in.Require(sensor >= kRgbd && sensor <= kStereo,
             "is of a sensor that this version does not know");
  header.settings.sensor = sensor == kRgbd        ? SensorKind::kRgbd
                           : sensor == kMonocular ? SensorKind::kMonocular
                                                  : SensorKind::kStereo;
  header.settings.camera = ReadCamera(lens_flag, in);
  header.settings.level_count = in.Get<int32_t>();
  header.settings.scale_factor = in.GetFinite(kMostScaleFactor);
  in.Require(header.settings.level_count > 0 && header.settings.level_count <= kMostLevels &&
                 header.settings.scale_factor > 1.0,
             "has an image pyramid that cannot be");
  header.settings.vocabulary = in.Get<uint64_t>();
  const size_t sessions = in.GetCount(2 * sizeof(uint32_t));
  for (size_t i = 0; i < sessions; ++i) {
    Session session{.name = in.GetText(), .first_frame = FrameId(in.Get<uint32_t>())};
    header.sessions.push_back(std::move(session));
  }
  for (uint32_t* number :
       {&header.correction_count, &header.keyframes, &header.culled, &header.landmarks,
        &header.landmark_slots, &header.objects, &header.next_object}) {
    *number = in.Get<uint32_t>();
  }
  constexpr uint32_t kMostObjects =
      uint32_t{1}
      << 24;  // limits the memory, because a table has memory for all ids up to the largest
  in.Require(header.keyframes > 0, "has no keyframes");
  // A run that goes on with the map needs as many slots again.
  in.Require(header.landmark_slots <= LandmarkId::kMaxSlot / 2, "has too many landmarks to go on");
  in.Require(header.landmarks <= header.landmark_slots && header.objects <= header.next_object &&
                 header.next_object <= kMostObjects,
             "has numbers of entities that cannot be");
  return header;
}

}  // namespace hullslam
