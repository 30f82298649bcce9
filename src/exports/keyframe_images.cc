// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/keyframe_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "sequences/image_list.h"

namespace hullslam {
namespace {

// COLMAP's text files separate their columns by blanks.
std::string NameOf(const FramePaths& frame) {
  std::string name = frame.image.stem().string();
  std::replace_if(
      name.begin(), name.end(),
      [](char letter) { return letter <= ' ' || letter == '"' || letter == '\\' || letter > '~'; },
      '_');
  return name;
}

bool IsOfSession(const Map& map, FrameId frame, const std::string& session) {
  const size_t number = SessionNumber(map.sessions(), frame);
  return map.sessions().size() < 2 || (number > 0 && map.sessions()[number - 1].name == session);
}

}  // namespace

std::vector<KeyframeImage> FindKeyframeImages(const Map& map, const ImageSequence& sequence,
                                              const std::string& session) {
  std::vector<KeyframeImage> images;
  std::set<std::string> names;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    const Frame& frame = *keyframe.frame;
    const FramePaths* const found = FindFrameAt(sequence, frame.timestamp);
    if (found == nullptr || !IsOfSession(map, frame.id, session)) {
      return;
    }
    std::string name = NameOf(*found);
    if (!names.insert(name).second) {
      // Two sessions may have used the same image.
      name += fmt::format("_{}", id.value);
      names.insert(name);
    }
    images.push_back({id, *found, name});
  });
  return images;
}

}  // namespace hullslam
