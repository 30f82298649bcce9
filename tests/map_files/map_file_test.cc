// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map_files/map_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "features/find_near.h"
#include "files/read_file.h"
#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/random_edits.h"
#include "map_files/invariants.h"
#include "map_files/made_map_file.h"
#include "map_files/map_records.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/made_vocabulary.h"
#include "support/paths.h"
#include "support/random_geometry.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class MapFileTest : public testing::Test {
 protected:
  std::string Written(const Map& map, const MapSettings& settings = MadeSettings()) const {
    WriteMap(path_, map, settings);
    return ReadFile(path_);
  }

  Map ReadBack(const Map& map) const {
    Written(map);
    return ReadMap(path_).map;
  }

  // Expects that a file with these bytes is refused.
  void ExpectRefusal(const std::string& bytes, const std::vector<std::string>& parts = {}) const {
    folder_.Write("other.map", bytes);
    const std::filesystem::path other = folder_.path() / "other.map";
    std::vector<std::string> all = parts;
    all.push_back(other.string());
    ExpectInputError([&] { ReadMap(other); }, all);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "a.map";
};

// Where the file of SmallMap() has the number of keyframes, and then those of culled keyframes,
// landmarks, and slots of landmarks. Before it are prefix, length, sensor, camera, pyramid,
// vocabulary, sessions, corrections.
constexpr size_t kCounts = 14 + 4 + 1 + 88 + 12 + 8 + 4 + (4 + 4 + 4) + (4 + 10 + 4) + 4;

// The bytes with a right checksum at their end.
std::string WithChecksum(std::string bytes) {
  bytes.resize(bytes.size() - 4);
  const auto checksum = static_cast<uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  for (int i = 0; i < 4; ++i) {
    bytes.push_back(static_cast<char>(checksum >> (8 * i) & 0xff));
  }
  return bytes;
}

Map EditedMap(RandomEdits& edits, int count) {
  Map map;
  map.BeginSession({"random", FrameId(0)});
  for (int i = 0; i < count; ++i) {
    edits.Edit(map);
  }
  map.ForgetReplaced(std::numeric_limits<uint32_t>::max());
  return map;
}

// ---- laws

TEST_F(MapFileTest, WritingReadingAndWritingGivesTheSameBytes) {
  const std::string small = Written(SmallMap());
  EXPECT_EQ(Written(ReadBack(SmallMap())), small);
  for (uint32_t seed = 0; seed < 4; ++seed) {
    RandomEdits edits(seed);
    const Map map = EditedMap(edits, 500);
    const std::string bytes = Written(map);
    const Map read = ReadMap(path_).map;
    EXPECT_EQ(Dump(read), Dump(map));
    EXPECT_EQ(Written(read), bytes);
  }
}

// In a map that was read again, new entities get the same ids, and free slots are used in the same
// order.
TEST_F(MapFileTest, NewEntitiesGetTheSameIdsAsWithoutTheFile) {
  for (uint32_t seed = 0; seed < 4; ++seed) {
    RandomEdits edits(seed);
    Map map = EditedMap(edits, 500);
    Map read = ReadBack(map);
    RandomEdits same = edits;
    for (int i = 0; i < 300; ++i) {
      edits.Edit(map);
      same.Edit(read);
    }
    EXPECT_EQ(Dump(read), Dump(map));
    EXPECT_EQ(FindViolations(read), std::vector<std::string>());
  }
}

