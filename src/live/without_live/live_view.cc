// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_view.h"

#include <nlohmann/json.hpp>

#include "live/live_output.h"
#include "util/components.h"

namespace hullslam {
namespace {

void FailWithoutLive() { RequireComponent("LIVE", "a view in a browser is asked for"); }

const std::string kNoUrl;

}  // namespace

// No object of these classes exists, because their constructors throw.
struct PageServer::State {};
class LiveView::Engine {};

PageServer::PageServer(const ViewAddress&, std::string) { FailWithoutLive(); }
PageServer::~PageServer() = default;
const std::string& PageServer::url() const { return kNoUrl; }

LiveView::LiveView(const ViewAddress&, LiveRun, LiveCommands, const LiveMapLimits&) {
  FailWithoutLive();
}
LiveView::~LiveView() = default;
const std::string& LiveView::url() const { return kNoUrl; }
void LiveView::Show(LiveFrame) {}
PauseGate::Clock::duration LiveView::PassGate(const std::function<bool()>&,
                                              const std::function<void()>&) {
  return {};
}
bool LiveView::IsLocalisationWanted() const { return false; }
void LiveView::BeginFinishing() {}
void LiveView::End(std::shared_ptr<const Map>, nlohmann::json) {}
uint64_t LiveView::bytes_sent() const { return 0; }

LiveOutput::LiveOutput() = default;
LiveOutput::LiveOutput(ShownRun) { FailWithoutLive(); }
LiveOutput::~LiveOutput() = default;
LiveOutput::LiveOutput(LiveOutput&&) noexcept = default;
std::string LiveOutput::url() const { return {}; }
std::chrono::steady_clock::duration LiveOutput::BeforeFrame(System&, const std::function<bool()>&,
                                                            const std::function<void()>&) {
  return {};
}
void LiveOutput::NoteFrame(const FrameReport&) {}
void LiveOutput::AfterFrame(LiveFrame, const System&) {}
void LiveOutput::BeginFinishing() {}
void LiveOutput::End(std::shared_ptr<const Map>, const nlohmann::json&) {}

}  // namespace hullslam
