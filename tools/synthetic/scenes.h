// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hullslam/camera/pinhole.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

enum class SceneKind {
  kDesk,
  kRoom,
  kLowTexture,
  kDynamic,
  kHouse,
  kTwins,
  kRotation,
  kWall,
  kTurns,
  kPushed,
  kRoad
};

// The kind with a name such as "desk" or "lowtexture". Throws InputError for an unknown name.
SceneKind ParseSceneKind(std::string_view name);
std::string_view SceneName(SceneKind kind);

inline constexpr double kFramesPerSecond = 30.0;

// The number of frames of the sequence that the scene was designed for.
int DefaultFrames(SceneKind kind);

// The camera with which the scene is rendered, without distortion.
PinholeCamera CameraOf(SceneKind kind);

// The seed of everything that differs between two visits of the same scene: the motion of the hand
// and the noise of the sensor. For the visit before any rearrangement it is `seed` itself.
uint64_t VisitSeed(uint64_t seed, const std::optional<uint64_t>& rearranged);

// The whole scene with the path of its camera. Layout and path are the same for every seed except
// for small changes; the textures differ. In `room`, `house` and `twins` the number `frames`
// determines the speed of the camera. With a seed in `rearranged`, some of the objects were moved,
// taken away or added since the first visit, see Rearrange; throws InputError unless the scene is
// desk, room or house.
Scene BuildScene(SceneKind kind, int frames, uint64_t seed,
                 const std::optional<uint64_t>& rearranged = std::nullopt);

}  // namespace hullslam::synthetic