void ExpectSameDetection(const Detection& a, const Detection& b) {
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.score, b.score);
  EXPECT_EQ(a.contour, b.contour);
  EXPECT_EQ(a.hull, b.hull);
  EXPECT_EQ(a.box.min(), b.box.min());
  EXPECT_EQ(a.box.max(), b.box.max());
  EXPECT_EQ(a.primitive, b.primitive);
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].line.Homogeneous(), b.lines[i].line.Homogeneous());
    EXPECT_EQ(a.lines[i].is_one_sided, b.lines[i].is_one_sided);
  }
  ASSERT_EQ(a.right_lines.size(), b.right_lines.size());
  for (size_t i = 0; i < a.right_lines.size(); ++i) {
    EXPECT_EQ(a.right_lines[i].line.Homogeneous(), b.right_lines[i].line.Homogeneous());
    EXPECT_EQ(a.right_lines[i].is_one_sided, b.right_lines[i].is_one_sided);
  }
  ASSERT_EQ(a.ellipse.has_value(), b.ellipse.has_value());
  EXPECT_EQ(a.ellipse->center, b.ellipse->center);
  EXPECT_EQ(a.ellipse->shape, b.ellipse->shape);
  EXPECT_EQ(a.is_cut, b.is_cut);
  EXPECT_EQ(a.is_box, b.is_box);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.keypoints, b.keypoints);
  EXPECT_EQ(a.embedding, b.embedding);
}

TEST_F(MapFileTest, KeepsEveryFieldOfAFrame) {
  Map map;
  const auto frame = FullFrame(5, 17.25);
  const int columns = DepthGrid::CountAlong(640);
  std::vector<uint16_t> samples(static_cast<size_t>(columns * DepthGrid::CountAlong(480)), 1500);
  samples[7] = 0;
  frame->depth = DepthGrid(columns, samples);
  frame->features.depth[3] = 0.0f;
  frame->detections[0].embedding = {0.6f, -0.8f};
  map.AddKeyframe(frame, {});
  const Map read = ReadBack(map);
  const Frame& found = *read.keyframes().At(KeyframeId(0)).frame;
  EXPECT_EQ(found.id, frame->id);
  EXPECT_EQ(found.timestamp, frame->timestamp);
  EXPECT_EQ(found.depth.columns(), columns);
  EXPECT_EQ(found.depth.samples(), samples);
  EXPECT_EQ(found.features.descriptors, frame->features.descriptors);
  EXPECT_EQ(found.features.depth, frame->features.depth);
  for (size_t i = 0; i < frame->features.size(); ++i) {
    EXPECT_EQ(found.features.keypoints[i].undistorted, frame->features.keypoints[i].undistorted);
    EXPECT_EQ(found.features.keypoints[i].angle, frame->features.keypoints[i].angle);
    EXPECT_EQ(found.features.keypoints[i].level, frame->features.keypoints[i].level);
  }
  std::vector<uint32_t> near;
  FindNear(found.features.grid, found.features.keypoints, {32.0f, 100.0f}, 1.5f, 0, 7, near);
  EXPECT_EQ(near, (std::vector<uint32_t>{1, 2, 3})) << "the grid is made again";
  ExpectSameDetection(found.detections[0], frame->detections[0]);
}

TEST_F(MapFileTest, KeepsWhatDumpDoesNotShow) {
  const Map map = SmallMap();
  const Map read = ReadBack(map);
  EXPECT_EQ(Dump(read), Dump(map));
  EXPECT_EQ(read.sessions(), map.sessions());
  EXPECT_EQ(read.correction_count(), 1u);
  EXPECT_EQ(read.landmarks().FreeIds(), map.landmarks().FreeIds());
  EXPECT_EQ(read.objects().NextId(), map.objects().NextId());
  EXPECT_EQ(read.keyframes().NextId(), map.keyframes().NextId());
  const ObjectLandmark& cup = read.objects().At(ObjectId(1));
  EXPECT_EQ(cup.misfit_px, 1.25);
  EXPECT_EQ(cup.compensated_px, 0.75);
}

// A map with these counters of everything that is seen.
Map MapSeenOften(int times) {
  const Map small = SmallMap();
  Map map = SmallMap();
  for (const auto& [id, landmark] : small.landmarks()) {
    map.MutableLandmark(id).visible = times;
    map.MutableLandmark(id).found = times;
  }
  ObjectLandmark& cup = map.MutableObject(ObjectId(1));
  cup.visible = cup.found = times;
  cup.shaped_views = static_cast<size_t>(times);
  return map;
}

