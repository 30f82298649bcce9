// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_message.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/made_view.h"

namespace hullslam {
namespace {

// 1.0f has the bytes 00 00 80 3f, and 258 has 02 01 00 00.
TEST(PackedArray, HasTheLeastSignificantByteFirst) {
  EXPECT_EQ(PackArray(std::vector<float>{1.0f}), (nlohmann::json{{"f32", "AACAPw=="}}));
  EXPECT_EQ(PackArray(std::vector<uint32_t>{258}), (nlohmann::json{{"u32", "AgEAAA=="}}));
  EXPECT_EQ(PackArray(std::vector<uint8_t>{1, 255}), (nlohmann::json{{"u8", "Af8="}}));
  EXPECT_EQ(PackArray(std::vector<float>()), (nlohmann::json{{"f32", ""}}));
}

using Json = nlohmann::json;

TEST(ViewMessage, HasTheKeysOfTheFormat) {
  const Json json = Json::parse(FormatViewMessage(MadeView(3)));
  EXPECT_EQ(json["view"], kViewVersion);
  const Json& parts = json["set"];
  EXPECT_EQ(parts["run"]["title"], "made");
  EXPECT_EQ(parts["run"]["unit"], "m");
  EXPECT_EQ(parts["run"]["start"], 100.0);
  EXPECT_EQ(parts["up"], Json({0.0, -1.0, 0.0}));
  EXPECT_EQ(parts["camera"]["fx"], 100.0);
  EXPECT_EQ(parts["trajectory"]["time"], PackArray(std::vector<float>{0.0f, 1.0f, 2.0f}));
  EXPECT_EQ(parts["landmarks"]["total"], 3);
  EXPECT_EQ(parts["surface"]["triangle"], PackArray(std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(parts["surface"]["colour"], PackArray(std::vector<uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(parts["landmarks"]["colour"],
            PackArray(std::vector<uint8_t>{255, 0, 1, 255, 0, 1, 255, 0, 1}));
  EXPECT_EQ(parts["keyframes"]["id"], PackArray(std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(parts["edges"]["covisibility"], PackArray(std::vector<uint32_t>{0, 1}));
  const Json& object = parts["objects"][0];
  EXPECT_EQ(object["id"], 7);
  EXPECT_EQ(object["centre"], Json({0.0, 0.0, 2.0}));
  EXPECT_EQ(object["half_axes"], Json({0.2, 0.2, 0.2}));
  EXPECT_EQ(object["siou"], 0.75);
  EXPECT_TRUE(object["siou_mask"].is_null());
  EXPECT_FALSE(object.contains("name"));
  EXPECT_EQ(parts["images"][0]["image"], "data:image/jpeg;base64,anBlZw==");
  EXPECT_EQ(parts["images"][0]["time"], 1.0);
  EXPECT_EQ(parts["images"][0]["outlines"][0]["points"], Json({0.0, 1.0, 2.0, 2.0}));
  EXPECT_EQ(parts["summary"]["trajectory"]["ate_rmse_m"], 0.01);
}

TEST(ViewMessage, AnEmptyModelHasNoGeometry) {
  const Json parts = Json::parse(FormatViewMessage({}))["set"];
  for (const char* const part : {"up", "camera", "landmarks", "trajectory", "groundtruth"}) {
    EXPECT_FALSE(parts.contains(part)) << part;
  }
  EXPECT_EQ(parts["objects"], Json::array());
}

// The message stands inside a script element, which "</script>" or "<!--" would end or change.
TEST(ViewMessage, NoLabelCanLeaveTheMessage) {
  const std::string label = "</script><!--<b>\"'&\n\u2028\U0001F600";
  const std::string text = FormatViewMessage(MadeView(1, label));
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const std::string read = Json::parse(text)["set"]["objects"][0]["class"];
  EXPECT_TRUE(read.starts_with("</script><!--<b>\"'&")) << read;
  EXPECT_TRUE(read.ends_with("\U0001F600")) << read;
}

TEST(ViewMessage, AnObjectHasItsNameIfAUserGaveOne) {
  ViewModel model = MadeView(1, "cup");
  model.objects.at(0).object.name = "Lisa's";
  const Json json = Json::parse(FormatViewMessage(model));
  EXPECT_EQ(json["set"]["objects"][0]["name"], "Lisa's");
}

TEST(ViewMessage, BytesThatAreNoTextAreReplaced) {
  const Json json = Json::parse(FormatViewMessage(MadeView(1, "cup\xff")));
  EXPECT_EQ(json["set"]["objects"][0]["class"], "cup?");
}

TEST(ViewMessage, TellsWhatHasChanged) {
  ViewModel model = MadeView(1);
  ChangedObject gone{.change = ObjectChange::kGone, .label = "cup", .expected = 7, .found = 1};
  gone.former = LocatedObject{ObjectId(4), {}};
  gone.former->ellipsoid.world_from_object.translation = {1.0, 2.0, 3.0};
  model.changes = {gone};
  const Json changes = Json::parse(FormatViewMessage(model))["set"]["changes"];
  const Json former = {{"id", 4}, {"centre", {1.0, 2.0, 3.0}}};
  EXPECT_EQ(changes, Json::array({{{"change", "gone"},
                                   {"class", "cup"},
                                   {"former", former},
                                   {"now", nullptr},
                                   {"expected", 7},
                                   {"found", 1}}}));
}

TEST(ViewMessage, LossesComeFromTheSummary) {
  ViewModel model = MadeView(2);
  model.summary["trajectory"]["losses"] = {
      {{"first_timestamp", 101.5}, {"last_timestamp", 102.0}, {"frames", 3}, {"reason", "dark"}},
      {{"first_timestamp", "?"}},
      7};
  const Json losses = Json::parse(FormatViewMessage(model))["set"]["losses"];
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_EQ(losses[0], (Json{{"from", 1.5}, {"to", 2.0}, {"frames", 3}, {"reason", "dark"}}));
}

}  // namespace

}  // namespace hullslam
