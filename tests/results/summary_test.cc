// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/summary.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> Keys(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& item : json.items()) {
    keys.push_back(item.key());
  }
  return keys;
}

TEST(Summary, OfAMonocularRunTellsHowTheMapBegan) {
  RunSummary summary;
  EXPECT_FALSE(Json::parse(FormatSummary(summary)).contains("initialisation"));
  summary.initialisation = InitialisationSummary();
  summary.initialisation->failures["too little parallax"] = 3;
  const Json without_map = Json::parse(FormatSummary(summary))["initialisation"];
  EXPECT_TRUE(without_map["seconds"].is_null());
  EXPECT_EQ(without_map["failures"]["too little parallax"], 3);
  summary.initialisation->seconds = 1.5;
  const Json with_map = Json::parse(FormatSummary(summary))["initialisation"];
  EXPECT_EQ(with_map["seconds"], 1.5);
}

TEST(Summary, ListsTheIslandsOfTheMap) {
  RunSummary summary;
  EXPECT_FALSE(Json::parse(FormatSummary(summary)).contains("islands"));
  summary.islands = IslandsSummary{.begun = 3, .joined = 1};
  summary.islands->at_end = {{.number = 2, .is_main = true, .ate_rmse_m = 0.25}, {.number = 3}};
  const Json islands = Json::parse(FormatSummary(summary))["islands"];
  EXPECT_EQ(Keys(islands), (std::vector<std::string>{"begun", "joined", "at_end"}));
  EXPECT_EQ(islands["begun"], 3);
  EXPECT_EQ(islands["joined"], 1);
  ASSERT_EQ(islands["at_end"].size(), 2u);
  EXPECT_EQ(Keys(islands["at_end"][0]),
            (std::vector<std::string>{"number", "main", "keyframes", "landmarks", "frames",
                                      "first_timestamp", "last_timestamp", "ate_rmse_m"}));
  EXPECT_EQ(islands["at_end"][0]["main"], true);
  EXPECT_EQ(islands["at_end"][0]["ate_rmse_m"], 0.25);
  EXPECT_EQ(islands["at_end"][1]["number"], 3);
  EXPECT_TRUE(islands["at_end"][1]["first_timestamp"].is_null());
}

TEST(Summary, SaysWhereAndWhyFramesWereLost) {
  RunSummary summary;
  summary.trajectory.losses = {{{.first_frame = 4,
                                 .last_frame = 8,
                                 .first_timestamp = 0.5,
                                 .last_timestamp = 0.75,
                                 .frames = 5},
                                TrackingFailure::kTooFewFeatures}};
  const Json losses = Json::parse(FormatSummary(summary))["trajectory"]["losses"];
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_EQ(Keys(losses[0]),
            (std::vector<std::string>{"first_frame", "last_frame", "first_timestamp",
                                      "last_timestamp", "frames", "reason"}));
  EXPECT_EQ(losses[0]["last_frame"], 8);
  EXPECT_EQ(losses[0]["last_timestamp"], 0.75);
  EXPECT_EQ(losses[0]["reason"], "too few features");
}

TEST(Summary, SaysWherePosesAreUnsure) {
  RunSummary summary;
  summary.trajectory.unsure = {{.first_frame = 4,
                                .last_frame = 8,
                                .first_timestamp = 0.5,
                                .last_timestamp = 0.75,
                                .frames = 5}};
  const Json unsure = Json::parse(FormatSummary(summary))["trajectory"]["unsure"];
  ASSERT_EQ(unsure.size(), 1u);
  EXPECT_EQ(Keys(unsure[0]),
            (std::vector<std::string>{"first_frame", "last_frame", "first_timestamp",
                                      "last_timestamp", "frames"}));
  EXPECT_EQ(unsure[0]["first_frame"], 4);
  EXPECT_EQ(unsure[0]["frames"], 5);
}

TEST(Summary, HasTheKeysOfTheFormatInOrder) {
  const Json json = Json::parse(FormatSummary({}));
  EXPECT_EQ(Keys(json), (std::vector<std::string>{"trajectory", "objects", "timing", "memory",
                                                  "map", "provenance", "files"}));
  EXPECT_EQ(
      Keys(json["trajectory"]),
      (std::vector<std::string>{"ate_rmse_m", "alignment", "scale", "pairs", "frames", "tracked",
                                "lost", "poses", "pairing", "coverage", "rpe_rmse_m",
                                "rpe_rmse_deg", "skipped", "unpaired", "losses", "unsure"}));
  EXPECT_EQ(Keys(json["timing"]),
            (std::vector<std::string>{"track_ms", "stages_ms", "total_s", "frames_per_second"}));
  EXPECT_EQ(Keys(json["timing"]["track_ms"]),
            (std::vector<std::string>{"median", "mean", "p95", "max"}));
  EXPECT_EQ(Keys(json["memory"]), (std::vector<std::string>{"peak_mb"}));
  EXPECT_EQ(Keys(json["map"]),
            (std::vector<std::string>{"keyframes", "landmarks", "landmarks_at_infinity",
                                      "contradicted_landmarks", "loops", "sessions",
                                      "reprojection_px", "known_sizes"}));
  EXPECT_EQ(Keys(json["provenance"]), (std::vector<std::string>{"program",
                                                                "version",
                                                                "git",
                                                                "settings_hash",
                                                                "preset",
                                                                "preset_overrides",
                                                                "seed",
                                                                "pipeline",
                                                                "masks",
                                                                "masks_format",
                                                                "network",
                                                                "mask_all",
                                                                "mask_all_right",
                                                                "sequence",
                                                                "dataset",
                                                                "sequence_choices",
                                                                "map",
                                                                "loaded_map",
                                                                "interrupted",
                                                                "input_failure"}));
}