// Counters of a map that was loaded are counted up and written again.
TEST_F(MapFileTest, CountersStayAtTheLargestOneThatCanBeRead) {
  constexpr int kMost = 1 << 29;
  EXPECT_NE(Dump(MapSeenOften(kMost)), Dump(MapSeenOften(kMost - 1)));
  for (const int times : {kMost - 1, kMost, kMost + 1, std::numeric_limits<int>::max()}) {
    const Map read = ReadBack(MapSeenOften(times));
    EXPECT_EQ(Dump(read), Dump(MapSeenOften(std::min(times, kMost)))) << times;
    EXPECT_EQ(read.objects().At(ObjectId(1)).shaped_views,
              static_cast<size_t>(std::min(times, kMost)));
  }
}

TEST_F(MapFileTest, KeepsIslandsApart) {
  const Map map = MapOfTwoIslands();
  const Map read = ReadBack(map);
  EXPECT_EQ(Dump(read), Dump(map));
  EXPECT_EQ(Islands(read), (std::vector<IslandId>{IslandId(0), IslandId(1)}));
}

// Files of earlier runs must stay readable as long as the version of the format is the same.
TEST_F(MapFileTest, ReadsAFileOfThisVersion) {
  const std::filesystem::path file = SourceFolder() / "tests/fuzz/corpus/map/small.map";
  EXPECT_EQ(Dump(ReadMap(file).map), Dump(SmallMap()));
  const Map islands = ReadMap(SourceFolder() / "tests/fuzz/corpus/map/two_islands.map").map;
  EXPECT_EQ(Islands(islands).size(), 2u) << "a start of the search for faults";
}

TEST_F(MapFileTest, KeepsItsSettings) {
  MapSettings settings = MadeSettings();
  settings.camera.k1 = 0.01;
  settings.level_count = 5;
  settings.scale_factor = 1.5;
  settings.vocabulary = 0x1234567890abcdef;
  WriteMap(path_, SmallMap(), settings);
  EXPECT_EQ(ReadMap(path_).settings, settings);
  SystemOptions options = OptionsOf(settings);
  settings.vocabulary = 0;
  EXPECT_EQ(MapSettingsOf(options), settings);
  options.readout_time = 0.02;
  EXPECT_EQ(MapSettingsOf(options), settings) << "frames with and without it fit together";
}

TEST_F(MapFileTest, KeepsTheLens) {
  MapSettings rational = MadeSettings();
  rational.camera.k4 = 0.1;
  rational.camera.k6 = -0.02;
  MapSettings fisheye = MadeSettings();
  fisheye.camera.lens = LensModel::kKannalaBrandt;
  fisheye.camera.k4 = 0.001;
  MapSettings sphere = MadeSettings();
  sphere.camera.k1 = sphere.camera.k2 = sphere.camera.p1 = sphere.camera.p2 = sphere.camera.k3 =
      0.0;
  sphere.camera.lens = LensModel::kDoubleSphere;
  sphere.camera.xi = -0.2;
  sphere.camera.alpha = 0.6;
  MapSettings unified = sphere;
  unified.camera.lens = LensModel::kExtendedUnified;
  unified.camera.xi = 0.0;
  unified.camera.beta = 1.1;
  for (const MapSettings& settings : {rational, fisheye, sphere, unified}) {
    WriteMap(path_, SmallMap(), settings);
    EXPECT_EQ(ReadMap(path_).settings, settings);
    EXPECT_EQ(Dump(ReadMap(path_).map), Dump(SmallMap()));
    SystemOptions other = OptionsOf(settings);
    other.camera.lens = LensModel::kBrown;
    other.camera.k4 = 0.0;
    other.camera.xi = other.camera.alpha = 0.0;
    other.camera.beta = 1.0;
    EXPECT_THROW(ReadMap(path_, other), InputError);
  }
}

