// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/bag_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <opencv2/core.hpp>
#include <utility>

#include "bags/bag.h"
#include "camera/fit_depth.h"
#include "hullslam/util/error.h"
#include "hullslam/util/stamp_pairing.h"
#include "images/image_file.h"
#include "sequences/bag_camera.h"
#include "sequences/bag_image.h"
#include "sequences/bag_topics.h"
#include "sequences/image_list.h"
#include "sequences/stereo_pairing.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr double kMostApart = 0.02;  // s, as in TUM's associate.py
constexpr const char* kImageOption = "--image-topic";
constexpr const char* kDepthOption = "--depth-topic";
constexpr const char* kInfoOption = "--info-topic";
constexpr const char* kRightOption = "--right-topic";
constexpr const char* kRightInfoOption = "--right-info-topic";

struct StampedImage {
  double timestamp = 0.0;  // s
  BagImage image;
};

// The images of a topic in order of time.
struct TopicImages {
  std::string topic;
  std::string encoding;
  bool is_compressed = false;
  uint16_t brightest = 0;
  MessageCoding coding = MessageCoding::kCdr;
  std::vector<StampedImage> images;
};

double SecondsOf(const BagImage& image, bool use_recording_times) {
  return use_recording_times ? BagTime{image.logged / 1'000'000'000,
                                       static_cast<uint32_t>(image.logged % 1'000'000'000)}
                                   .Seconds()
                             : image.stamp.Seconds();
}

// Without its stamps, a topic has the times at which its messages were recorded.
bool NeedsRecordingTimes(const IndexedTopic& topic, bool asked, std::vector<std::string>& notes) {
  const bool has_none = std::all_of(topic.images.begin(), topic.images.end(),
                                    [](const BagImage& image) { return image.stamp.IsZero(); });
  if (!asked && has_none) {
    notes.push_back(fmt::format(
        "{}: its images have no time stamps; the times at which they were recorded are used",
        ShowText(topic.name)));
  }
  return asked || has_none;
}

[[noreturn]] void FailOrder(const fs::path& path, const IndexedTopic& topic, double stamp,
                            double former) {
  throw InputError(fmt::format(
      "{}: {}: the time stamp {:.6f} s comes {:.6f} s before that of the previous image, expected "
      "stamps at most 1 s out of order; --recording-times uses the times at which the images were "
      "recorded",
      path.string(), ShowText(topic.name), stamp, former - stamp));
}

// Sorts images by their stamps. Drivers with several threads publish images a little out of order.
// Stamps that go back by more than a second are refused: then a clock was set.
std::vector<StampedImage> SortByStamps(const fs::path& path, const IndexedTopic& topic,
                                       bool by_recording, BagSequence& sequence) {
  constexpr double kMostDisorder = 1.0;  // s; no queue of a driver is longer
  std::vector<StampedImage> sorted;
  for (const BagImage& image : topic.images) {
    sorted.push_back({SecondsOf(image, by_recording), image});
  }
  // Recorders with several threads may write messages a little out of order, too.
  std::stable_sort(sorted.begin(), sorted.end(), [](const StampedImage& a, const StampedImage& b) {
    return a.image.logged < b.image.logged;
  });
  double latest = 0.0;
  size_t late = 0;
  for (const StampedImage& image : sorted) {
    if (image.timestamp < latest - kMostDisorder || image.timestamp < 0.0) {
      FailOrder(path, topic, image.timestamp, latest);
    }
    late += image.timestamp < latest ? 1 : 0;
    latest = std::max(latest, image.timestamp);
  }
  if (late > 0) {
    sequence.warnings.push_back(
        fmt::format("{}: {}: {} images come after images with later time stamps, and are sorted "
                    "by their stamps",
                    path.string(), ShowText(topic.name), late));
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const StampedImage& a, const StampedImage& b) {
    return a.timestamp < b.timestamp;
  });
  return sorted;
}

TopicImages OrderImages(const fs::path& path, const IndexedTopic& topic, bool use_recording_times,
                        BagSequence& sequence) {
  constexpr double kLongGap = 3600.0;  // s
  const bool by_recording = NeedsRecordingTimes(topic, use_recording_times, sequence.notes);
  TopicImages ordered{topic.name,      topic.encoding, topic.is_compressed,
                      topic.brightest, topic.coding,   {}};
  size_t repeated = 0;
  for (const StampedImage& image : SortByStamps(path, topic, by_recording, sequence)) {
    const double stamp = image.timestamp;
    const double former = ordered.images.empty() ? stamp - 1.0 : ordered.images.back().timestamp;
    if (stamp - former > kLongGap) {
      sequence.warnings.push_back(
          fmt::format("{}: {}: the time stamps jump by {:.1f} hours at {:.6f} s", path.string(),
                      ShowText(topic.name), (stamp - former) / kLongGap, stamp));
    }
    if (stamp == former) {
      ++repeated;
    } else {
      ordered.images.push_back(image);
    }
  }
  if (repeated > 0) {
    sequence.warnings.push_back(
        fmt::format("{}: {}: {} images have the time stamp of the previous one and are not used",
                    path.string(), ShowText(topic.name), repeated));
  }
  return ordered;
}

std::vector<double> StampsOfTopic(const TopicImages& topic) {
  std::vector<double> stamps;
  for (const StampedImage& image : topic.images) {
    stamps.push_back(image.timestamp);
  }
  return stamps;
}

enum class Decoding { kGrey, kColour, kDepth };

// `brightest` is empty for compressed images.
template <typename Message, typename... Brightest>
cv::Mat DecodeMessage(const Message& message, Decoding decoding, const std::string& name,
                      Brightest... brightest) {
  switch (decoding) {
    case Decoding::kGrey:
      return GreyOf(message, name, brightest...);
    case Decoding::kColour:
      return ColourOf(message, name, brightest...);
    default:
      return DepthOf(message, name);
  }
}

// The images of a recording by the numbers of its frames.
class BagLoader {
 public:
  BagLoader(std::vector<std::unique_ptr<Bag>> bags, TopicImages colour, TopicImages depth,
            double float_units)
      : bags_(std::move(bags)),
        colour_(std::move(colour)),
        depth_(std::move(depth)),
        float_units_(float_units) {}

  // Adds a frame of a stereo camera: the second topic has its right images.
  void AddPair(const fs::path& source, size_t left, size_t right, ImageSequence& sequence) {
    AddFrame(source, left, std::nullopt, sequence);
    sequence.frames.back().right = NameOf(source, depth_, right);
    frames_.back().second = right;
  }

  // Adds a frame of the images with these indices. `source` is the path of the recording.
  void AddFrame(const fs::path& source, size_t colour, std::optional<size_t> depth,
                ImageSequence& sequence) {
    sequence.frames.push_back({colour_.images[colour].timestamp, NameOf(source, colour_, colour),
                               depth ? NameOf(source, depth_, *depth) : fs::path(),
                               frames_.size()});
    if (depth) {
      sequence.frames.back().depth_delay =
          depth_.images[*depth].timestamp - colour_.images[colour].timestamp;
    }
    frames_.push_back({colour, depth.value_or(0)});
  }

  const TopicImages& colour() const { return colour_; }
  const TopicImages& depth() const { return depth_; }

  ImageInput Load(const FramePaths& frame, const PinholeCamera& camera) {
    const auto& [colour, depth] = frames_.at(frame.number);
    const std::string name = frame.image.string();
    ImageInput image{frame.timestamp, Read(colour_, colour, Decoding::kGrey, name), cv::Mat()};
    image.depth_delay = frame.depth_delay;
    if (!frame.depth.empty()) {
      image.depth = Read(depth_, depth, Decoding::kDepth, frame.depth.string());
      if (!HaveSameShape(image.depth.size(), {camera.width, camera.height})) {
        CheckImageSize(frame.depth.string(), image.depth, camera);
      }
      if (image.depth.depth() == CV_32F && float_units_ != 1.0) {
        image.depth /= float_units_;
      }
    }
    if (!frame.right.empty()) {
      image.right = Read(depth_, depth, Decoding::kGrey, frame.right.string());
      CheckImageSize(frame.right.string(), image.right, camera);
    }
    CheckImageSize(name, image.grey, camera);
    return image;
  }

  cv::Mat LoadColour(const FramePaths& frame) {
    return Read(colour_, frames_.at(frame.number).first, Decoding::kColour, frame.image.string());
  }

 private:
  // FILE/TOPIC/STAMP, by which masks are found and which messages show.
  static fs::path NameOf(const fs::path& source, const TopicImages& topic, size_t i) {
    return fmt::format("{}/{}/{:.6f}", source.string(),
                       ShowText(std::string_view(topic.topic).substr(topic.topic[0] == '/')),
                       topic.images[i].timestamp);
  }

  cv::Mat Read(const TopicImages& topic, size_t i, Decoding decoding, const std::string& name) {
    const BagImage& image = topic.images[i].image;
    Bag& bag = *bags_[image.bag];
    const std::string bytes = bag.Read(image.place);
    return topic.is_compressed
               ? DecodeMessage(ReadCompressedImage(topic.coding, bytes, name), decoding, name)
               : DecodeMessage(ReadRawImage(topic.coding, bytes, name), decoding, name,
                               topic.brightest);
  }

  std::vector<std::unique_ptr<Bag>> bags_;
  TopicImages colour_;
  TopicImages depth_;         // or the right images; without images if there is neither
  double float_units_ = 1.0;  // of 32FC1, per metre
  std::vector<std::pair<size_t, size_t>> frames_;
};

void PairTopics(const fs::path& path, BagLoader& loader, ImageSequence& sequence) {
  const std::vector<double> of_colour = StampsOfTopic(loader.colour());
  const std::vector<double> of_depth = StampsOfTopic(loader.depth());
  const auto pairs = PairStampsGreedily(of_colour, of_depth, kMostApart);
  if (pairs.empty()) {
    throw InputError(fmt::format(
        "{}: no image of {} has one of {} within {} s, the smallest gap is {:.6f} s; "
        "--recording-times pairs them by the times at which they were recorded; without depth: "
        "mono_bag",
        path.string(), ShowText(loader.colour().topic), ShowText(loader.depth().topic), kMostApart,
        SmallestGap(of_colour, of_depth)));
  }
  sequence.unpaired = of_colour.size() - pairs.size();
  for (const auto& [i, j] : pairs) {
    loader.AddFrame(path, i, j, sequence);
  }
}

std::string DescribeTopic(const char* what, const TopicImages& topic) {
  return fmt::format("{}: {}, {} messages", what, ShowText(topic.topic), topic.images.size());
}

std::string DescribeDepth(const TopicImages& topic, double float_units) {
  const bool is_float = topic.encoding.starts_with("32FC1");
  return DescribeTopic("depth", topic) +
         (is_float
              ? fmt::format(", 32FC1 with {:g} units per metre (--float-units); DepthMapFactor "
                            "has no effect on it",
                            float_units)
              : std::string());
}

// The mean over all images.
double RateOf(const TopicImages& topic) {
  constexpr double kUsual = 30.0;
  const double seconds = topic.images.back().timestamp - topic.images.front().timestamp;
  return topic.images.size() < 2 ? kUsual : static_cast<double>(topic.images.size() - 1) / seconds;
}

void SetLoaders(const std::shared_ptr<BagLoader>& loader, ImageSequence& sequence) {
  sequence.load = [loader](const FramePaths& frame, const PinholeCamera& camera) {
    return loader->Load(frame, camera);
  };
  sequence.load_colour = [loader](const FramePaths& frame) { return loader->LoadColour(frame); };
}

}  // namespace

