// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>

#include "util/statistics.h"

namespace hullslam {
namespace {

// Of two heights, in sums of two sizes.
constexpr double kTolerance = 0.15;
// The farthest neighbour on the same surface, in sums of two widths. Two tables of one height are
// two surfaces.
constexpr double kReach = 1.5;

// Joins indices that belong together (union-find).
class Groups {
 public:
  explicit Groups(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
  }
  size_t Find(size_t index) {
    while (parent_[index] != index) {
      parent_[index] = parent_[parent_[index]];
      index = parent_[index];
    }
    return index;
  }
  void Join(size_t a, size_t b) {
    parent_[std::max(Find(a), Find(b))] = std::min(Find(a), Find(b));
  }

 private:
  std::vector<size_t> parent_;
};

Surface MakeSurface(const std::vector<const ObjectBody*>& bodies) {
  Surface surface;
  std::vector<double> heights;
  for (const ObjectBody* body : bodies) {
    heights.push_back(body->bottom);
    surface.objects.push_back(body->id);
  }
  surface.height = Median(std::move(heights));
  std::sort(surface.objects.begin(), surface.objects.end());
  return surface;
}

// A surface for each group of two objects or more that were seen together at one height.
std::vector<Surface> GroupByHeight(const std::vector<const ObjectBody*>& bodies,
                                   const ObservationStatistics& observations) {
  Groups groups(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const ObjectBody& a = *bodies[i];
      const ObjectBody& b = *bodies[k];
      if (std::abs(a.bottom - b.bottom) <= HeightTolerance(a, b) &&
          FootprintGap(a, b) <= kReach * (a.width + b.width) &&
          observations.Joint(a.id, b.id).observations > 0) {
        groups.Join(i, k);
      }
    }
  }
  std::map<size_t, std::vector<const ObjectBody*>> members;
  for (size_t i = 0; i < bodies.size(); ++i) {
    members[groups.Find(i)].push_back(bodies[i]);
  }
  std::vector<Surface> surfaces;
  for (const auto& [first, list] : members) {
    if (list.size() > 1) {
      surfaces.push_back(MakeSurface(list));
    }
  }
  return surfaces;
}

// The tolerance for this object and one of the usual size.
double FloorTolerance(const ObjectBody& body, double usual_size) {
  return kTolerance * (body.size + usual_size);
}

double UsualSize(std::span<const ObjectBody* const> bodies) {
  std::vector<double> sizes;
  for (const ObjectBody* body : bodies) {
    sizes.push_back(body->size);
  }
  return sizes.empty() ? 0.0 : Median(std::move(sizes));
}

}  // namespace

double HeightTolerance(const ObjectBody& a, const ObjectBody& b) {
  return std::max(kTolerance * (a.size + b.size), 2.0 * std::hypot(a.height_sigma, b.height_sigma));
}

double FloorHeight(std::span<const ObjectBody> bodies) {
  std::vector<const ObjectBody*> evidence;
  std::vector<const ObjectBody*> all;
  for (const ObjectBody& body : bodies) {
    all.push_back(&body);
    if (body.is_bottom_seen) {
      evidence.push_back(&body);
    }
  }
  if (evidence.empty()) {
    evidence = std::move(all);
  }
  if (evidence.empty()) {
    return 0.0;
  }
  constexpr int kMostSteps = 10;
  const double usual_size = UsualSize(evidence);
  double floor =
      (*std::min_element(evidence.begin(), evidence.end(), [](const auto* a, const auto* b) {
        return a->bottom < b->bottom;
      }))->bottom;
  for (int step = 0; step < kMostSteps; ++step) {
    std::vector<double> low;
    for (const ObjectBody* body : evidence) {
      if (body->bottom <= floor + FloorTolerance(*body, usual_size)) {
        low.push_back(body->bottom);
      }
    }
    const double next = Median(std::move(low));
    if (next == floor) {
      break;
    }
    floor = next;
  }
  return floor;
}

std::vector<ObjectBody> ExtendToFloor(std::span<const ObjectBody> bodies) {
  const double floor = FloorHeight(bodies);
  std::vector<ObjectBody> extended(bodies.begin(), bodies.end());
  for (ObjectBody& body : extended) {
    if (!body.is_bottom_seen) {
      body.bottom = std::min(body.bottom, floor);
    }
  }
  return extended;
}

std::vector<Surface> FindSurfaces(std::span<const ObjectBody* const> standing, double floor,
                                  const ObservationStatistics& observations) {
  const double usual_size = UsualSize(standing);
  std::vector<const ObjectBody*> low;
  std::vector<const ObjectBody*> raised;
  for (const ObjectBody* body : standing) {
    const bool is_low = body->bottom <= floor + FloorTolerance(*body, usual_size);
    (is_low ? low : raised).push_back(body);
  }
  std::vector<Surface> surfaces = GroupByHeight(raised, observations);
  if (!low.empty()) {
    surfaces.push_back(MakeSurface(low));
    surfaces.back().is_lowest = true;
  }
  std::stable_sort(surfaces.begin(), surfaces.end(),
                   [](const Surface& a, const Surface& b) { return a.height < b.height; });
  return surfaces;
}

}  // namespace hullslam
