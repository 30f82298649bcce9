// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/bag_topics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <map>
#include <string_view>
#include <tuple>

#include "hullslam/util/error.h"
#include "sequences/image_list.h"
#include "util/text.h"

namespace hullslam {
namespace {

using Candidates = std::vector<const IndexedTopic*>;

// Finds the topics of all files. A file numbers its own topics.
class TopicTable {
 public:
  explicit TopicTable(std::vector<IndexedTopic>& topics) : topics_(topics) {}

  void BeginFile() { numbers_.clear(); }

  // The topic with this number in the current file.
  IndexedTopic& At(const Bag& bag, size_t number) {
    while (numbers_.size() <= number) {
      const BagTopic& topic = bag.topics()[numbers_.size()];
      const auto [entry, is_new] =
          found_.try_emplace({topic.name, topic.type, topic.coding}, topics_.size());
      if (is_new) {
        topics_.push_back(
            {.name = topic.name, .type = topic.type, .encoding = {}, .coding = topic.coding});
      }
      numbers_.push_back(entry->second);
    }
    return topics_[numbers_[number]];
  }

 private:
  std::vector<IndexedTopic>& topics_;
  std::map<std::tuple<std::string, std::string, MessageCoding>, size_t> found_;
  std::vector<size_t> numbers_;  // indices into topics_, by the numbers in the current file
};

void IndexMessage(const BagMessage& message, BagContent content, size_t bag,
                  const std::string& place, IndexedTopic& topic) {
  if (content == BagContent::kImage) {
    const RawImageMessage image = ReadRawImage(topic.coding, message.bytes, place);
    if (topic.images.empty()) {
      topic.encoding = image.encoding;
      topic.kind = KindOfEncoding(image.encoding);
    }
    topic.brightest = std::max(topic.brightest, BrightestOf(image));
    topic.images.push_back({image.stamp, message.logged, bag, message.place});
  } else if (content == BagContent::kCompressedImage) {
    const CompressedImageMessage image = ReadCompressedImage(topic.coding, message.bytes, place);
    if (topic.images.empty()) {
      topic.is_compressed = true;
      topic.encoding = image.format;
      topic.kind = KindOfFormat(image.format);
    }
    topic.images.push_back({image.stamp, message.logged, bag, message.place});
  } else if (!topic.camera) {
    topic.camera = ReadCameraInfo(topic.coding, message.bytes, place);
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

// Whether a name has one of these words, in upper or lower case.
bool HasAny(std::string name, std::initializer_list<std::string_view> words) {
  name = LowerCase(name);
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

// The name without the part of a compressed form: /camera/image of /camera/image/compressed.
std::string BaseName(const IndexedTopic& topic) {
  for (const std::string_view ending : {"/compressedDepth", "/compressed"}) {
    if (topic.is_compressed && topic.name.ends_with(ending)) {
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

// The topics of a kind. If there are none, topics of grey images with 16 bits: for depth if their
// names have "depth", or else all; for colour if their names do not have it.
Candidates CandidatesOf(const BagIndex& index, BagImageKind kind) {
  Candidates sure;
  Candidates named_depth;
  Candidates others;
  for (const IndexedTopic& topic : index.topics) {
    if (topic.kind == kind) {
      sure.push_back(&topic);
    } else if (topic.kind == BagImageKind::kEither) {
      (HasAny(topic.name, {"depth"}) ? named_depth : others).push_back(&topic);
    }
  }
  if (!sure.empty()) {
    return sure;
  }
  return kind == BagImageKind::kDepth && !named_depth.empty() ? named_depth : others;
}

std::string Readable(BagImageKind kind) {
  return ReadEncodings(kind) + (kind == BagImageKind::kColour
                                    ? "; JPEG, PNG"
                                    : "; PNG of 16 bits, compressedDepth with PNG or RVL");
}

const IndexedTopic& GivenTopic(const BagIndex& index, const std::string& name, const char* option) {
  const auto found = std::find_if(index.topics.begin(), index.topics.end(),
                                  [&](const IndexedTopic& topic) { return topic.name == name; });
  if (found == index.topics.end()) {
    FailTopics(index, fmt::format("{} is '{}', which it does not have", option, ShowText(name)));
  }
  return *found;
}

// The words in which the names of the topics of a pair differ.
constexpr std::array<std::array<std::string_view, 2>, 7> kSides = {{{"left", "right"},
                                                                    {"infra1", "infra2"},
                                                                    {"fisheye1", "fisheye2"},
                                                                    {"cam0", "cam1"},
                                                                    {"cam_0", "cam_1"},
                                                                    {"camera0", "camera1"},
                                                                    {"image_0", "image_1"}}};

std::string ReplaceAll(std::string text, std::string_view from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// The topic of the other camera; null if there is none. `side` is the side of the given one.
const IndexedTopic* PartnerOf(const IndexedTopic& topic, size_t side, const Candidates& all) {
  for (const auto& words : kSides) {
    const std::string other = ReplaceAll(topic.name, words[side], words[1 - side]);
    const auto found = std::find_if(all.begin(), all.end(), [&](const IndexedTopic* candidate) {
      return candidate->name == other;
    });
    if (other != topic.name && found != all.end()) {
      return *found;
    }
  }
  return nullptr;
}

}  // namespace

BagIndex IndexBags(const std::filesystem::path& path,
                   const std::vector<std::unique_ptr<Bag>>& bags) {
  BagIndex index{.path = path};
  TopicTable table(index.topics);
  size_t images = 0;
  for (size_t i = 0; i < bags.size(); ++i) {
    Bag& bag = *bags[i];
    table.BeginFile();
    bag.Scan([&](const BagMessage& message) {
      const BagTopic& topic = bag.topics()[message.topic];
      const BagContent content = ContentOf(topic);
      if (content == BagContent::kOther) {
        return;
      }
      if (content != BagContent::kCamera && ++images > kMostImages) {
        throw InputError(fmt::format("{}: more than {} images", path.string(), kMostImages));
      }
      const std::string place =
          fmt::format("{}: message {} of {}", path.string(), topic.messages, ShowText(topic.name));
      IndexMessage(message, content, i, place, table.At(bag, message.topic));
    });
    for (size_t number = 0; number < bag.topics().size(); ++number) {
      table.At(bag, number).messages += bag.topics()[number].messages;
    }
    index.warnings.insert(index.warnings.end(), bag.warnings().begin(), bag.warnings().end());
  }
  std::sort(index.topics.begin(), index.topics.end(),
            [](const IndexedTopic& a, const IndexedTopic& b) {
              return std::tie(a.name, a.type) < std::tie(b.name, b.type);
            });
  return index;
}

bool IsRectifiedTopic(const IndexedTopic& topic) {
  const std::string base = LowerCase(BaseName(topic));
  std::string word;
  bool is_rectified = false;
  for (const char c : base.substr(base.rfind('/') + 1) + '_') {
    if (IsLetter(c)) {
      word += c;
    } else {  // a digit ends a word too: image_rect0
      is_rectified = is_rectified || word == "rect" || word == "rectified";
      word.clear();
    }
  }
  return is_rectified;
}

const IndexedTopic& ChooseImageTopic(const BagIndex& index, BagImageKind kind,
                                     const std::string& name, const char* option) {
  const char* const what = kind == BagImageKind::kColour ? "colour" : "depth";
  if (!name.empty()) {
    const IndexedTopic& given = GivenTopic(index, name, option);
    if (given.kind != kind && given.kind != BagImageKind::kEither) {
      FailTopics(index, fmt::format("{} is '{}', which has no {} images that can be read ({})",
                                    option, ShowText(name), what, Readable(kind)));
    }
    return given;
  }
  Candidates candidates = CandidatesOf(index, kind);
  if (candidates.empty()) {
    FailTopics(index, fmt::format("has no topic with {} images that can be read ({})", what,
                                  Readable(kind)));
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

std::array<const IndexedTopic*, 2> ChoosePairTopics(const BagIndex& index, const std::string& left,
                                                    const std::string& right,
                                                    const char* left_option,
                                                    const char* right_option) {
  constexpr BagImageKind kColour = BagImageKind::kColour;
  const Candidates all = CandidatesOf(index, kColour);
  std::vector<std::array<const IndexedTopic*, 2>> pairs;
  if (!left.empty() && !right.empty()) {
    pairs.push_back({&ChooseImageTopic(index, kColour, left, left_option),
                     &ChooseImageTopic(index, kColour, right, right_option)});
  } else if (!left.empty()) {
    const IndexedTopic& given = ChooseImageTopic(index, kColour, left, left_option);
    pairs.push_back({&given, PartnerOf(given, 0, all)});
  } else if (!right.empty()) {
    const IndexedTopic& given = ChooseImageTopic(index, kColour, right, right_option);
    pairs.push_back({PartnerOf(given, 1, all), &given});
  } else {
    for (const IndexedTopic* topic : WithoutCompressedForms(all)) {
      pairs.push_back({topic, PartnerOf(*topic, 0, all)});
    }
  }
  std::erase_if(pairs, [](const auto& pair) {
    return pair[0] == nullptr || pair[1] == nullptr || pair[0] == pair[1];
  });
  const auto is_raw = [](const auto& pair) { return !IsRectifiedTopic(*pair[0]); };
  if (pairs.size() > 1 && std::count_if(pairs.begin(), pairs.end(), is_raw) + 1 ==
                              static_cast<std::ptrdiff_t>(pairs.size())) {
    std::erase_if(pairs, is_raw);
  }
  if (pairs.size() != 1) {
    FailTopics(index, fmt::format("has {} pairs of topics with left and right images, expected {} "
                                  "TOPIC and {} TOPIC",
                                  pairs.size(), left_option, right_option));
  }
  return pairs.front();
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
  constexpr std::string_view kViewer = "/image/data";  // Intel's realsense-viewer
  const std::string of_viewer =
      base.ends_with(kViewer) ? base.substr(0, base.size() - kViewer.size()) + "/info/camera_info"
                              : beside;
  Candidates candidates;
  for (const IndexedTopic& topic : index.topics) {
    if (topic.camera && (topic.name == beside || topic.name == of_viewer)) {
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