BagSequence OpenBagSequence(const fs::path& path, const BagSequenceOptions& options) {
  constexpr double kMostFloatUnits = 1e6;  // micrometres
  if (!(options.float_units > 0.0 && options.float_units <= kMostFloatUnits)) {
    throw InputError(fmt::format("--float-units is '{:g}', expected a number above 0, up to {:g}",
                                 options.float_units, kMostFloatUnits));
  }
  std::vector<std::unique_ptr<Bag>> bags = OpenBags(path);
  BagIndex index = IndexBags(path, bags);
  BagSequence sequence;
  sequence.warnings = std::move(index.warnings);
  const IndexedTopic& images =
      ChooseImageTopic(index, BagImageKind::kColour, options.image_topic, kImageOption);
  TopicImages colour = OrderImages(path, images, options.use_recording_times, sequence);
  sequence.notes.push_back(DescribeTopic("images", colour));
  sequence.images.dataset = "bag";
  sequence.images.choices["image_topic"] = images.name;
  if (options.use_recording_times) {
    sequence.images.choices["times"] = "recording";
  }
  TopicImages depth;
  if (options.use_depth) {
    const IndexedTopic& topic =
        ChooseImageTopic(index, BagImageKind::kDepth, options.depth_topic, kDepthOption);
    depth = OrderImages(path, topic, options.use_recording_times, sequence);
    sequence.notes.push_back(DescribeDepth(depth, options.float_units));
    if (topic.name == images.name) {
      throw InputError(
          fmt::format("{}: {} is taken for the images and for the depth, expected {} "
                      "or {} TOPIC",
                      path.string(), ShowText(topic.name), kImageOption, kDepthOption));
    }
    sequence.images.choices["depth_topic"] = topic.name;
    if (options.float_units != 1.0) {
      sequence.images.choices["float_units"] = fmt::format("{}", options.float_units);
    }
  }
  if (options.need_camera) {
    const IndexedTopic& info = ChooseInfoTopic(index, images, options.info_topic, kInfoOption);
    InfoCamera read = CameraOfInfo(path, info, images);
    sequence.camera = {.camera = read.camera, .frames_per_second = RateOf(colour)};
    sequence.notes.push_back(fmt::format("camera: {}, {}", ShowText(info.name), read.note));
  }
  const auto loader = std::make_shared<BagLoader>(std::move(bags), std::move(colour),
                                                  std::move(depth), options.float_units);
  if (options.use_depth) {
    PairTopics(path, *loader, sequence.images);
  } else {
    for (size_t i = 0; i < loader->colour().images.size(); ++i) {
      loader->AddFrame(path, i, std::nullopt, sequence.images);
    }
  }
  SetLoaders(loader, sequence.images);
  SelectFrames(path, options.selection, sequence.images);
  return sequence;
}

