// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/object_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "hullslam/util/check.h"
#include "support/expect_error.h"
#include "support/fisheye_camera.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using Json = nlohmann::ordered_json;

ObservationResult MakeView(uint32_t keyframe) {
  ObservationResult observation;
  observation.keyframe = KeyframeId(keyframe);
  observation.timestamp = 1305031102.175304 + keyframe;
  observation.cam_from_world = Rigid3(ExpSo3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0});
  observation.label = "cup";
  observation.score = 0.75;
  observation.is_cut = true;
  observation.hull = {{10.123, 20.0}, {30.0, 20.0}, {30.0, 50.0}};
  observation.contour = {{10.123, 20.0}, {30.0, 20.0}, {30.0, 50.0}, {25.0, 30.0}};
  observation.lines = {{{Eigen::Vector2d(0.6, 0.8), -100.0}, false},
                       {{Eigen::Vector2d(-1.0, 0.0), 0.0}, true}};
  return observation;
}

ObjectResults MakeReport() {
  ObjectResults report;
  report.sequence = "data/fr1_xyz";
  report.camera.fx = 517.3;
  report.camera.fy = 516.5;
  report.camera.k1 = 0.2624;
  report.candidates = 4;
  ObjectResult object;
  object.id = ObjectId(7);
  object.state = ObjectState::kMapped;
  object.label = "cup";
  object.votes = {{"bowl", 0.5}, {"cup", 2.25}};
  object.ellipsoid = {Rigid3(ExpSo3({0.5, -0.2, 0.1}), {0.1, -0.2, 1.5}), {0.04, 0.05, 0.06}};
  object.misfit_px = 3.5;
  object.fit.siou = 0.8;
  object.fit.mtd_m2 = 1.25e-3;
  object.observations = {MakeView(2), MakeView(5)};
  report.objects = {object, object};
  report.objects[1].id = ObjectId(9);
  report.objects[1].state = ObjectState::kCandidate;
  return report;
}

TEST(ObjectFile, HasTheKeysOfTheFormat) {
  const Json json = Json::parse(FormatObjects(MakeReport()));
  EXPECT_EQ(json["version"], 2);
  EXPECT_EQ(json["sequence"], "data/fr1_xyz");
  EXPECT_EQ(json["camera"]["fx"], 517.3);
  EXPECT_EQ(json["candidates"], 4);
  ASSERT_EQ(json["objects"].size(), 2U);
  const Json& object = json["objects"][0];
  EXPECT_EQ(object["id"], 7);
  EXPECT_EQ(object["class"], "cup");
  EXPECT_EQ(object["votes"]["cup"], 2.25);
  EXPECT_EQ(object["state"], "mapped");
  EXPECT_EQ(object["half_axes"], Json({0.04, 0.05, 0.06}));
  EXPECT_EQ(object["siou"], 0.8);
  EXPECT_TRUE(object["siou_mask"].is_null());
  EXPECT_EQ(object["mtd_m2"], 1.25e-3);
  EXPECT_TRUE(object["tangent_px"].is_null());
  EXPECT_EQ(object["misfit_px"], 3.5);
  EXPECT_EQ(object["observations"], 2);

  const Json observations = Json::parse(FormatObservations(MakeReport()));
  EXPECT_EQ(observations["version"], 2);
  ASSERT_EQ(observations["observations"].size(), 4U);
  const Json& observation = observations["observations"][1];
  EXPECT_EQ(observation["object"], 7);
  EXPECT_EQ(observation["keyframe"], 5);
  EXPECT_EQ(observation["class"], "cup");
  EXPECT_EQ(observation["cut"], true);
  EXPECT_EQ(observation["box"], false);
  EXPECT_EQ(observation["hull"][0], Json({10.12, 20.0}));  // 0.01 px
  EXPECT_EQ(observation["lines"][1], Json({-1.0, 0.0, 0.0, 1}));
}

