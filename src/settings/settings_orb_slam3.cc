// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/settings_orb_slam3.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "camera/wide_lens.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// How a setting of ORB-SLAM3 is translated.
enum class Kind {
  kRenamed,   // becomes our setting `key`
  kIgnored,   // has no meaning here (viewer, IMU)
  kBaseline,  // Stereo.b, the baseline in m; Camera.bf is this times Camera.fx
  kVersion,   // File.version
  kModel,     // Camera.type
  kRefused,   // cannot be translated; `why` is the reason
};

struct Entry {
  std::string_view name;
  Kind kind = Kind::kIgnored;
  std::string_view key = {};
  std::string_view why = {};
};

constexpr std::array<Entry, 31> kEntries = {{
    {"File.version", Kind::kVersion},
    {"Camera.type", Kind::kModel},
    {"Camera1.fx", Kind::kRenamed, "Camera.fx"},
    {"Camera1.fy", Kind::kRenamed, "Camera.fy"},
    {"Camera1.cx", Kind::kRenamed, "Camera.cx"},
    {"Camera1.cy", Kind::kRenamed, "Camera.cy"},
    {"Camera1.k1", Kind::kRenamed, "Camera.k1"},
    {"Camera1.k2", Kind::kRenamed, "Camera.k2"},
    {"Camera1.k3", Kind::kRenamed, "Camera.k3"},
    {"Camera1.k4", Kind::kRenamed, "Camera.k4"},
    {"Camera1.k5", Kind::kRenamed, "Camera.k5"},
    {"Camera1.k6", Kind::kRenamed, "Camera.k6"},
    {"Camera1.p1", Kind::kRenamed, "Camera.p1"},
    {"Camera1.p2", Kind::kRenamed, "Camera.p2"},
    {"RGBD.DepthMapFactor", Kind::kRenamed, "DepthMapFactor"},
    {"Stereo.ThDepth", Kind::kRenamed, "ThDepth"},
    {"Stereo.b", Kind::kBaseline},
    {"System.thFarPoints", Kind::kRefused, {}, "HullSLAM has no limit for far points"},
    {"System.LoadAtlasFromFile", Kind::kRefused, {}, "HullSLAM cannot load maps of ORB-SLAM3"},
    {"System.SaveAtlasToFile", Kind::kRefused, {}, "HullSLAM cannot save maps of ORB-SLAM3"},
    {"Viewer.imageViewScale", Kind::kIgnored},
    // Where the images of a fisheye pair overlap. They are rectified here.
    {"Camera1.overlappingBegin", Kind::kIgnored},
    {"Camera1.overlappingEnd", Kind::kIgnored},
    {"Camera2.overlappingBegin", Kind::kIgnored},
    {"Camera2.overlappingEnd", Kind::kIgnored},
    // Keys of its files before format 1.0. Camera.type tells the lens.
    {"Camera.bFishEye", Kind::kIgnored},
    {"Camera.lappingBegin", Kind::kIgnored},
    {"Camera.lappingEnd", Kind::kIgnored},
    {"Camera2.lappingBegin", Kind::kIgnored},
    {"Camera2.lappingEnd", Kind::kIgnored},
    {"loopClosing", Kind::kRenamed, "loop.closing"},
}};

constexpr Entry kImu = {"IMU", Kind::kIgnored};

// Null for a key that needs no translation: ORB-SLAM3 does not have it, or it means the same here.
const Entry* FindEntry(std::string_view name) {
  const auto* const entry = std::find_if(kEntries.begin(), kEntries.end(),
                                         [&](const Entry& e) { return e.name == name; });
  if (entry != kEntries.end()) {
    return entry;
  }
  return name.starts_with("IMU.") ? &kImu : nullptr;
}