// A map file may come from a stranger, or from a program that did not check its labels.
TEST_F(MapFileTest, LabelsAreMadePrintable) {
  Map map;
  const auto frame = FullFrame(0, 1.0);
  frame->detections = {FullDetection(), FullDetection()};
  frame->detections[0].label = "cup\x1b[2J";
  frame->detections[1].label = "cup\x02[2J";
  const KeyframeId a = map.AddKeyframe(frame, {});
  const auto next = FullFrame(1, 2.0);
  next->detections = {frame->detections[1]};
  const KeyframeId b = map.AddKeyframe(next, {});
  SetParent(map, b, a);
  const ObjectId object = map.AddObject();
  map.AddObservation(object, a, 0);
  map.AddObservation(object, b, 0);
  const Map read = ReadBack(map);
  EXPECT_EQ(read.keyframes().At(a).frame->detections[1].label, "cup?[2J");
  EXPECT_EQ(read.objects().At(object).votes, (std::map<std::string, double>{{"cup?[2J", 1.625}}));
}

TEST_F(MapFileTest, NamesLocksAndSizesAreKept) {
  Map map = SmallMap();
  const std::string without = Written(map);
  map.MutableObject(ObjectId(1)).name = "Lisa's cup \xc3\xbc";
  const std::string named = Written(map);
  EXPECT_EQ(named.size(), without.size() + 4 + 13) << "length and bytes of the name";
  EXPECT_EQ(ReadMap(path_).map.objects().At(ObjectId(1)).name, "Lisa's cup \xc3\xbc");
  EXPECT_FALSE(ReadMap(path_).map.objects().At(ObjectId(1)).is_locked);
  map.MutableObject(ObjectId(1)).is_locked = true;
  EXPECT_EQ(Written(map).size(), named.size());
  map.MutableObject(ObjectId(1)).known_size = 0.465;
  EXPECT_EQ(Written(map).size(), named.size() + 8) << "one number, at the end of the object";
  const Map read = ReadBack(map);
  EXPECT_TRUE(read.objects().At(ObjectId(1)).is_locked);
  EXPECT_EQ(read.objects().At(ObjectId(1)).known_size, 0.465);
  EXPECT_EQ(Written(read), Written(map));
}

// ---- refusals

TEST_F(MapFileTest, NamesSizesAndStatesThatCannotBeAreRefused) {
  for (const std::string& name :
       {std::string(101, 'a'), std::string("a\nb"), std::string("\xff")}) {
    Map map = SmallMap();
    map.MutableObject(ObjectId(1)).name = name;
    ExpectRefusal(Written(map), {"name"});
  }
  for (const double size : {1e-4, 100.5, HUGE_VAL}) {
    Map map = SmallMap();
    map.MutableObject(ObjectId(1)).known_size = size;
    ExpectRefusal(Written(map), {"known size", "0.001 to 100 m"});
  }
  Map map = SmallMap();
  const std::string free = Written(map);
  map.MutableObject(ObjectId(1)).is_locked = true;
  const std::string locked = Written(map);
  ASSERT_EQ(locked.size(), free.size());
  const auto state = static_cast<size_t>(
      std::mismatch(free.begin(), free.end(), locked.begin()).first - free.begin());
  std::string bad = locked;
  bad[state] = 16;
  ExpectRefusal(WithChecksum(bad), {"state"});
  const size_t end = bad.size();
  bad[state] = static_cast<char>(locked[state] | 2);  // but no name follows
  ExpectRefusal(WithChecksum(bad));
  EXPECT_EQ(bad.size(), end);
}

TEST_F(MapFileTest, OtherSettingsAreRefused) {
  WriteMap(path_, SmallMap(), MadeSettings());
  EXPECT_EQ(ReadMap(path_, OptionsOf(MadeSettings())).keyframes().size(), 2u);
  const auto refuse = [&](const auto& change, const std::vector<std::string>& parts) {
    SystemOptions other = OptionsOf(MadeSettings());
    change(other);
    ExpectInputError([&] { ReadMap(path_, other); }, parts);
  };
  refuse([](SystemOptions& o) { o.camera.fy = 502.0; },
         {path_.string(), "Camera.fy 501", "the settings say 502"});
  refuse([](SystemOptions& o) { o.camera.width = 320; }, {"Camera.width 640", "320"});
  refuse([](SystemOptions& o) { o.camera.k2 = 1e-4; }, {"Camera.k2 0", "1e-04"});
  refuse([](SystemOptions& o) { o.features.level_count = 7; }, {"ORBextractor.nLevels 8", "7"});
  refuse([](SystemOptions& o) { o.features.scale_factor = 1.3; },
         {"ORBextractor.scaleFactor 1.2", "1.3"});
  refuse([](SystemOptions& o) { o.sensor = SensorKind::kMonocular; },
         {path_.string(), "an RGB-D camera", "a monocular"});
  const std::shared_ptr<const Vocabulary> vocabulary = SharedVocabulary();
  refuse([&](SystemOptions& o) { o.vocabulary = vocabulary; },
         {"vocabulary 0000000000000000", fmt::format("{:016x}", vocabulary->hash())});
}