TEST(ObjectFile, NamesLocksAndSizesAreWrittenWhereThereAreAny) {
  const TemporaryFolder folder;
  ObjectResults report = MakeReport();
  report.objects[1].name = "Lisa's";
  report.objects[1].is_locked = true;
  report.objects[1].known_size = 0.465;
  const std::string text = FormatObjects(report);
  const Json json = Json::parse(text);
  EXPECT_FALSE(json["objects"][0].contains("name") || json["objects"][0].contains("locked"));
  EXPECT_EQ(json["objects"][1]["name"], "Lisa's");
  EXPECT_EQ(json["objects"][1]["locked"], true);
  EXPECT_FALSE(json["objects"][0].contains("known_size"));
  EXPECT_EQ(json["objects"][1]["known_size"], 0.465);
  folder.Write("objects_observations.json", FormatObservations(report));
  const ObjectResults read = ReadObjects(folder.Write("objects.json", text));
  EXPECT_EQ(read.objects[0].NameAtEnd(), "");
  EXPECT_EQ(read.objects[1].NameAtEnd(), "  Lisa's");
  EXPECT_TRUE(read.objects[1].is_locked);
  EXPECT_EQ(read.objects[0].known_size, 0.0);
  EXPECT_EQ(read.objects[1].known_size, 0.465);
}

TEST(ObjectFile, AnObjectOfTheSceneHasItsBoxAndItsFreeAxes) {
  Scene scene;
  SceneObject& body = scene.objects.emplace_back();
  body.id = ObjectId(7);
  body.box = UprightBox{Rigid3(Eigen::Quaterniond::Identity(), {0.1, 0.2, 0.3}), {0.4, 0.5, 0.6}};
  body.box->is_seen[5] = true;
  body.covariance.emplace().axes[1].is_round = true;
  const Json json = Json::parse(FormatObjects(MakeReport(), scene));
  const Json& object = json["objects"][0];
  EXPECT_EQ(object["box"]["centre"], Json({0.1, 0.2, 0.3}));
  EXPECT_EQ(object["box"]["half_extents"], Json({0.4, 0.5, 0.6}));
  EXPECT_EQ(object["box"]["sides_seen"], Json({false, false, false, false, false, true}));
  EXPECT_EQ(object["round_axes"], Json::array({"y"}));
  EXPECT_FALSE(json["objects"][1].contains("box")) << "a candidate";
}

// Masks of one camera may give a candidate without thickness; other programs, and the reader, need
// a length.
TEST(ObjectFile, AHalfAxisIsNeverRoundedToZero) {
  const TemporaryFolder folder;
  ObjectResults report = MakeReport();
  report.objects[1].ellipsoid.half_axes.x() = 1e-12;
  folder.Write("objects_observations.json", FormatObservations(report));
  const ObjectResults read = ReadObjects(folder.Write("objects.json", FormatObjects(report)));
  EXPECT_EQ(read.objects[1].ellipsoid.half_axes.x(), 1e-9);
}

TEST(ObjectFile, TheQuadricMatchesPoseAndAxes) {
  const ObjectResults report = MakeReport();
  const Json json = Json::parse(FormatObjects(report));
  const Eigen::Matrix4d expected = report.objects[0].ellipsoid.DualQuadric();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const size_t r = static_cast<size_t>(row);
      const size_t c = static_cast<size_t>(column);
      EXPECT_NEAR(json["objects"][0]["dual_quadric"][r][c].get<double>(), expected(row, column),
                  1e-9);
    }
  }
}

// Writes both files of a report and reads them.
ObjectResults WriteAndRead(const ObjectResults& report) {
  const TemporaryFolder folder;
  folder.Write("objects_observations.json", FormatObservations(report));
  return ReadObjects(folder.Write("objects.json", FormatObjects(report)));
}

TEST(ObjectFile, TheListOfObjectsStaysSmall) {
  ObjectResults report = MakeReport();
  const size_t few = FormatObjects(report).size();
  report.objects[0].observations.assign(2000, MakeView(3));
  EXPECT_LT(FormatObjects(report).size(), few + 10);
}

