// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bags/bag.h"
#include "bags/image_messages.h"
#include "sequences/bag_image.h"

namespace hullslam {

// Where an image of a recording is.
struct BagImage {
  BagTime stamp;       // in the message
  int64_t logged = 0;  // the time at which it was recorded, ns
  size_t bag = 0;      // index of the file
  MessagePosition place;
};

// A topic of a recording, over all its files.
struct IndexedTopic {
  std::string name;
  std::string type;      // "sensor_msgs/Image"
  std::string encoding;  // of the first image, or its format if it is compressed
  size_t messages = 0;
  BagImageKind kind = BagImageKind::kUnknown;              // of the images
  std::vector<BagImage> images = {};                       // if the topic has images
  std::optional<CameraInfoMessage> camera = std::nullopt;  // the first CameraInfo of the topic
  bool is_compressed = false;                              // the images
  uint16_t brightest =
      0;  // the largest value of all images, if they are kEither or Bayer of 16 bits
  MessageCoding coding = MessageCoding::kCdr;
};

// The topics of a recording, sorted by name.
struct BagIndex {
  std::filesystem::path path;
  std::vector<IndexedTopic> topics = {};
  std::vector<std::string> warnings = {};
};

// Scans all files. Throws InputError for broken files and messages.
BagIndex IndexBags(const std::filesystem::path& path,
                   const std::vector<std::unique_ptr<Bag>>& bags);

// The topic of colour or depth images. A topic of kEither counts only if no other is of this kind.
// If `name` is given, it is this one. Otherwise it is the only one; or, of several, the only one
// that is left without the compressed forms of raw topics; or the only one whose name says that it
// is in colour ("rgb", "color") or that depth is registered
// ("registered", "aligned"). Throws InputError with all topics and with `option`, by which the user
// can choose.
const IndexedTopic& ChooseImageTopic(const BagIndex& index, BagImageKind kind,
                                     const std::string& name, const char* option);

// Whether the images of a topic are rectified already, by the names of ROS's image_proc: the last
// part of the name has the word "rect" or "rectified", as in /camera/rgb/image_rect_color. The
// CameraInfo beside such a topic has K and the distortion of the raw images.
bool IsRectifiedTopic(const IndexedTopic& topic);

// The topics of the left and the right images of a pair, which may be named. Otherwise their names
// differ only by left and right, infra1 and infra2, cam0 and cam1 or the like. If several pairs
// do, it is the only one that IsRectifiedTopic(). Throws InputError like ChooseImageTopic().
std::array<const IndexedTopic*, 2> ChoosePairTopics(const BagIndex& index, const std::string& left,
                                                    const std::string& right,
                                                    const char* left_option,
                                                    const char* right_option);

// The topic with the CameraInfo of an image topic: `name` if it is given, else camera_info beside
// it, else the only one. Throws InputError like ChooseImageTopic().
const IndexedTopic& ChooseInfoTopic(const BagIndex& index, const IndexedTopic& images,
                                    const std::string& name, const char* option);

}  // namespace hullslam