TEST_F(MapFileTest, AMonocularMapStaysOne) {
  MapSettings settings = MadeSettings();
  settings.sensor = SensorKind::kMonocular;
  WriteMap(path_, SmallMap(), settings);
  EXPECT_EQ(ReadMap(path_).settings.sensor, SensorKind::kMonocular);
  ExpectInputError([&] { ReadMap(path_, OptionsOf(MadeSettings())); },
                   {"a monocular camera", "an RGB-D"});
}

TEST_F(MapFileTest, EveryFlippedByteIsRefused) {
  const std::string good = Written(SmallMap());
  for (size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << i % 8));
    ExpectRefusal(bad);
  }
}

TEST_F(MapFileTest, ATruncatedFileIsRefused) {
  const std::string good = Written(SmallMap());
  for (size_t i = 0; i < 16; ++i) {
    ExpectRefusal(good.substr(0, i * good.size() / 16));
  }
  ExpectRefusal(good.substr(0, 14), {"cut off"});
  ExpectRefusal(good.substr(0, good.size() - 1), {"damaged or cut off"});
  ExpectRefusal(good + '\0', {"damaged or cut off"});
}

TEST_F(MapFileTest, OtherFilesAndVersionsAreRefused) {
  ExpectRefusal("", {"is not a map"});
  ExpectRefusal("1.0 0 0 0 0 0 0 1\n", {"is not a map"});
  std::string bytes = Written(SmallMap());
  bytes[10] = 4;
  ExpectRefusal(WithChecksum(bytes), {"format version 4", "expected 3"});
  bytes[10] = 2;
  ExpectRefusal(WithChecksum(bytes), {"format version 2", "expected 3"});
  ExpectInputError([&] { ReadMap(folder_.path()); }, {folder_.path().string(), "regular file"});
  ExpectInputError([&] { ReadMap("/dev/null"); }, {"/dev/null", "regular file"});
  ExpectInputError([&] { ReadMap(folder_.path() / "none.map"); },
                   {"none.map", "No such file or directory"});
}

TEST_F(MapFileTest, AMapWithoutKeyframesIsRefused) {
  ExpectInputError([&] { WriteMap(path_, Map(), MadeSettings()); },
                   {path_.string(), "has no keyframe"});
  EXPECT_FALSE(std::filesystem::exists(path_));
  std::string bytes = Written(SmallMap());
  ASSERT_EQ(bytes[kCounts], 2);
  bytes[kCounts] = 0;
  ExpectRefusal(WithChecksum(bytes), {"has no keyframes"});
}

// The numbers of keyframes, culled keyframes, landmarks, landmark slots, objects and object ids. An
// entity takes at least 64 bytes.
TEST_F(MapFileTest, MoreEntitiesThanTheFileHasRoomForAreRefused) {
  const std::string good = Written(SmallMap());
  const auto with_counts = [&](const std::vector<size_t>& numbers, uint32_t value) {
    std::string bytes = good;
    for (const size_t number : numbers) {
      for (size_t i = 0; i < 4; ++i) {
        bytes[kCounts + 4 * number + i] = static_cast<char>(value >> (8 * i) & 0xff);
      }
    }
    return WithChecksum(bytes);
  };
  const auto too_many = static_cast<uint32_t>(good.size() / 64);
  for (const std::vector<size_t>& numbers :
       {std::vector<size_t>{0}, std::vector<size_t>{1}, std::vector<size_t>{2, 3},
        std::vector<size_t>{4, 5}}) {
    ExpectRefusal(with_counts(numbers, too_many), {"fewer entities than its header says"});
  }
  ExpectRefusal(with_counts({1}, 0xffffffff), {"fewer entities than its header says"});
}

