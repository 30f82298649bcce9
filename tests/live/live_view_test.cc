// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_view.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <regex>
#include <string>
#include <thread>

#include "support/expect_error.h"
#include "support/made_live.h"
#include "support/raw_client.h"

namespace hullslam {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

struct OpenedUrl {
  int port = 0;
  std::string token;
};

OpenedUrl ParseUrl(const std::string& url) {
  std::smatch parts;
  EXPECT_TRUE(std::regex_match(url, parts,
                               std::regex("http://127\\.0\\.0\\.1:(\\d+)/\\?token=([0-9a-f]{32})")))
      << url;
  return {std::stoi(parts[1]), parts[2]};
}

class LiveViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    view_ = std::make_unique<LiveView>(ViewAddress{.port = 0}, MadeLiveRun(world_),
                                       LiveCommands{.save_map = [this](const Map& map) {
                                         saved_ = map.keyframes().size();
                                         return std::string("saved it");
                                       }});
    address_ = ParseUrl(view_->url());
  }

  std::string Post(const std::string& command, const std::string& token) {
    return Ask(address_.port, "POST /control/" + command,
               "Content-Length: 0\r\nX-Hullslam-Token: " + token + "\r\n");
  }

  std::unique_ptr<RawClient> Watch() const {
    auto client = std::make_unique<RawClient>(address_.port);
    client->Send("GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n");
    client->ReadUntil("\r\n\r\n");
    return client;
  }

  // The part "set" of the next message for which `is_it` is true.
  template <typename IsIt>
  static Json Await(RawClient& client, const IsIt& is_it) {
    for (int i = 0; i < 2000 && !client.is_closed(); ++i) {
      const std::string event = client.ReadUntil("\n\n");
      if (event.starts_with("data: ")) {
        Json set = Json::parse(event.substr(6)).value("set", Json::object());
        if (is_it(set)) {
          return set;
        }
      }
    }
    ADD_FAILURE() << "the message did not come";
    return {};
  }

  void ShowFrame(uint32_t index) { view_->Show(MadeLiveFrame(world_, index, map_)); }

  SyntheticWorld world_;
  std::shared_ptr<const Map> map_ =
      std::make_shared<const Map>(MakeSyntheticMap(world_, {0, 10, 20}).map.Snapshot());
  std::atomic<size_t> saved_ = 0;
  std::unique_ptr<LiveView> view_;
  OpenedUrl address_;
};

TEST_F(LiveViewTest, ServesThePageThatOpensTheStream) {
  const std::string page = Ask(address_.port, "GET /");
  EXPECT_EQ(page.find("HTTP/1.1 200"), 0u);
  EXPECT_NE(page.find(R"("stream":"stream")"), std::string::npos);
  EXPECT_EQ(page.find(address_.token), std::string::npos);
  EXPECT_EQ(Ask(address_.port, "GET /nothing").find("HTTP/1.1 404"), 0u);
  EXPECT_EQ(Ask(address_.port, "GET /../etc/passwd").find("HTTP/1.1 404"), 0u);
  EXPECT_EQ(
      Ask(address_.port, "GET /stream", "Origin: http://evil.example\r\n").find("HTTP/1.1 403"),
      0u);
}

TEST_F(LiveViewTest, ABrowserGetsTheMapAndThenTheFrames) {
  ShowFrame(0);
  const auto client = Watch();
  const Json whole = Await(*client, [](const Json& set) { return set.contains("run"); });
  EXPECT_EQ(whole["summary"]["map"]["keyframes"], 3);
  ShowFrame(1);
  const Json frame = Await(*client, [](const Json& set) {
    return set.contains("live") && set["live"].value("frame", 0) == 2;
  });
  EXPECT_TRUE(frame.contains("live_image"));
  EXPECT_GT(view_->bytes_sent(), 1000u);
}

TEST_F(LiveViewTest, ControlsNeedTheToken) {
  EXPECT_EQ(Post("pause", "0").find("HTTP/1.1 403"), 0u);
  EXPECT_EQ(view_->PassGate([] { return false; }, {}), 0ns);
  EXPECT_EQ(Ask(address_.port, "GET /control/pause?token=" + address_.token).find("HTTP/1.1 405"),
            0u);
  EXPECT_EQ(Post("format-disk", address_.token).find("HTTP/1.1 404"), 0u);
}

