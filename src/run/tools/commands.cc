// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/tools/commands.h"

#include <array>

namespace hullslam {
namespace {

constexpr const char* kRun = "Run SLAM";
constexpr const char* kPrepare = "Prepare a sequence or a vocabulary";
constexpr const char* kMap = "Map objects where the camera's poses are known";
constexpr const char* kShow = "Look at a finished run or a saved map";
constexpr const char* kMeasure = "Measure how good the results are";
constexpr const char* kConvert = "Use the results in other programs";

constexpr std::array kCommands = {
    Command{kRun, "run", "runs SLAM on a sequence of any kind", RunRun},
    Command{kPrepare, "calibrate", "calibrates a camera from recordings of anything", RunCalibrate},
    Command{kPrepare, "check-masks", "checks the masks of a sequence, and can draw them",
            RunCheckMasks},
    Command{kPrepare, "segment", "makes masks of images with a network", RunSegment},
    Command{kPrepare, "make-synthetic", "renders a sequence whose poses and objects are known",
            nullptr},
    Command{kPrepare, "train-vocabulary", "trains a vocabulary of visual words on images",
            RunTrainVocabulary},
    Command{kPrepare, "convert-vocabulary",
            "converts a vocabulary between text, as ORB-SLAM2 has it, and the binary form",
            RunConvertVocabulary},
    Command{kMap, "map-objects", "maps objects from masks and poses; needs no images",
            RunMapObjects},
    Command{kShow, "view", "shows it in a browser, or writes its report", RunView},
    Command{kShow, "query", "answers questions about its objects", RunQueryObjects},
    Command{kMeasure, "evaluate", "the errors of a trajectory, or of mapped objects", RunEvaluate},
    Command{kMeasure, "relocalise", "how often single frames are found in a map", RunRelocalise},
    Command{kConvert, "export", "writes them for COLMAP, nerfstudio, Blender, g2o and others",
            RunExport},
};

}  // namespace

std::span<const Command> Commands() { return kCommands; }

}  // namespace hullslam