TEST(Summary, HasTheKeysOfObjectsInOrder) {
  RunSummary summary;
  summary.objects = ObjectsSummary();
  const Json json = Json::parse(FormatSummary(summary));
  EXPECT_EQ(Keys(json["objects"]),
            (std::vector<std::string>{"count", "siou_mean", "siou_mask_mean", "mtd_mean_m2",
                                      "tangent_mean_px", "observations", "candidates", "detections",
                                      "frames_with_masks", "frames_without_masks", "rejections",
                                      "changes"}));
  EXPECT_TRUE(json["objects"]["changes"].is_null());
  EXPECT_TRUE(json["objects"]["siou_mean"].is_null());
  EXPECT_TRUE(json["objects"]["rejections"].is_object());
}

TEST(Summary, UnknownValuesAreNull) {
  const Json json = Json::parse(FormatSummary({}));
  EXPECT_TRUE(json["trajectory"]["ate_rmse_m"].is_null());
  EXPECT_TRUE(json["trajectory"]["scale"].is_null());
  EXPECT_TRUE(json["objects"].is_null());
  EXPECT_TRUE(json["provenance"]["git"].is_null());
  EXPECT_TRUE(json["timing"]["stages_ms"].is_object());
}

TEST(Summary, WhatReplacesAPresetIsListed) {
  RunSummary summary;
  EXPECT_EQ(Json::parse(FormatSummary(summary))["provenance"]["preset_overrides"], Json::array());
  summary.provenance.preset = "voom";
  summary.provenance.preset_overrides = {
      {.key = "a.b", .preset_value = "1", .value = "2", .source = "--set"}};
  const Json provenance = Json::parse(FormatSummary(summary))["provenance"];
  EXPECT_EQ(provenance["preset"], "voom");
  const Json expected = {
      {"key", "a.b"}, {"preset_value", "1"}, {"value", "2"}, {"source", "--set"}};
  EXPECT_EQ(provenance["preset_overrides"], Json::array({expected}));
}

TEST(Summary, ValuesAreWritten) {
  StageTimes times;
  times.Add("extract", 2.0);
  times.Add("extract", 4.0);
  RunSummary summary;
  summary.trajectory.ate_rmse_m = 0.0095;
  summary.trajectory.skipped = 3;
  summary.objects = ObjectsSummary{.count = 6, .siou_mean = 0.8};
  summary.objects->rejections["too few views"] = 2;
  summary.objects->changes = {{"gone", 3}};
  summary.timing.stages_ms = SummarizeStages(times);
  summary.map.landmarks = 1234;
  summary.map.landmarks_at_infinity = 12;
  summary.map.contradicted_landmarks = 34;
  summary.provenance.seed = 18446744073709551615U;
  summary.provenance.sequence = "fr1 \"xyz\" \xff";
  const Json json = Json::parse(FormatSummary(summary));
  EXPECT_EQ(json["trajectory"]["ate_rmse_m"], 0.0095);
  EXPECT_EQ(json["trajectory"]["skipped"], 3);
  EXPECT_EQ(json["objects"]["count"], 6);
  EXPECT_EQ(json["objects"]["siou_mean"], 0.8);
  EXPECT_EQ(json["objects"]["rejections"]["too few views"], 2);
  EXPECT_EQ(json["objects"]["changes"]["gone"], 3);
  EXPECT_EQ(json["timing"]["stages_ms"]["extract"]["mean"], 3.0);
  EXPECT_EQ(json["timing"]["stages_ms"]["extract"]["max"], 4.0);
  EXPECT_EQ(json["map"]["landmarks"], 1234);
  EXPECT_EQ(json["map"]["landmarks_at_infinity"], 12);
  EXPECT_EQ(json["map"]["contradicted_landmarks"], 34);
  EXPECT_EQ(json["provenance"]["seed"], 18446744073709551615U);
  EXPECT_TRUE(json["provenance"]["sequence"].get<std::string>().starts_with("fr1 \"xyz\" "));
}

TEST(Summary, PeakMemoryCountsTouchedPages) {
  const double before = PeakMemoryMb();
  EXPECT_GT(before, 1.0);
  const std::vector<char> block(static_cast<size_t>(200e6), 'x');
  EXPECT_GT(PeakMemoryMb(), 200.0) << block.back();
  EXPECT_GE(PeakMemoryMb(), before);
}

}  // namespace
}  // namespace hullslam
