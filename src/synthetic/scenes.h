// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

#include "synthetic/scene.h"

namespace hullslam::synthetic {

enum class SceneKind { kDesk, kRoom, kLowTexture, kDynamic };

// "desk", "room", "lowtexture", "dynamic"; another name throws InputError.
SceneKind ParseSceneKind(std::string_view name);
std::string_view SceneName(SceneKind kind);

// Frames of the sequence that the scene is made for, at 30 frames a second.
int DefaultFrames(SceneKind kind);

// The whole scene with the path of its camera. Layout and path are the same for every seed up to
// small changes; textures differ. `frames` sets how fast `room` closes its loop.
Scene BuildScene(SceneKind kind, int frames, uint64_t seed);

}  // namespace hullslam::synthetic
