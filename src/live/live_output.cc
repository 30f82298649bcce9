// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

std::string SaveLiveMap(const std::filesystem::path& file, const MapSettings& settings,
                        const Map& map) {
  try {
    WriteMap(file, map, settings);
  } catch (const InputError& error) {
    return fmt::format("The map was not saved: {}", error.what());
  }
  return fmt::format("The map of {} is in {}", Counted(map.keyframes().size(), "keyframe"),
                     file.string());
}

}  // namespace

LiveOutput::LiveOutput() = default;

LiveOutput::LiveOutput(ShownRun shown) {
  const auto save = [file = std::move(shown.map_file), settings = std::move(shown.settings)](
                        const Map& map) { return SaveLiveMap(file, settings, map); };
  view_ = std::make_unique<LiveView>(shown.address, std::move(shown.run),
                                     LiveCommands{.save_map = save, .warn = std::move(shown.warn)});
}

LiveOutput::~LiveOutput() = default;
LiveOutput::LiveOutput(LiveOutput&&) noexcept = default;

std::string LiveOutput::url() const { return view_ ? view_->url() : std::string(); }

std::chrono::steady_clock::duration LiveOutput::BeforeFrame(
    System& system, const std::function<bool()>& is_cancelled,
    const std::function<void()>& on_pause) {
  if (!view_) {
    return {};
  }
  const auto waited = view_->PassGate(is_cancelled, on_pause);
  const bool is_wanted = view_->IsLocalisationWanted();
  const std::shared_ptr<const Map> map = system.map();
  if (is_wanted != is_localising_ && map != nullptr && !map->keyframes().empty()) {
    system.SetLocalizationOnly(is_wanted);
    is_localising_ = is_wanted;
  }
  return waited;
}

void LiveOutput::NoteFrame(const FrameReport& report) {
  if (view_) {
    report_ = report;
  }
}

void LiveOutput::AfterFrame(LiveFrame frame, const System& system) {
  if (view_ && report_) {
    frame.report = std::move(*report_);
    frame.map = system.map();
    view_->Show(std::move(frame));
    report_.reset();
  }
}

void LiveOutput::BeginFinishing() {
  if (view_) {
    view_->BeginFinishing();
  }
}

void LiveOutput::End(std::shared_ptr<const Map> map, const nlohmann::json& summary) {
  if (view_) {
    view_->End(std::move(map), summary);
  }
}

}  // namespace hullslam
