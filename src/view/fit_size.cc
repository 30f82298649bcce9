// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/fit_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
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
