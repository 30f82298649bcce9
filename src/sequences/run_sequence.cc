// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/run_sequence.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "files/text_rows.h"
#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/sequences/stereo_sequence.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "sequences/resized_images.h"
#include "settings/stereo_settings.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The arguments with which a sequence of any kind is opened.
struct Reopening {
  const SequenceOfRun& run;
  const fs::path& path;
  const PinholeCamera& camera;
  bool use_depth;

  // A choice of the run; empty if it made none.
  std::string Choice(const char* name) const {
    const auto found = run.choices.find(name);
    return found != run.choices.end() ? found->second : std::string();
  }

  // The number that the run chose, or the other one if it chose none.
  double Number(const char* name, double otherwise) const {
    const std::string text = Choice(name);
    double value = otherwise;
    if (!text.empty() && !ParseFinite(text, value)) {
      throw InputError(
          fmt::format("{} in summary.json is '{}', expected a number", name, ShowText(text)));
    }
    return value;
  }
};

ImageSequence OpenTum(const Reopening& opening) {
  return OpenTumSequence(opening.path, {.use_depth = opening.use_depth});
}

ImageSequence OpenIcl(const Reopening& opening) {
  return OpenIclSequence(opening.path, opening.camera, {}, {.use_depth = opening.use_depth}).images;
}

ImageSequence OpenEuroc(const Reopening& opening) { return OpenEurocSequence(opening.path).images; }

// Null without a file.
std::shared_ptr<const StereoRectifier> RectifierOf(const std::string& calibration) {
  return calibration.empty() ? nullptr
                             : MakeRectifier(calibration, ReadSettings(calibration).camera);
}

// The settings of a run take the place of the calibration of the data set.
std::shared_ptr<const StereoRectifier> PairRectifierOf(const std::string& calibration) {
  return calibration.empty() ? nullptr
                             : MakePairRectifier(calibration, ReadSettings(calibration).camera);
}

ImageSequence OpenEurocStereo(const Reopening& opening) {
  return OpenEurocPairs(opening.path, {}, PairRectifierOf(opening.Choice("calibration"))).images;
}

ImageSequence OpenKitti(const Reopening& opening) {
  return OpenKittiPairs(opening.path, {}, PairRectifierOf(opening.Choice("calibration"))).images;
}

ImageSequence OpenKittiLeft(const Reopening& opening) {
  return OpenKittiImages(opening.path).images;
}

ImageSequence OpenPairs(const Reopening& opening) {
  const std::string calibration = opening.Choice("calibration");
  StereoFolderOptions options;
  options.frames_per_second = opening.Number("frames_per_second", options.frames_per_second);
  options.rectifier = RectifierOf(calibration);
  return OpenStereoFolder(opening.path, options);
}

ImageSequence OpenBag(const Reopening& opening) {
  return OpenBagSequence(opening.path,
                         {.image_topic = opening.Choice("image_topic"),
                          .depth_topic = opening.Choice("depth_topic"),
                          .use_depth = opening.use_depth,
                          .need_camera = false,
                          .use_recording_times = opening.Choice("times") == "recording",
                          .float_units = opening.Number("float_units", 1.0)})
      .images;
}

ImageSequence OpenBagStereo(const Reopening& opening) {
  const std::string calibration = opening.Choice("calibration");
  const BagSequenceOptions options = {
      .image_topic = opening.Choice("image_topic"),
      .info_topic = opening.Choice("info_topic"),
      .right_topic = opening.Choice("right_topic"),
      .right_info_topic = opening.Choice("right_info_topic"),
      .need_camera = !opening.Choice("info_topic").empty(),
      .use_recording_times = opening.Choice("times") == "recording"};
  return OpenBagPairs(opening.path, options, RectifierOf(calibration)).images;
}

ImageSequence OpenVideo(const Reopening& opening) { return OpenImageStream(opening.path).images; }

struct NamedDataset {
  const char* name;  // ImageSequence::dataset
  ImageSequence (*open)(const Reopening& opening);
};

constexpr std::array<NamedDataset, 10> kDatasets = {{{"tum", OpenTum},
                                                     {"icl", OpenIcl},
                                                     {"euroc", OpenEuroc},
                                                     {"euroc_stereo", OpenEurocStereo},
                                                     {"kitti", OpenKitti},
                                                     {"kitti_left", OpenKittiLeft},
                                                     {"stereo_folder", OpenPairs},
                                                     {"bag", OpenBag},
                                                     {"bag_stereo", OpenBagStereo},
                                                     {"video", OpenVideo}}};

}  // namespace

ImageSequence OpenRunSequence(const SequenceOfRun& run, const fs::path& path,
                              const PinholeCamera& camera, bool use_depth) {
  std::string known;
  for (const NamedDataset& dataset : kDatasets) {
    if (run.dataset == dataset.name) {
      const Reopening opening{run, path, camera, use_depth};
      ImageSequence sequence = dataset.open(opening);
      ResizeImages(opening.Choice("resized_from"), camera, sequence);
      return sequence;
    }
    known += (known.empty() ? "" : ", ") + std::string(dataset.name);
  }
  throw InputError(
      run.dataset.empty()
          ? fmt::format(
                "{}: cannot be opened, because the run does not say of which data set it is "
                "(provenance.dataset in summary.json); repeat the run with this version",
                path.string())
          : fmt::format("{}: cannot be opened, because provenance.dataset in summary.json is '{}', "
                        "expected one of: {}",
                        path.string(), ShowText(run.dataset), known));
}

}  // namespace hullslam