TEST_F(LiveViewTest, TheRunCanBePausedAndStepped) {
  EXPECT_EQ(Post("pause", address_.token).find("HTTP/1.1 200"), 0u);
  EXPECT_GT(view_->PassGate([] { return true; }, {}), 0ns);
  EXPECT_EQ(Post("step", address_.token).find("HTTP/1.1 200"), 0u);
  EXPECT_EQ(view_->PassGate([] { return false; }, {}), 0ns);
  EXPECT_GT(view_->PassGate([] { return true; }, {}), 0ns);
  Post("resume", address_.token);
  EXPECT_EQ(view_->PassGate([] { return false; }, {}), 0ns);
  Post("pause", address_.token);
  view_->BeginFinishing();
  EXPECT_EQ(view_->PassGate([] { return false; }, {}), 0ns);
}

TEST_F(LiveViewTest, TheMapIsSavedAndThePageSaysSo) {
  EXPECT_EQ(Post("save-map", address_.token).find("HTTP/1.1 409"), 0u);
  ShowFrame(0);
  const auto client = Watch();
  EXPECT_EQ(Post("save-map", address_.token).find("HTTP/1.1 202"), 0u);
  Await(*client, [](const Json& set) {
    return set.contains("live") && set["live"]["notice"] == "saved it";
  });
  EXPECT_EQ(saved_, 3u);
}

TEST_F(LiveViewTest, NoEarlierMapReplacesThatOfTheEnd) {
  ShowFrame(0);
  EXPECT_EQ(Post("save-map", address_.token).find("HTTP/1.1 202"), 0u);
  view_->BeginFinishing();
  EXPECT_EQ(saved_, 3u) << "the map is written before the run writes its own";
  const std::string refused = Post("save-map", address_.token);
  EXPECT_EQ(refused.find("HTTP/1.1 409"), 0u);
  EXPECT_NE(refused.find("The run is ending"), std::string::npos);
}

TEST_F(LiveViewTest, LocalisationOnlyIsSwitchedOnceThereIsAMap) {
  EXPECT_EQ(Post("localise", address_.token).find("HTTP/1.1 409"), 0u);
  ShowFrame(0);
  EXPECT_EQ(Post("localise", address_.token).find("HTTP/1.1 200"), 0u);
  EXPECT_TRUE(view_->IsLocalisationWanted());
  EXPECT_EQ(Post("map", address_.token).find("HTTP/1.1 200"), 0u);
  EXPECT_FALSE(view_->IsLocalisationWanted());
}

TEST_F(LiveViewTest, AtTheEndThePageGetsTheResults) {
  ShowFrame(0);
  const auto client = Watch();
  Await(*client, [](const Json& set) { return set.contains("run"); });
  std::thread end([&] { view_->End(map_, {{"trajectory", {{"ate_rmse_m", 0.25}}}}); });
  const Json last = Await(
      *client, [](const Json& set) { return set.contains("run") && set["run"]["live"] == false; });
  end.join();
  EXPECT_EQ(last["summary"]["trajectory"]["ate_rmse_m"], 0.25);
  EXPECT_EQ(last["live"]["phase"], "ended");
  view_.reset();
  client->ReadAll(10s);
  EXPECT_TRUE(client->is_closed());
}

TEST_F(LiveViewTest, ATakenPortIsAnInputError) {
  ExpectInputError(
      [&] { LiveView(ViewAddress{.port = address_.port}, MadeLiveRun(world_), LiveCommands()); },
      {"cannot listen", std::to_string(address_.port)});
}

TEST(PageServer, ServesOnePage) {
  const PageServer server({.port = 0}, "<p>page</p>");
  const OpenedUrl address = ParseUrl(server.url());
  EXPECT_NE(Ask(address.port, "GET /").find("\r\n\r\n<p>page</p>"), std::string::npos);
  EXPECT_EQ(Ask(address.port, "GET /stream").find("HTTP/1.1 404"), 0u);
  EXPECT_EQ(Ask(address.port, "POST /").find("HTTP/1.1 403"), 0u);
}

}  // namespace
}  // namespace hullslam
