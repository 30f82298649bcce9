// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/segmentation/segmenter.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "files/content_hash.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "masks/mask_classes.h"
#include "segmentation/candidate.h"
#include "segmentation/class_names.h"
#include "segmentation/instance_outline.h"
#include "segmentation/letterbox.h"
#include "segmentation/network_layout.h"
#include "segmentation/onnx_file.h"
#include "segmentation/open_network.h"
#include "util/components.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kDefaultSize = 640;  // px, of the images that networks of YOLO are trained with
constexpr int kMostSize = 4096;
constexpr size_t kCocoClassCount = 80;

// The size of the input in the file; absent if it is open.
std::optional<cv::Size> DeclaredSize(const fs::path& path, const OnnxFile& file) {
  const OnnxValue& input = file.inputs.front();
  if (file.inputs.size() != 1 || input.shape.size() != 4 ||
      (input.shape[1] != 3 && input.shape[1] != -1)) {
    throw InputError(fmt::format(
        "{}: has {} inputs, the first one is '{}' of {}, expected one of "
        "1x3xHxW, an image",
        path.string(), file.inputs.size(), Printable(input.name), DescribeShape(input.shape)));
  }
  const int64_t height = input.shape[2];
  const int64_t width = input.shape[3];
  if (std::max(height, width) > kMostSize) {
    throw InputError(fmt::format("{}: the input is {}, expected at most {} px", path.string(),
                                 DescribeShape(input.shape), kMostSize));
  }
  return height < 0 || width < 0
             ? std::nullopt
             : std::optional(cv::Size(static_cast<int>(width), static_cast<int>(height)));
}

// Names from the user or the file; absent if neither gives them.
std::optional<std::vector<std::string>> FindNames(const fs::path& path, const OnnxFile& file,
                                                  const SegmenterOptions& options) {
  if (!options.names.empty()) {
    return ReadClassNames(options.names);
  }
  const auto found = file.metadata.find("names");
  if (found == file.metadata.end()) {
    return std::nullopt;
  }
  const std::string source = path.string() + ": the metadata 'names' (--names FILE gives others)";
  std::optional<std::vector<std::string>> names = ParseClassNames(found->second);
  if (!names) {
    throw InputError(source + ": has no list of names, expected one as Ultralytics writes it");
  }
  CheckClassNames(source, *names);
  return names;
}

std::vector<std::string> ChooseNames(const fs::path& path, size_t class_count,
                                     std::optional<std::vector<std::string>> names) {
  if (names) {
    return *std::move(names);
  }
  if (class_count == kCocoClassCount) {
    return CocoClasses();
  }
  throw InputError(
      fmt::format("{}: has {} classes without names, expected --names FILE with one name per line",
                  path.string(), class_count));
}

// Which classes are asked for, by number.
std::vector<bool> ChooseClasses(const std::vector<std::string>& names,
                                const std::vector<std::string>& wanted) {
  std::vector<bool> chosen(names.size(), wanted.empty());
  for (const std::string& name : wanted) {
    if (std::ranges::find(names, name) == names.end()) {
      const auto meant = std::ranges::find_if(
          names, [&](const std::string& known) { return IsMisspelt(name, known); });
      throw InputError(fmt::format(
          "--classes has '{}', expected names of the network's classes{}", name,
          meant == names.end() ? std::string() : fmt::format("; did you mean '{}'?", *meant)));
    }
    for (size_t i = 0; i < names.size(); ++i) {
      chosen[i] = chosen[i] || names[i] == name;
    }
  }
  return chosen;
}

// Reports that OpenCV cannot do something with the network.
[[noreturn]] void Fail(const fs::path& path, const char* what, const NetworkError& error) {
  throw InputError(fmt::format(
      "{}: OpenCV {} cannot {} this network ({}), expected one that scripts/prepare_network.py has "
      "prepared (docs/segmentation.md)",
      path.string(), CV_VERSION, what, Printable(error.what())));
}

}  // namespace

class Segmenter::Implementation {
 public:
  Implementation(const fs::path& path, const SegmenterOptions& options)
      : path_(path), options_(options) {
    RequireComponent("SEGMENTATION", path.string() + ": is a network for masks");
    CheckOptions();
    OnnxFile file = ReadOnnx(path);
    hash_ = ContentHash(file.bytes.data(), file.bytes.size());
    declared_ = DeclaredSize(path, file);
    const std::optional<std::vector<std::string>> names = FindNames(path, file, options);
    known_classes_ = names ? std::optional(names->size()) : std::nullopt;
    try {
      network_ = OpenNetwork(std::move(file.bytes),
                             options_.threads > 0 ? options_.threads : cv::getNumThreads());
    } catch (const NetworkError& error) {
      Fail(path_, "read", error);
    }
    layout_ = TryOut();
    if (!layout_.prototypes && !options_.use_boxes) {
      throw InputError(fmt::format(
          "{}: finds boxes, no masks ({}); expected a network for segmentation, or --boxes to use "
          "the boxes",
          path_.string(), layout_.name));
    }
    names_ = ChooseNames(path_, static_cast<size_t>(layout_.class_count), names);
    filter_ = {.min_score = options_.min_score, .classes = ChooseClasses(names_, options_.classes)};
  }

  std::vector<InstanceMask> Segment(const cv::Mat& image) {
    Check(image.depth() == CV_8U && image.channels() != 2 && image.channels() <= 4,
          "the image is neither CV_8UC3 nor CV_8UC4 nor CV_8UC1");
    const Result result = Run(image);
    CheckFinite(result);
    std::vector<Candidate> candidates =
        SuppressOverlaps(result.layout.decode(result.layout, result.outputs, filter_));
    std::vector<InstanceMask> instances;
    for (const Candidate& candidate : candidates) {
      InstanceMask instance = MakeInstance(candidate, result);
      if (!instance.outlines.empty()) {
        instances.push_back(std::move(instance));
      }
    }
    return instances;
  }

