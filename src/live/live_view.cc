// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_view.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "live/http_access.h"
#include "live/http_server.h"
#include "live/message_hub.h"
#include "util/latest_worker.h"
#include "util/task_runner.h"
#include "view/report_page.h"

namespace hullslam {
namespace {

using LiveClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFramePeriod(70);
constexpr std::chrono::milliseconds kMapPeriod(500);
// Making messages about the map may take this share of the time of a core.
constexpr int kMostMapShare = 20;
constexpr std::chrono::milliseconds kLastWait(5000);  // for a browser on a busy machine

std::string HostName() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

HttpAccessRules RulesFor(const ViewAddress& address) {
  return {
      .is_loopback = IsLoopback(address.address), .token = MakeToken(), .host_name = HostName()};
}

// An address that stands for all addresses of this computer is no address to open.
std::string UrlOf(const ViewAddress& address, int port, const std::string& token) {
  const bool is_any = address.address == "0.0.0.0" || address.address == "::";
  const std::string host = is_any ? HostName() : address.address;
  return fmt::format("http://{}/?token={}", JoinAddress(host, port), token);
}

// Judges a request, and answers those for the page itself and those that no part of it has.
HttpReply ReplyWithPage(const HttpAccessRules& rules, const HttpRequest& request,
                        const SharedMessage& page) {
  const HttpAccess access = JudgeRequest(rules, request, request.method != "GET");
  if (access != HttpAccess::kAllowed) {
    return TextReply(403, Explain(access));
  }
  if (request.path != "/") {
    return TextReply(404, "There is no such page.");
  }
  if (request.method != "GET") {
    return TextReply(405, "Only GET is possible here.");
  }
  return {.type = "text/html; charset=utf-8", .body = page};
}

}  // namespace

struct PageServer::State {
  State(const ViewAddress& address, std::string text)
      : page(std::make_shared<const std::string>(std::move(text))),
        rules(RulesFor(address)),
        server(address.address, address.port, HttpLimits(), hub,
               [this](const HttpRequest& request) { return ReplyWithPage(rules, request, page); }),
        url(UrlOf(address, server.port(), rules.token)) {}

  const SharedMessage page;
  const HttpAccessRules rules;
  MessageHub hub;
  HttpServer server;
  const std::string url;
};

PageServer::PageServer(const ViewAddress& address, std::string page)
    : state_(std::make_unique<State>(address, std::move(page))) {}

PageServer::~PageServer() = default;

const std::string& PageServer::url() const { return state_->url; }

class LiveView::Engine {
 public:
  Engine(const ViewAddress& address, LiveRun run, LiveCommands commands,
         const LiveMapLimits& limits)
      : can_localise_(run.can_localise),
        messages_(std::move(run), limits),
        commands_(std::move(commands)),
        page_(std::make_shared<const std::string>(
            FormatPage(R"({"view":1,"stream":"stream","set":{}})"))),
        rules_(RulesFor(address)),
        saver_([this](std::shared_ptr<const Map> map) { Save(*map); }),
        server_(address.address, address.port, HttpLimits(), hub_,
                [this](const HttpRequest& request) { return Answer(request); }),
        url_(UrlOf(address, server_.port(), rules_.token)),
        thread_([this] { Run(); }) {}

  ~Engine() { Stop(); }
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  const std::string& url() const { return url_; }
  uint64_t bytes_sent() const { return server_.bytes_sent(); }
  LiveInbox& inbox() { return inbox_; }
  PauseGate& gate() { return gate_; }
  bool IsLocalisationWanted() const { return is_localising_; }

  void SetPhase(LivePhase phase) {
    {
      const std::lock_guard lock(saving_);
      phase_ = phase;
    }
    is_control_changed_ = true;
    saver_.WaitUntilIdle();
  }

