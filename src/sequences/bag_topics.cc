// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/bag_topics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <tuple>

#include "hullslam/util/error.h"
#include "sequences/image_list.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

using Candidates = std::vector<const IndexedTopic*>;

IndexedTopic& FindOrAdd(const BagTopic& topic, std::vector<IndexedTopic>& topics) {
  const auto found = std::find_if(topics.begin(), topics.end(), [&](const IndexedTopic& indexed) {
    return indexed.name == topic.name && indexed.type == topic.type;
  });
  return found != topics.end() ? *found
                               : topics.emplace_back(IndexedTopic{topic.name, topic.type, {}});
}

void AddImage(const BagMessage& message, BagTime stamp, size_t bag, IndexedTopic& topic) {
  if (topic.images.size() == kMostImages) {
    throw InputError(fmt::format("{}: more than {} images", ShowText(topic.name), kMostImages));
  }
  topic.images.push_back({stamp, message.logged, bag, message.place});
}

void IndexMessage(MessageCoding coding, const BagMessage& message, size_t bag,
                  const std::string& place, IndexedTopic& topic) {
  if (topic.type == "sensor_msgs/Image") {
    const RawImageMessage image = ReadRawImage(coding, message.bytes, place);
    if (topic.images.empty()) {
      topic.encoding = image.encoding;
      topic.kind = KindOfEncoding(image.encoding);
    }
    AddImage(message, image.stamp, bag, topic);
  } else if (topic.type == "sensor_msgs/CompressedImage") {
    const CompressedImageMessage image = ReadCompressedImage(coding, message.bytes, place);
    if (topic.images.empty()) {
      topic.encoding = image.format;
      topic.kind = KindOfFormat(image.format);
    }
    AddImage(message, image.stamp, bag, topic);
  } else if (topic.type == "sensor_msgs/CameraInfo" && !topic.camera) {
    topic.camera = ReadCameraInfo(coding, message.bytes, place);
  }
}

std::string Describe(const IndexedTopic& topic) {
  return fmt::format("{} ({}{}{}, {} message{})", ShowText(topic.name, 60),
                     ShowText(topic.type, 40), topic.encoding.empty() ? "" : " ",
                     ShowText(topic.encoding, 30), topic.messages, topic.messages == 1 ? "" : "s");
}

std::string ListTopics(const BagIndex& index) {
  constexpr size_t kMostShown = 10;
  std::vector<std::string> shown;
  // Images and their cameras come first, because one of them is what the user is looking for.
  for (const bool is_of_camera : {true, false}) {
    for (const IndexedTopic& topic : index.topics) {
      if ((!topic.images.empty() || topic.camera) == is_of_camera && shown.size() < kMostShown) {
        shown.push_back(Describe(topic));
      }
    }
  }
  if (shown.empty()) {
    return "it has no topics";
  }
  const size_t others = index.topics.size() - shown.size();
  return fmt::format("its topics: {}{}", fmt::join(shown, ", "),
                     others > 0 ? fmt::format(" and {} more", others) : "");
}

[[noreturn]] void FailTopics(const BagIndex& index, const std::string& what) {
  throw InputError(fmt::format("{}: {}; {}", index.path.string(), what, ListTopics(index)));
}

bool HasAny(std::string_view name, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return name.find(word) != std::string_view::npos;
  });
}

// The name without that of a compressed form: /camera/image of /camera/image/compressed.
std::string BaseName(const IndexedTopic& topic) {
  for (const std::string_view ending : {"/compressedDepth", "/compressed"}) {
    if (topic.IsCompressed() && topic.name.ends_with(ending)) {
      return topic.name.substr(0, topic.name.size() - ending.size());
    }
  }
  return topic.name;
}

Candidates WithoutCompressedForms(const Candidates& all) {
  Candidates kept;
  std::copy_if(all.begin(), all.end(), std::back_inserter(kept), [&](const IndexedTopic* topic) {
    const std::string base = BaseName(*topic);
    return base == topic->name || std::none_of(all.begin(), all.end(), [&](const auto* other) {
             return other->name == base;
           });
  });
  return kept;
}