TEST(ObjectFile, TheTableHasOneLinePerObject) {
  ObjectResults report = MakeReport();
  report.objects[0].ellipsoid.world_from_object =
      Rigid3(Eigen::Quaterniond::Identity(), {0.5, -0.25, 1.5});
  report.objects[1].label = "a \"b\", c";
  report.objects[1].ellipsoid = report.objects[0].ellipsoid;
  EXPECT_EQ(FormatObjectsCsv(report),
            "id,class,state,observations,tx,ty,tz,qx,qy,qz,qw,half_axis_x,half_axis_y,half_axis_z,"
            "siou,siou_mask,mtd_m2,tangent_px,misfit_px,parallax_deg,quality\n"
            "7,cup,mapped,2,0.5,-0.25,1.5,0,0,0,1,0.04,0.05,0.06,0.8,,0.00125,,3.5,0,0\n"
            "9,\"a \"\"b\"\", c\",candidate,2,0.5,-0.25,1.5,0,0,0,1,0.04,0.05,0.06,0.8,,0.00125,,"
            "3.5,0,0\n");
}

// Classes come from files of others. The table is opened with a spreadsheet.
TEST(ObjectFile, TheTableIsValidTextWithoutFormulas) {
  const auto class_in_table = [](const std::string& label) {
    ObjectResults report = MakeReport();
    report.objects.resize(1);
    report.objects[0].label = label;
    const std::string table = FormatObjectsCsv(report);
    const size_t begin = table.find("\n7,") + 3;
    return table.substr(begin, table.find(",mapped") - begin);
  };
  EXPECT_EQ(class_in_table("=HYPERLINK(A1)"), "'=HYPERLINK(A1)");
  EXPECT_EQ(class_in_table("=A(\"x\")"), "\"'=A(\"\"x\"\")\"");
  EXPECT_EQ(class_in_table("+1"), "'+1");
  EXPECT_EQ(class_in_table("-1"), "'-1");
  EXPECT_EQ(class_in_table("@SUM"), "'@SUM");
  EXPECT_EQ(class_in_table("a=b-c"), "a=b-c");
  EXPECT_EQ(class_in_table("a\xff\nb"), "a??b");
}

TEST(ObjectFile, LabelsAreReadInPrintableCharacters) {
  ObjectResults report = MakeReport();
  report.objects[0].label = "cup\x1b[2J";
  report.objects[0].votes = {{"cup\x1b[2J", 2.0}};
  const ObjectResults read = WriteAndRead(report);
  EXPECT_EQ(read.objects[0].label, "cup?[2J");
  EXPECT_EQ(read.objects[0].votes.begin()->first, "cup?[2J");
}

TEST(ObjectFile, ReadingAndWritingGivesTheSameBytes) {
  const ObjectResults read = WriteAndRead(MakeReport());
  EXPECT_EQ(FormatObjects(read), FormatObjects(MakeReport()));
  EXPECT_EQ(FormatObservations(read), FormatObservations(MakeReport()));
  EXPECT_EQ(read.candidates, 4U);
  EXPECT_EQ(read.camera.k1, 0.2624);
  ASSERT_EQ(read.objects.size(), 2U);
  EXPECT_EQ(read.objects[1].state, ObjectState::kCandidate);
  EXPECT_EQ(read.objects[0].fit.siou, 0.8);
  EXPECT_FALSE(read.objects[0].fit.siou_mask);
  const ObservationResult expected = MakeView(5);
  const ObservationResult& observation = read.objects[0].observations.at(1);
  EXPECT_EQ(observation.keyframe, expected.keyframe);
  EXPECT_NEAR(observation.timestamp, expected.timestamp, 1e-6);
  EXPECT_LT(AngularDistance(observation.cam_from_world.rotation, expected.cam_from_world.rotation),
            1e-7);
  EXPECT_TRUE(observation.is_cut);
  EXPECT_TRUE(observation.lines.at(1).is_one_sided);
  EXPECT_NEAR(observation.lines[0].line.normal.x(), 0.6, 1e-9);
}

// The report of a run that went on with a map of earlier sessions.
ObjectResults MakeChangedReport() {
  ObjectResults report = MakeReport();
  const LocatedObject located = {ObjectId(7), report.objects[0].ellipsoid};
  ChangedObject moved{.change = ObjectChange::kMoved, .label = "cup", .expected = 12, .found = 1};
  moved.now = located;
  moved.former = LocatedObject{ObjectId(3), report.objects[0].ellipsoid};
  ChangedObject gone{.change = ObjectChange::kGone, .label = "book", .expected = 4, .found = 0};
  gone.former = located;
  report.changes = {moved, gone};
  return report;
}