  const std::vector<std::string>& names() const { return names_; }
  const std::string& hash() const { return hash_; }
  bool gives_boxes() const { return options_.use_boxes || !layout_.prototypes; }

  std::string Describe() const {
    return fmt::format("{}: {}, {} classes, an input of {}", path_.string(), layout_.name,
                       names_.size(),
                       declared_ ? fmt::format("{}x{} px", declared_->width, declared_->height)
                                 : std::string("any size"));
  }

 private:
  struct Result {
    std::vector<NetworkOutput> outputs;
    NetworkLayout layout;
    Letterbox letterbox;
  };

  void CheckOptions() const {
    if (!(options_.min_score >= 0.0 && options_.min_score <= 1.0)) {
      throw InputError(
          fmt::format("--min-score is {}, expected a number from 0 to 1", options_.min_score));
    }
    if (options_.size < 0 || options_.size > kMostSize) {
      throw InputError(fmt::format("--size is {}, expected 32 to {} px", options_.size, kMostSize));
    }
  }

  // Runs the network once. Some networks divide by the brightness of the image, so a grey image is
  // the second try.
  NetworkLayout TryOut() {
    constexpr double kGrey = 114.0;  // as the borders of a letterbox
    const cv::Size size = declared_.value_or(InputSize({4, 3}, kDefaultSize));
    Result result = RunAt(cv::Mat(size, CV_8UC3, cv::Scalar::all(0.0)), size);
    if (!FindNotFinite(result).empty()) {
      result = RunAt(cv::Mat(size, CV_8UC3, cv::Scalar::all(kGrey)), size);
      CheckFinite(result);
    }
    return result.layout;
  }

  // Runs the network on an image. It is asked for an input with the proportions of the image first,
  // which has no grey borders to compute. A network with layers for one size refuses others.
  Result Run(const cv::Mat& image) {
    const int declared = declared_ ? std::max(declared_->width, declared_->height) : kDefaultSize;
    const cv::Size fitting = InputSize(image.size(), options_.size > 0 ? options_.size : declared);
    if (options_.size > 0 || !declared_ || fitting == *declared_) {
      return RunAt(image, fitting);
    }
    if (!has_one_size_) {
      try {
        return RunAt(image, fitting);
      } catch (const InputError&) {
        // A network that fails with the other size, too, fails because of this image.
        Result result = RunAt(image, *declared_);
        has_one_size_ = true;
        return result;
      }
    }
    return RunAt(image, *declared_);
  }

  Result RunAt(const cv::Mat& image, const cv::Size& size) {
    Result result{.outputs = {}, .layout = {}, .letterbox = FitLetterbox(image.size(), size)};
    try {
      result.outputs = network_->Run(MakeInput(image, result.letterbox));
    } catch (const NetworkError& error) {
      Fail(path_, "run", error);
    }
    try {
      result.layout = RecogniseLayout(result.outputs, size, known_classes_);
    } catch (const InputError& error) {
      throw InputError(path_.string() + ": " + error.what());
    }
    return result;
  }

  // The name of an output with values that are not finite; empty if there is none.
  static std::string FindNotFinite(const Result& result) {
    const auto found = std::ranges::find_if(
        result.outputs, [](const NetworkOutput& output) { return !cv::checkRange(output.values); });
    return found != result.outputs.end() ? found->name : std::string();
  }

  void CheckFinite(const Result& result) const {
    if (const std::string output = FindNotFinite(result); !output.empty()) {
      throw InputError(fmt::format(
          "{}: the output '{}' has values that are not finite, expected numbers; a network with "
          "half precision gives them, so export it with half=False",
          path_.string(), Printable(output)));
    }
  }

  InstanceMask MakeInstance(const Candidate& candidate, const Result& result) const {
    InstanceMask instance{.label = names_[static_cast<size_t>(candidate.class_number)],
                          .score = candidate.score,
                          .shape = gives_boxes() ? MaskShape::kBox : MaskShape::kContour,
                          .outlines = {}};
    std::vector<Eigen::Vector2d> outline =
        gives_boxes()
            ? BoxOutline(candidate, result.letterbox)
            : FindInstanceOutline(candidate, result.outputs[*result.layout.prototypes].values,
                                  result.letterbox);
    if (!outline.empty()) {
      instance.outlines.push_back(std::move(outline));
    }
    return instance;
  }

  const fs::path path_;
  const SegmenterOptions options_;
  std::string hash_;
  std::unique_ptr<Network> network_;
  std::optional<cv::Size> declared_;  // the size of the input in the file
  std::optional<size_t> known_classes_;
  NetworkLayout layout_;
  std::vector<std::string> names_;
  CandidateFilter filter_;
  bool has_one_size_ = false;  // the network has refused another size than `declared_`
};

Segmenter::Segmenter(const fs::path& network, const SegmenterOptions& options)
    : implementation_(std::make_unique<Implementation>(network, options)) {}

Segmenter::~Segmenter() = default;

std::vector<InstanceMask> Segmenter::Segment(const cv::Mat& image) {
  return implementation_->Segment(image);
}

const std::vector<std::string>& Segmenter::class_names() const { return implementation_->names(); }

const std::string& Segmenter::network_hash() const { return implementation_->hash(); }

bool Segmenter::gives_boxes() const { return implementation_->gives_boxes(); }

std::string Segmenter::Describe() const { return implementation_->Describe(); }

}  // namespace hullslam