// Entities hardly take more bytes than that.
TEST_F(MapFileTest, AMapOfManySmallEntitiesIsRead) {
  Map map;
  auto frame = MakeFrame(0, 1);
  frame->detections.clear();
  const KeyframeId first = map.AddKeyframe(frame, {});
  for (uint32_t i = 1; i < 2000; ++i) {
    auto other = MakeFrame(i, 0);
    other->detections.clear();
    const KeyframeId id = map.AddKeyframe(other, {});
    SetParent(map, id, first);
    map.CullKeyframe(id);
  }
  EXPECT_EQ(Dump(ReadBack(map)), Dump(map));
}

// Wrong bytes must not crash the reader even if the checksum is right. Most of them only change a
// number.
TEST_F(MapFileTest, AnyBytesBelowTheChecksumAreReadOrRefused) {
  const std::string file = Written(SmallMap());
  const std::string good = file.substr(14, file.size() - 14 - 4);
  RandomGeometry random(1);
  int refused = 0;
  for (size_t i = 0; i < 4 * good.size(); ++i) {
    std::string bad = good;
    bad[i / 4] = static_cast<char>(random.Index(256));
    std::istringstream in(bad);
    try {
      const Map map = ParseMap(in, bad.size(), "map", nullptr).map;
      EXPECT_EQ(FindViolations(map), std::vector<std::string>());
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(MapFileTest, AnInconsistentMapIsRefused) {
  Map map = SmallMap();
  map.MutableCulledKeyframe(KeyframeId(1)).pose.reference = KeyframeId(1);
  ExpectRefusal(Written(map), {"is not consistent", "keyframe 1"});
}

TEST_F(MapFileTest, PosesAndScalesThatCannotBeAreRefused) {
  const auto refuse = [&](const auto& change) {
    Map map = SmallMap();
    change(map);
    ExpectRefusal(Written(map), {"out of range"});
  };
  const Rigid3 far{Eigen::Quaterniond::Identity(), {0.0, -1e12, 0.0}};
  refuse([&](Map& map) { map.SetPose(KeyframeId(2), far); });
  refuse([&](Map& map) { map.MutableCulledKeyframe(KeyframeId(1)).pose.cam_from_reference = far; });
  refuse([&](Map& map) { map.MutableObject(ObjectId(1)).ellipsoid.world_from_object = far; });
  refuse([](Map& map) { map.MutableObject(ObjectId(1)).ellipsoid.half_axes.y() = 1e12; });
  refuse([](Map& map) { map.MutableKeyframe(KeyframeId(0)).scale = 1e-100; });
  refuse([](Map& map) { map.MutableKeyframe(KeyframeId(0)).scale = 1e12; });
}

// A run that goes on with a map needs free slots for its landmarks.
TEST_F(MapFileTest, AMapWithoutRoomForLandmarksIsRefused) {
  std::string bytes = Written(SmallMap());
  ASSERT_EQ(bytes[kCounts + 12], 3) << "landmark slots";
  bytes.replace(kCounts + 12, 4, std::string("\xff\xff\xff\x00", 4));
  ExpectRefusal(WithChecksum(bytes), {"too many landmarks"});
}

TEST_F(MapFileTest, ReadingCanBeCancelled) {
  const std::string bytes = Written(SmallMap());
  Cancellation cancellation;
  EXPECT_NO_THROW(ReadMap(path_, OptionsOf(MadeSettings()), &cancellation));
  cancellation.Request();
  EXPECT_THROW(ReadMap(path_, OptionsOf(MadeSettings()), &cancellation), ReadingCancelled);
  constexpr size_t kPrefix = 14;
  std::istringstream records(bytes.substr(kPrefix, bytes.size() - kPrefix - 4));
  EXPECT_THROW(ParseMap(records, records.str().size(), "map", nullptr, nullptr, &cancellation),
               ReadingCancelled);
}

// ---- writing

TEST_F(MapFileTest, AFullDiskLeavesTheOldFile) {
  const std::string good = Written(SmallMap());
  {
    const FileSizeLimit limit(1000);
    ExpectInputError([&] { WriteMap(path_, SmallMap(), MadeSettings()); },
                     {path_.string(), "cannot be written", "File too large"});
  }
  EXPECT_EQ(ReadFile(path_), good);
}

TEST_F(MapFileTest, AKilledWriterLeavesTheOldOrTheNewFile) {
  RandomEdits edits(3);
  const Map large = EditedMap(edits, 300);
  const Map small = SmallMap();
  const std::array<std::string, 2> whole = {Written(large), Written(small)};
  RandomGeometry random(7);
  std::array<int, 2> found{};
  // On a busy computer it takes more attempts until both files have been found.
  const auto has_both = [&] { return found[0] > 0 && found[1] > 0; };
  for (int kill = 0; kill < 50 || (kill < 1000 && !has_both()); ++kill) {
    const pid_t process = ::fork();
    if (process == 0) {
      while (true) {
        WriteMap(path_, large, MadeSettings());
        WriteMap(path_, small, MadeSettings());
      }
    }
    ::usleep(200 + random.Index(10'000));
    ::kill(process, SIGKILL);
    int status = 0;
    ::waitpid(process, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    const std::string bytes = ReadFile(path_);
    ASSERT_TRUE(bytes == whole[0] || bytes == whole[1]) << kill;
    ++found[bytes == whole[0] ? 0 : 1];
  }
  EXPECT_TRUE(has_both()) << "every killed process left the same one of the two maps";
  Written(small);  // removes what the killed processes have left
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

// ---- MapSaver

TEST_F(MapFileTest, ASaverWritesTheMapWhenItIsTime) {
  const auto map = std::make_shared<const Map>(SmallMap());
  const std::string whole = Written(*map);
  std::filesystem::remove(path_);
  {
    MapSaver saver(path_, MadeSettings(), 3600.0, [](const std::string&) {});
    saver.Offer(map);
  }
  EXPECT_FALSE(std::filesystem::exists(path_)) << "it is not time yet";
  {
    MapSaver saver(path_, MadeSettings(), 0.0, [](const std::string&) {});
    saver.Offer(nullptr);
    saver.Offer(std::make_shared<const Map>());
    while (!std::filesystem::exists(path_)) {
      saver.Offer(map);
    }
  }
  EXPECT_EQ(ReadFile(path_), whole);
}

TEST_F(MapFileTest, ASaverWithAFullDiskKeepsTheLastMapAndGoesOn) {
  const auto map = std::make_shared<const Map>(SmallMap());
  const std::string whole = Written(*map);
  std::atomic<int> failures = 0;
  MapSaver saver(path_, MadeSettings(), 0.0, [&](const std::string& reason) {
    EXPECT_NE(reason.find("File too large; the run goes on"), std::string::npos) << reason;
    ++failures;
  });
  for (int times = 1; times <= 2; ++times) {
    {
      const FileSizeLimit limit(1000);
      while (failures < times) {
        saver.Offer(map);
      }
    }
    EXPECT_EQ(ReadFile(path_), whole);
    std::filesystem::remove(path_);
    while (!std::filesystem::exists(path_)) {
      saver.Offer(map);
    }
  }
}

TEST_F(MapFileTest, ASaverTellsTheSameReasonOnce) {
  const auto map = std::make_shared<const Map>(SmallMap());
  std::atomic<int> failures = 0;
  {
    const FileSizeLimit limit(1000);
    MapSaver saver(path_, MadeSettings(), 0.0, [&](const std::string&) { ++failures; });
    for (int offers = 0; offers < 100; ++offers) {
      saver.Offer(map);
      while (map.use_count() > 1) {  // until it was tried to write the map
        std::this_thread::yield();
      }
    }
  }
  EXPECT_EQ(failures, 1);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace hullslam
