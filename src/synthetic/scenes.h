// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

#include "synthetic/scene.h"

namespace hullslam::synthetic {

enum class SceneKind { kDesk, kRoom, kLowTexture, kDynamic };

// The kind with the name "desk", "room", "lowtexture" or "dynamic"; another name throws InputError.
SceneKind ParseSceneKind(std::string_view name);
std::string_view SceneName(SceneKind kind);

// The number of frames of the sequence that the scene was designed for, at 30 frames per second.
int DefaultFrames(SceneKind kind);

// The whole scene with the path of its camera. Layout and path are the same for every seed except
// for small changes; the textures differ. `frames` determines how fast `room` closes its loop.
Scene BuildScene(SceneKind kind, int frames, uint64_t seed);

}  // namespace hullslam::synthetic
