// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibration_text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "calibration/made_recording.h"

namespace hullslam {
namespace {

// A camera whose readout time is wrong, but whose focal length its motion does not determine.
RecordedCalibration Calibrated() {
  const MadeRecordingOptions options = ShortRecording(kShiftAndRoll, true, 1);
  CameraModel given = options.truth;
  given.readout_time = 0.04;
  const CalibrationProblem problem = MadeRecording(options).problem();
  return {.result = CalibrateCamera(problem, given, {}), .problem = problem, .passes = 2};
}

TEST(CalibrationText, SaysWhatIsCalibratedAndWhatIsKept) {
  const RecordedCalibration calibration = Calibrated();
  const std::string text = CalibrationText(calibration, {}, 1);
  const auto line_of = [&](const std::string& name) {
    const size_t begin = text.find("\n" + name + " ");
    return begin == std::string::npos
               ? ""
               : text.substr(begin + 1, text.find('\n', begin + 1) - begin - 1);
  };
  EXPECT_TRUE(text.starts_with("40 images of 1 recording, ")) << text;
  EXPECT_NE(line_of("fx").find("not determined, so it is kept"), std::string::npos) << text;
  EXPECT_NE(line_of("readout_time").find("40.00 ms"), std::string::npos) << text;
  EXPECT_NE(text.find("to know more: turn the camera"), std::string::npos) << text;
  EXPECT_EQ(text.find("nothing was changed"), std::string::npos) << text;
}

TEST(OriginOf, NamesTheRecordingsAndTheSigmas) {
  const std::vector<std::string> recordings = {"walk"};
  const auto lines = OriginOf(Calibrated(), {}, recordings);
  ASSERT_GT(lines.size(), 5U);
  EXPECT_EQ(lines[1], "  walk");
  EXPECT_EQ(lines[2], "fx: as it was given");
  bool has_readout = false;
  for (const std::string& line : lines) {
    has_readout |= line.starts_with("readout_time: sigma 0.") && line.ends_with(" ms");
  }
  EXPECT_TRUE(has_readout);
}

// Of two rectified cameras, the right one is turned.
TEST(CalibrationText, HasTheRightCameraOfAPair) {
  RecordedCalibration calibration = Calibrated();
  calibration.result.is_changed = false;
  PairCalibration pair;
  pair.given = calibration.result.given.camera;
  EXPECT_NE(CalibrationText(calibration, {}, 2).find("agrees with the recordings"),
            std::string::npos);
  const std::string text = CalibrationText(calibration, pair, 2);
  for (const char* const name : {"\npitch ", "\nroll ", "\nyaw ", "\nbaseline "}) {
    EXPECT_NE(text.find(name), std::string::npos) << name << text;
  }
}

}  // namespace
}  // namespace hullslam