Candidates PreferredByName(const Candidates& all, BagImageKind kind) {
  Candidates kept;
  std::copy_if(all.begin(), all.end(), std::back_inserter(kept), [&](const IndexedTopic* topic) {
    return kind == BagImageKind::kColour ? HasAny(topic->name, {"rgb", "color", "colour"})
                                         : HasAny(topic->name, {"registered", "aligned"});
  });
  return kept;
}

const IndexedTopic& GivenTopic(const BagIndex& index, const std::string& name, const char* option) {
  const auto found = std::find_if(index.topics.begin(), index.topics.end(),
                                  [&](const IndexedTopic& topic) { return topic.name == name; });
  if (found == index.topics.end()) {
    FailTopics(index, fmt::format("{} is '{}', which it does not have", option, ShowText(name)));
  }
  return *found;
}

}  // namespace

BagIndex IndexBags(const std::filesystem::path& path,
                   const std::vector<std::unique_ptr<Bag>>& bags) {
  BagIndex index{.path = path};
  for (size_t i = 0; i < bags.size(); ++i) {
    Bag& bag = *bags[i];
    bag.Scan([&](const BagMessage& message) {
      const BagTopic& topic = bag.topics()[message.topic];
      if (topic.type.starts_with("sensor_msgs/")) {
        const std::string place = fmt::format("{}: message {} of {}", path.string(), topic.messages,
                                              ShowText(topic.name));
        IndexMessage(bag.coding(), message, i, place, FindOrAdd(topic, index.topics));
      }
    });
    for (const BagTopic& topic : bag.topics()) {
      FindOrAdd(topic, index.topics).messages += topic.messages;
    }
    index.warnings.insert(index.warnings.end(), bag.warnings().begin(), bag.warnings().end());
  }
  std::sort(index.topics.begin(), index.topics.end(),
            [](const IndexedTopic& a, const IndexedTopic& b) {
              return std::tie(a.name, a.type) < std::tie(b.name, b.type);
            });
  return index;
}

const IndexedTopic& ChooseImageTopic(const BagIndex& index, BagImageKind kind,
                                     const std::string& name, const char* option) {
  const char* const what = kind == BagImageKind::kColour ? "colour" : "depth";
  if (!name.empty()) {
    const IndexedTopic& given = GivenTopic(index, name, option);
    if (given.kind != kind) {
      FailTopics(index, fmt::format("{} is '{}', which has no {} images that can be read", option,
                                    ShowText(name), what));
    }
    return given;
  }
  Candidates candidates;
  for (const IndexedTopic& topic : index.topics) {
    if (topic.kind == kind) {
      candidates.push_back(&topic);
    }
  }
  if (candidates.empty()) {
    FailTopics(index, fmt::format("has no topic with {} images that can be read", what));
  }
  if (candidates.size() > 1) {
    candidates = WithoutCompressedForms(candidates);
  }
  if (const Candidates preferred = PreferredByName(candidates, kind);
      candidates.size() > 1 && preferred.size() == 1) {
    candidates = preferred;
  }
  if (candidates.size() > 1) {
    FailTopics(index, fmt::format("has {} topics with {} images, expected {} TOPIC to choose one",
                                  candidates.size(), what, option));
  }
  return *candidates.front();
}

const IndexedTopic& ChooseInfoTopic(const BagIndex& index, const IndexedTopic& images,
                                    const std::string& name, const char* option) {
  if (!name.empty()) {
    const IndexedTopic& given = GivenTopic(index, name, option);
    if (!given.camera) {
      FailTopics(index, fmt::format("{} is '{}', which has no sensor_msgs/CameraInfo", option,
                                    ShowText(name)));
    }
    return given;
  }
  const std::string base = BaseName(images);
  const std::string beside = base.substr(0, base.rfind('/') + 1) + "camera_info";
  Candidates candidates;
  for (const IndexedTopic& topic : index.topics) {
    if (topic.camera && topic.name == beside) {
      return topic;
    }
    if (topic.camera) {
      candidates.push_back(&topic);
    }
  }
  if (candidates.size() != 1) {
    FailTopics(index,
               fmt::format("has {} topics with sensor_msgs/CameraInfo but no {}, expected {} TOPIC "
                           "or --settings FILE",
                           candidates.size(), ShowText(beside), option));
  }
  return *candidates.front();
}

}  // namespace hullslam