std::vector<SensorKind> FindBagSensors(const fs::path& path) {
  const BagIndex index = IndexBags(path, OpenBags(path));
  const auto is_found = [](const auto& choose) {
    try {
      choose();
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  std::vector<SensorKind> sensors;
  if (is_found([&] { ChooseImageTopic(index, BagImageKind::kColour, {}, kImageOption); })) {
    sensors.push_back(SensorKind::kMonocular);
    if (is_found([&] { ChooseImageTopic(index, BagImageKind::kDepth, {}, kDepthOption); })) {
      sensors.push_back(SensorKind::kRgbd);
    }
  }
  if (is_found([&] { ChoosePairTopics(index, {}, {}, kImageOption, kRightOption); })) {
    sensors.push_back(SensorKind::kStereo);
  }
  return sensors;
}

BagPairs OpenBagPairs(const fs::path& path, const BagSequenceOptions& options,
                      std::shared_ptr<const StereoRectifier> rectifier) {
  std::vector<std::unique_ptr<Bag>> bags = OpenBags(path);
  BagIndex index = IndexBags(path, bags);
  BagSequence opened;
  opened.warnings = std::move(index.warnings);
  const auto topics =
      ChoosePairTopics(index, options.image_topic, options.right_topic, kImageOption, kRightOption);
  std::array<TopicImages, 2> both;
  for (size_t i = 0; i < both.size(); ++i) {
    both[i] = OrderImages(path, *topics[i], options.use_recording_times, opened);
    opened.notes.push_back(DescribeTopic(i == 0 ? "left images" : "right images", both[i]));
  }
  BagPairs pairs;
  pairs.images.dataset = "bag_stereo";
  pairs.images.choices = {{"image_topic", topics[0]->name}, {"right_topic", topics[1]->name}};
  if (options.use_recording_times) {
    pairs.images.choices["times"] = "recording";
  }
  const double rate = RateOf(both[0]);
  if (options.need_camera) {
    const IndexedTopic& left = ChooseInfoTopic(index, *topics[0], options.info_topic, kInfoOption);
    const IndexedTopic& right =
        ChooseInfoTopic(index, *topics[1], options.right_info_topic, kRightInfoOption);
    pairs.images.choices["info_topic"] = left.name;
    pairs.images.choices["right_info_topic"] = right.name;
    rectifier = std::make_shared<const StereoRectifier>(
        PairOfInfos(path, {&left, &right}, topics, opened.notes), path.string());
    pairs.calibration = CameraCalibration{rectifier->camera(), rate};
  }
  const std::vector<double> of_left = StampsOfTopic(both[0]);
  const std::vector<double> of_right = StampsOfTopic(both[1]);
  const std::vector<IndexPair> paired =
      PairStereoStamps(path.string(), {ShowText(topics[0]->name), of_left},
                       {ShowText(topics[1]->name), of_right}, rate, opened.warnings);
  const auto loader =
      std::make_shared<BagLoader>(std::move(bags), std::move(both[0]), std::move(both[1]), 1.0);
  pairs.images.unpaired = of_left.size() - paired.size();
  for (const IndexPair& pair : paired) {
    loader->AddPair(path, pair.first, pair.second, pairs.images);
  }
  SetLoaders(loader, pairs.images);
  RectifyPairs(rectifier, pairs.images);
  SelectFrames(path, options.selection, pairs.images);
  pairs.notes = std::move(opened.notes);
  pairs.warnings = std::move(opened.warnings);
  return pairs;
}

}  // namespace hullslam