TEST(ObjectFile, ChangesAreWrittenAndRead) {
  const ObjectResults report = MakeChangedReport();
  const Json json = Json::parse(FormatObjects(report));
  ASSERT_EQ(json["changes"].size(), 2U);
  EXPECT_EQ(json["changes"][0]["change"], "moved");
  EXPECT_EQ(json["changes"][0]["former"]["object"], 3);
  EXPECT_EQ(json["changes"][1]["class"], "book");
  EXPECT_TRUE(json["changes"][1]["now"].is_null());
  EXPECT_TRUE(Json::parse(FormatObjects(MakeReport()))["changes"].is_null());
  const ObjectResults read = WriteAndRead(report);
  EXPECT_EQ(FormatObjects(read), FormatObjects(report));
  EXPECT_FALSE(WriteAndRead(MakeReport()).changes);
}

TEST(ObjectFile, AMapWithoutObjectsGivesAValidFile) {
  ObjectResults empty;
  empty.camera = MakeReport().camera;
  const ObjectResults read = WriteAndRead(empty);
  EXPECT_TRUE(read.objects.empty());
  EXPECT_EQ(read.candidates, 0U);
}

TEST(ObjectFile, ClassesMayContainAnyBytes) {
  ObjectResults report = MakeReport();
  report.objects[0].label = "a\"b\\\xff\n";
  report.objects[0].votes = {{report.objects[0].label, 1.0}};
  EXPECT_TRUE(Json::accept(FormatObjects(report)));
}

TEST(ObjectFile, NonFiniteValuesAreNeverWritten) {
  ObjectResults report = MakeReport();
  report.objects[0].ellipsoid.half_axes.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FormatObjects(report), CheckError);
  report = MakeReport();
  report.objects[1].observations[0].hull[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(FormatObservations(report), CheckError);
}

// Expects that the files are refused if the value at `pointer` in one of them is replaced.
void ExpectRefusal(const std::string& pointer, const Json& value,
                   const std::vector<std::string>& parts) {
  Json objects = Json::parse(FormatObjects(MakeChangedReport()));
  Json observations = Json::parse(FormatObservations(MakeReport()));
  const bool is_observation = pointer.starts_with("/observations");
  (is_observation ? observations : objects)[Json::json_pointer(pointer)] = value;
  const TemporaryFolder folder;
  folder.Write("objects_observations.json", observations.dump());
  const auto path = folder.Write("objects.json", objects.dump());
  SCOPED_TRACE(pointer);
  ExpectInputError([&] { ReadObjects(path); }, parts);
}