void ExpectText(const WrittenSetting& setting, const std::vector<std::string>& choices,
                std::string_view reason) {
  std::string_view text = SingleValue(setting);
  if (text.size() > 1 && text.starts_with('"')) {  // a number in quotes
    text = text.substr(1, text.size() - 2);
  }
  if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
    throw InputError(fmt::format("{}: {} is '{}', expected \"{}\"{}", setting.origin, setting.name,
                                 text, fmt::join(choices, "\" or \""), reason));
  }
}

// Ours and ORB-SLAM3's name for images without distortion.
std::vector<std::string> CameraTypes() {
  std::vector<std::string> types = LensTypes();
  types.insert(types.begin() + 1, "Rectified");
  return types;
}

double PositiveNumber(const WrittenSetting& setting) {
  double value = 0.0;
  if (!ParseFinite(SingleValue(setting), value) || value <= 0.0) {
    throw InputError(fmt::format("{}: {} is '{}', expected a number > 0", setting.origin,
                                 setting.name, setting.text));
  }
  return value;
}

// Translates the settings of a file one by one. Values that depend on two settings are computed at
// the end, when all settings are known.
class Translator {
 public:
  void Add(WrittenSetting setting) {
    const Entry* const entry = FindEntry(setting.name);
    if (entry == nullptr) {
      settings_.push_back(std::move(setting));
      return;
    }
    setting.key = entry->key;
    switch (entry->kind) {
      case Kind::kIgnored:
        return;
      case Kind::kRefused:
        throw InputError(fmt::format("{}: {} of ORB-SLAM3 cannot be translated: {}", setting.origin,
                                     setting.name, entry->why));
      case Kind::kVersion:
        ExpectText(setting, {"1.0"}, "");
        return;
      case Kind::kModel:
        ExpectText(setting, CameraTypes(), "; HullSLAM has no other camera model");
        is_rectified_ = setting.text == "Rectified";
        if (!is_rectified_) {
          setting.key = "Camera.type";
          settings_.push_back(std::move(setting));
        }
        return;
      case Kind::kRenamed:
        settings_.push_back(std::move(setting));
        return;
      case Kind::kBaseline:
        baseline_ = std::move(setting);
        return;
    }
  }

  std::vector<WrittenSetting> Finish() {
    AddBaseline();
    CheckRectified();
    return std::move(settings_);
  }

 private:
  // The number that a setting gives. Absent if the setting is not given, or if it is not a number;
  // this error is reported later, when the setting is applied.
  std::optional<double> Number(std::string_view key) const {
    const auto it = std::find_if(settings_.begin(), settings_.end(),
                                 [&](const WrittenSetting& s) { return s.key == key; });
    double value = 0.0;
    return it != settings_.end() && ParseFinite(it->text, value) ? std::optional(value)
                                                                 : std::nullopt;
  }

  void AddBaseline() {
    if (!baseline_) {
      return;
    }
    const double baseline = PositiveNumber(*baseline_);
    if (const auto fx = Number("Camera.fx")) {
      baseline_->key = "Camera.bf";
      baseline_->text = fmt::format("{}", baseline * *fx);
      settings_.push_back(*baseline_);
    }
  }

  void CheckRectified() const {
    for (const WrittenSetting& setting : settings_) {
      const bool is_distortion =
          setting.key.starts_with("Camera.k") || setting.key.starts_with("Camera.p");
      if (is_rectified_ && is_distortion && Number(setting.key) != 0.0) {
        throw InputError(fmt::format("{}: {} is '{}', expected 0 with Camera.type \"Rectified\"",
                                     setting.origin, setting.name, setting.text));
      }
    }
  }

  std::vector<WrittenSetting> settings_;
  std::optional<WrittenSetting> baseline_;
  bool is_rectified_ = false;
};

}  // namespace

std::vector<WrittenSetting> TranslateOrb3Settings(std::vector<WrittenSetting> settings) {
  Translator translator;
  for (WrittenSetting& setting : settings) {
    translator.Add(std::move(setting));
  }
  return translator.Finish();
}

}  // namespace hullslam
