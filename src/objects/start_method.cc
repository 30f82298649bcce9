// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/start_method.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "objects/initialisation.h"

namespace hullslam {
namespace {

struct StartKind {
  std::string_view name;
  StartMethod* method;
};

// In the order of the enumerators.
constexpr std::array kStarts = {
    StartKind{"fitted", &StartFitted}, StartKind{"oriented_box", &StartByOrientedBox},
    StartKind{"box_planes", &StartByBoxPlanes}, StartKind{"ray_sphere", &StartByRays},
    StartKind{"single_view", &StartBySingleView}};

}  // namespace

StartMethod& MethodOf(ObjectStart start) { return *kStarts.at(static_cast<size_t>(start)).method; }

std::vector<std::string> ObjectStartNames() {
  std::vector<std::string> names;
  for (const StartKind& kind : kStarts) {
    names.emplace_back(kind.name);
  }
  return names;
}

std::vector<Ellipsoid> StartFitted(const StartInput& input) {
  if (input.has_depth) {
    return StartsFromPoints(
        CollectPoints(input.observations, static_cast<size_t>(input.options.max_points)),
        MeanDistance(input.observations, input.center), input.options);
  }
  std::vector<Ellipsoid> starts;
  for (const std::optional<Ellipsoid>& sphere :
       {StartFromLandmarks(input.camera, input.observations, input.options),
        StartFromRays(input.camera, input.observations, input.options)}) {
    if (sphere) {
      starts.push_back(*sphere);
    }
  }
  return starts;
}

std::vector<Ellipsoid> StartByRays(const StartInput& input) {
  const std::optional<Ellipsoid> sphere =
      StartFromRays(input.camera, input.observations, input.options);
  return sphere ? std::vector<Ellipsoid>{*sphere} : std::vector<Ellipsoid>();
}

}  // namespace hullslam