  void End(std::shared_ptr<const Map> map, nlohmann::json summary) {
    gate_.Open();
    SetPhase(LivePhase::kEnded);
    Stop();
    if (hub_.reader_count() == 0 || has_failed_) {
      return;
    }
    messages_.SetSummary(std::move(summary));
    LiveState state = inbox_.state();
    state.map = std::move(map);
    if (state.map != nullptr) {
      messages_.MapChange(state, false, true);
    }
    messages_.Frame(nullptr, Controls(), inbox_.rate());
    const auto whole = std::make_shared<const std::string>(messages_.Whole(Controls()));
    const LiveClock::time_point end = LiveClock::now() + kLastWait;
    hub_.LeaveBehind();
    while (LiveClock::now() < end) {
      hub_.GiveWhole(whole);
      if (hub_.WaitUntilSent(std::chrono::milliseconds(50))) {
        break;
      }
    }
  }

 private:
  void Stop() {
    {
      const std::lock_guard lock(mutex_);
      is_stopped_ = true;
    }
    stopped_.notify_all();
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  LiveControls Controls() const {
    LiveControls controls;
    controls.phase =
        phase_ == LivePhase::kRunning && gate_.IsPaused() ? LivePhase::kPaused : phase_.load();
    controls.is_localising = is_localising_;
    const std::lock_guard lock(mutex_);
    controls.notice = notice_;
    return controls;
  }

  void SetNotice(std::string notice) {
    {
      const std::lock_guard lock(mutex_);
      notice_ = std::move(notice);
    }
    is_control_changed_ = true;
  }

  // Waits for the next turn. Returns false at the end.
  bool Wait() {
    std::unique_lock lock(mutex_);
    return !stopped_.wait_for(lock, kFramePeriod, [this] { return is_stopped_; });
  }

  void Run() {
    RunInBackground();
    try {
      while (Wait()) {
        if (hub_.reader_count() > 0) {
          GiveFrame();
          GiveMap();
        }
      }
    } catch (const std::exception& error) {
      has_failed_ = true;
      if (commands_.warn) {
        commands_.warn(error.what());
      }
    }
  }

  void GiveFrame() {
    const std::optional<LiveFrame> frame = inbox_.TakeFrame();
    if (frame || is_control_changed_.exchange(false)) {
      hub_.GiveFrame(std::make_shared<const std::string>(
          messages_.Frame(frame ? &*frame : nullptr, Controls(), inbox_.rate())));
    }
  }

  void GiveMap() {
    const LiveClock::time_point begin = LiveClock::now();
    const bool is_whole_needed = hub_.NeedsWhole();
    // A run that waits needs no processor, so its map may take more of it and is up to date soon.
    const bool is_due = begin >= (gate_.IsPaused() ? last_map_ + kMapPeriod : next_map_);
    if (!is_due && !(is_whole_needed && begin >= next_whole_)) {
      return;
    }
    last_map_ = begin;
    const LiveState state = inbox_.state();
    if (state.map != nullptr) {
      // If all browsers wait for the whole map, it need not grow by small changes.
      const bool is_limited = !is_whole_needed || hub_.reader_count() > 1;
      if (const auto change = messages_.MapChange(state, is_limited, gate_.IsPaused())) {
        hub_.GiveMapChange(std::make_shared<const std::string>(*change));
      }
    }
    if (is_whole_needed) {
      hub_.GiveWhole(std::make_shared<const std::string>(messages_.Whole(Controls())));
      is_control_changed_ = true;  // the new reader learns the state
    }
    const LiveClock::duration used = LiveClock::now() - begin;
    next_map_ = begin + std::max<LiveClock::duration>(kMapPeriod, kMostMapShare * used);
    if (is_whole_needed) {
      next_whole_ = next_map_;
    }
  }

  HttpReply Answer(const HttpRequest& request) {
    const HttpAccess access = JudgeRequest(rules_, request, request.method != "GET");
    if (access == HttpAccess::kAllowed && request.method == "GET" && request.path == "/stream") {
      return {.type = "text/event-stream", .is_stream = true};
    }
    if (access == HttpAccess::kAllowed && request.path.starts_with("/control/")) {
      return request.method == "POST" ? Control(request.path.substr(9))
                                      : TextReply(405, "Only POST is possible here.");
    }
    return ReplyWithPage(rules_, request, page_);
  }

  HttpReply Control(const std::string& command) {
    if (phase_ == LivePhase::kEnded) {
      return TextReply(409, "The run has ended.");
    }
    if (command == "pause") {
      gate_.Pause();
    } else if (command == "resume") {
      gate_.Resume();
    } else if (command == "step") {
      gate_.Step();
    } else if (command == "save-map") {
      return BeginSaving();
    } else if (command == "localise" || command == "map") {
      if (!can_localise_) {
        return TextReply(409, "This run only localises.");
      }
      const std::shared_ptr<const Map> map = inbox_.state().map;
      if (map == nullptr || map->keyframes().empty()) {
        return TextReply(409, "There is no map yet.");
      }
      is_localising_ = command == "localise";
    } else {
      return TextReply(404, "There is no such command.");
    }
    is_control_changed_ = true;
    return TextReply(200, "done");
  }

  HttpReply BeginSaving() {
    std::shared_ptr<const Map> map = inbox_.state().map;
    if (map == nullptr || map->keyframes().empty()) {
      return TextReply(409, "There is no map yet.");
    }
    const std::lock_guard lock(saving_);
    if (phase_ != LivePhase::kRunning) {
      return TextReply(409, "The run is ending. It saves its map if it has --save-map.");
    }
    if (saver_.IsBusy()) {
      return TextReply(409, "The map is being saved already.");
    }
    SetNotice("saving the map");
    saver_.Post(std::move(map));
    return TextReply(202, "The map is being saved.");
  }

  void Save(const Map& map) { SetNotice(commands_.save_map(map)); }

  const bool can_localise_;
  LiveInbox inbox_;
  PauseGate gate_;
  MessageHub hub_;
  LiveMessages messages_;  // used by the thread, and by End() after it
  const LiveCommands commands_;
  const SharedMessage page_;
  const HttpAccessRules rules_;
  std::atomic<LivePhase> phase_ = LivePhase::kRunning;
  std::atomic<bool> is_localising_ = false;
  std::atomic<bool> is_control_changed_ = false;
  std::atomic<bool> has_failed_ = false;
  LiveClock::time_point last_map_;
  LiveClock::time_point next_map_;
  LiveClock::time_point next_whole_;
  std::mutex saving_;         // held when a map is given to the saver, and when the phase changes
  mutable std::mutex mutex_;  // guards the two members below
  std::string notice_;
  bool is_stopped_ = false;
  std::condition_variable stopped_;
  LatestWorker<std::shared_ptr<const Map>> saver_;
  HttpServer server_;
  const std::string url_;
  std::thread thread_;  // last, because the thread uses the others
};

LiveView::LiveView(const ViewAddress& address, LiveRun run, LiveCommands commands,
                   const LiveMapLimits& limits)
    : engine_(std::make_unique<Engine>(address, std::move(run), std::move(commands), limits)) {}

LiveView::~LiveView() = default;

const std::string& LiveView::url() const { return engine_->url(); }

void LiveView::Show(LiveFrame frame) { engine_->inbox().Put(std::move(frame)); }

PauseGate::Clock::duration LiveView::PassGate(const std::function<bool()>& is_cancelled,
                                              const std::function<void()>& on_pause) {
  return engine_->gate().Pass(is_cancelled, on_pause);
}

bool LiveView::IsLocalisationWanted() const { return engine_->IsLocalisationWanted(); }

void LiveView::BeginFinishing() {
  engine_->gate().Open();
  engine_->SetPhase(LivePhase::kFinishing);
}

void LiveView::End(std::shared_ptr<const Map> map, nlohmann::json summary) {
  engine_->End(std::move(map), std::move(summary));
}

uint64_t LiveView::bytes_sent() const { return engine_->bytes_sent(); }

}  // namespace hullslam