TEST(ObjectFile, BrokenValuesAreReportedWithTheirPath) {
  const std::string object = "/objects/1/";
  const std::string observation = "/observations/2/";
  const std::string at = "objects_observations.json: observations[2].";
  ExpectRefusal("/version", 1, {"version is 1", "expected 2"});
  ExpectRefusal("/camera/fx", 0, {"objects.json: camera.fx is 0"});
  ExpectRefusal("/camera/width", 0, {"camera.width is 0", "1 to 16384"});
  ExpectRefusal("/camera/height", 1e6, {"camera.height"});
  ExpectRefusal("/camera/fx", 1e300, {"camera.fx is 1e+300"});
  ExpectRefusal("/camera/fx", 1e-300, {"camera is {", "Camera.fx is '1e-300'"});
  ExpectRefusal("/camera/k1", -5, {"camera is {", "Camera.k1 is '-5'"});
  ExpectRefusal("/candidates", -1, {"candidates is -1"});
  ExpectRefusal("/objects", "none", {"objects is \"none\"", "an array"});
  ExpectRefusal("/changes", 1, {"changes is 1", "an array"});
  ExpectRefusal("/changes/0/change", "lost", {"changes[0].change is \"lost\"", "seen_again"});
  ExpectRefusal("/changes/0/now/object", -1, {"changes[0].now.object is -1"});
  ExpectRefusal("/changes/1/former/half_axes", {1, 0, 1}, {"changes[1].former.half_axes"});
  ExpectRefusal("/changes/1/expected", "many", {"changes[1].expected is \"many\""});
  ExpectRefusal(object + "id", "x", {"objects[1].id is \"x\""});
  ExpectRefusal(object + "state", "lost", {"objects[1].state is \"lost\"", "mapped"});
  ExpectRefusal(object + "class", 3, {"objects[1].class is 3", "a string"});
  ExpectRefusal(object + "votes", {{"cup", "many"}}, {"objects[1].votes.cup is \"many\""});
  ExpectRefusal(object + "world_from_object", {0, 0, 0, 0, 0, 0, 0}, {"a quaternion of length 1"});
  ExpectRefusal(object + "half_axes", {1, 0, 1}, {"objects[1].half_axes is [1,0,1]", "> 0"});
  ExpectRefusal(object + "half_axes", {1, 1}, {"objects[1].half_axes"});
  ExpectRefusal(object + "siou", "good", {"objects[1].siou is \"good\""});
  ExpectRefusal(object + "observations", -1, {"objects[1].observations is -1"});
  ExpectRefusal(
      object + "observations", 3,
      {"objects_observations.json: has 2 observations of object 9, expected 3", "same run"});
  ExpectRefusal(observation + "object", 8, {at + "object is 8", "in objects.json"});
  ExpectRefusal(observation + "keyframe", 1.5, {at + "keyframe is 1.5"});
  ExpectRefusal(observation + "score", 1e308, {at + "score is 1e+308", "from -1 to 1"});
  ExpectRefusal(object + "votes", {{"cup", 1e308}}, {"objects[1].votes.cup is 1e+308"});
  ExpectRefusal(observation + "timestamp", nullptr, {at + "timestamp is null"});
  ExpectRefusal(observation + "cam_from_world", "I", {at + "cam_from_world is \"I\""});
  ExpectRefusal(observation + "cut", 1, {at + "cut is 1", "true or false"});
  ExpectRefusal(observation + "hull", {{1, 2}, {3, 4}}, {at + "hull", "three corners"});
  ExpectRefusal(observation + "hull", {{0, 0}, {0, 5}, {5, 5}}, {at + "hull", "positive area"});
  ExpectRefusal(observation + "contour", {{1, 2, 3}}, {at + "contour is [[1,2,3]]"});
  ExpectRefusal(observation + "lines", {{1, 1, 0, 0}},
                {at + "lines[0] is [1,1,0,0]", "unit length"});
  ExpectRefusal(observation + "lines", {{1, 0}}, {at + "lines[0]", "4 finite numbers"});
}

TEST(ObjectFile, KeepsTheLens) {
  for (const PinholeCamera& camera :
       {FisheyeCamera(), DoubleSphereCamera(), ExtendedUnifiedCamera()}) {
    ObjectResults report = MakeReport();
    report.camera = camera;
    EXPECT_EQ(WriteAndRead(report).camera, camera);
  }
  ExpectRefusal("/camera/type", "Omni", {"camera.type is \"Omni\"", "DoubleSphere, EUCM"});
}

TEST(ObjectFile, TruncatedAndMissingFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string text = FormatObjects(MakeReport());
  for (const size_t length : {size_t{0}, text.size() / 2, text.size() - 3}) {
    const auto path = folder.Write("objects.json", text.substr(0, length));
    ExpectInputError([&] { ReadObjects(path); }, {"objects.json: is no valid JSON"});
  }
  const auto path = folder.Write("objects.json", text);
  ExpectInputError([&] { ReadObjects(path); }, {"objects_observations.json: No such file"});
  const std::string observations = FormatObservations(MakeReport());
  folder.Write("objects_observations.json", observations.substr(0, observations.size() / 2));
  ExpectInputError([&] { ReadObjects(path); }, {"objects_observations.json: is no valid JSON"});
  ExpectInputError([&] { ReadObjects(folder.Write("empty.json", "{}")); },
                   {"empty.json: \"version\" is missing"});
  ExpectInputError([&] { ReadObjects(folder.path() / "none.json"); }, {"none.json"});
}

}  // namespace
}  // namespace hullslam
