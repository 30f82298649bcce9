// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <opencv2/core.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "bow/vocabulary_builder.h"
#include "files/npy_file.h"
#include "files/read_file.h"
#include "fuzz/fuzzed_input.h"
#include "fuzz/fuzzed_masks.h"
#include "fuzz/readers.h"
#include "hullslam/eval/ate.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/settings/preset.h"
#include "hullslam/settings/settings.h"
#include "images/image_file.h"
#include "map/keyframe_graph.h"
#include "map_files/invariants.h"
#include "map_files/map_records.h"
#include "map_files/vocabulary_text.h"
#include "masks/mask_classes.h"
#include "results/finished_run.h"
#include "results/object_file.h"
#include "results/ply_file.h"
#include "results/pose_file.h"
#include "results/scene_file.h"
#include "results/true_body_file.h"
#include "results/true_object_file.h"
#include "segmentation/candidate.h"
#include "segmentation/class_names.h"
#include "segmentation/instance_outline.h"
#include "segmentation/network_layout.h"
#include "segmentation/onnx_file.h"

namespace hullslam {
namespace {

void FuzzTrajectory(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const Trajectory trajectory = ReadTrajectory(path);
    const std::string text = FormatTrajectory(trajectory);
    Expect(text.find("nan") == std::string::npos && text.find("inf") == std::string::npos,
           "a pose that is not finite");
    for (const StampedPose& pose : trajectory) {
      Expect(std::abs(pose.world_from_cam.rotation.norm() - 1.0) < 1e-9, "not normalised");
    }
  });
}

void FuzzPoseFile(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const PoseFile file = ReadPoseFile(path);
    Expect(!file.poses.empty(), "no poses");
    Expect(FormatTrajectory(file.poses).find("nan") == std::string::npos, "not finite");
    for (size_t i = 0; i + 1 < file.poses.size(); ++i) {
      Expect(file.poses[i].timestamp < file.poses[i + 1].timestamp, "stamps out of order");
    }
  });
}

void FuzzSettings(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const SystemOptions options = ReadSettings(path);
    Expect(options.camera.FindFault().empty(), "a camera with a fault");
    Expect(!FormatSettings(options).empty(), "no settings");
  });
}

void FuzzPreset(std::string_view bytes) {
  static const InputFolder folder("preset.yaml");
  folder.Write(bytes);
  Try([&] {
    SystemOptions options;
    ApplyPreset(ReadPreset(folder.path() / "preset.yaml"), options);
    Expect(!FormatSettings(options).empty(), "no settings");
  });
}

void FuzzGreyImage(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const cv::Mat image = ReadGreyImage(path);
    Expect(image.type() == CV_8UC1 && !image.empty() && image.total() <= 64'000'000, "the image");
  });
}

void FuzzDepthImage(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const cv::Mat image = ReadDepthImage(path);
    Expect(image.type() == CV_16UC1 && !image.empty() && image.total() <= 64'000'000, "the image");
  });
}

void FuzzObjects(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const ObjectResults report = ReadObjects(path, path);
    const std::string text = FormatObjects(report) + FormatObservations(report);
    Expect(text.find("null,null,null") == std::string::npos, "a number that is not finite");
  });
}

void FuzzPlyPoints(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const PlyPoints points = ReadPlyPoints(path);
    Expect(points.positions.size() == points.colours.size(), "one colour per position");
    for (const Eigen::Vector3f& position : points.positions) {
      Expect(position.allFinite(), "a position that is not finite");
    }
  });
}

void FuzzPlySurface(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const PlySurface surface = ReadPlySurface(path);
    Expect(surface.positions.size() == surface.colours.size(), "one colour per position");
    for (const TriangleMesh::Triangle& triangle : surface.triangles) {
      Expect(std::ranges::max(triangle) < surface.positions.size(), "a corner without a position");
    }
  });
}

void FuzzSummary(std::string_view bytes) {
  static const InputFolder folder("summary.json");
  folder.Write(bytes);
  Try([&] {
    const FinishedRun run = OpenFinishedRun(folder.path());
    Expect(run.summary != nullptr, "no summary");
  });
}

void FuzzScene(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const std::string text = FormatScene(ReadScene(path));
    Expect(text.find("null,null,null") == std::string::npos, "a number that is not finite");
  });
}

void FuzzTrueObjects(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const TrueScene scene = ReadTrueScene(path);
    for (const TrueObject& object : scene.objects) {
      Expect(std::isfinite(object.Size()) && object.Size() > 0.0, "the size of an object");
      Expect(object.status.has_value() == scene.is_rearranged, "the status of an object");
    }
  });
}

void ReadAndCheckTrueBodies(const fs::path& path) {
  Try([&] {
    const std::vector<TrueBody> truths = ReadTrueBodies(path);
    Expect(!truths.empty(), "no bodies");
    const Body& first = truths.front().body;
    for (const TrueBody& truth : truths) {
      Expect(truth.body.half_axes.minCoeff() > 0.0 && truth.body.half_axes.allFinite(),
             "no length");
      const double overlap = BoxOverlap(first, truth.body);
      const double solid = SolidOverlap(first, truth.body);
      Expect(overlap >= 0.0 && overlap <= 1.0 && solid >= 0.0 && solid <= 1.0, "no share");
    }
  });
}

// Also the scene_gt.json of a scene of BOP.
void FuzzTrueBodies(std::string_view bytes) {
  static const InputFolder folder("scene_gt.json", "scene_camera.json", "models_info.json");
  folder.Write(bytes);
  ReadAndCheckTrueBodies(folder.path() / "scene_gt.json");
}

// A file of Cube-Diorama.
void FuzzTrueBodyText(std::string_view bytes) {
  static const InputFolder folder("0.txt");
  folder.Write(bytes);
  ReadAndCheckTrueBodies(folder.path());
}

void FuzzNpy(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const FloatRows rows = ReadNpy(path);
    Expect(rows.values.size() == rows.rows * rows.columns, "another size than its shape");
  });
}

// The file of a frame, without the name of a format.
void FuzzMaskProbe(std::string_view bytes) {
  TryMaskFile(bytes, "");
  TryMaskFolder(bytes, "1.5.txt", "");
}

void FuzzClasses(std::string_view bytes) {
  static const InputFolder folder("classes.txt");
  folder.Write(bytes);
  Try([] { Expect(!ReadClasses(folder.path()).empty(), "no classes"); });
}

void FuzzYoloSeg(std::string_view bytes) { TryMaskFolder(bytes, "1.5.txt", "yolo-seg"); }
void FuzzPaper(std::string_view bytes) { TryMaskFolder(bytes, "000000.txt", "paper"); }
void FuzzBoxes(std::string_view bytes) { TryMaskFolder(bytes, "1.5.txt", "boxes"); }
void FuzzCoco(std::string_view bytes) { TryMaskFile(bytes, "coco"); }
void FuzzOaSlam(std::string_view bytes) { TryMaskFile(bytes, "oa-slam"); }

void FuzzJsonFolder(std::string_view bytes) { TryMaskFolder(bytes, "1.5.json", "json"); }

void FuzzLabelPng(std::string_view bytes) {
  static const InputFolder folder("1.5.png", "classes.json");
  folder.Write(bytes);
  TryMasks(folder.path(), "label-png");
}

// The classes of a label image with the instances 1 and 2.
void FuzzClassesJson(std::string_view bytes) {
  static const InputFolder folder("classes.json", "1.5.png");
  folder.Write(bytes);
  TryMasks(folder.path(), "label-png");
}

// Uses every part of a vocabulary that was read.
void UseVocabulary(const Vocabulary& vocabulary) {
  const std::vector<WordId> words = vocabulary.WordsOf(vocabulary.descriptors());
  for (const WordId word : words) {
    Expect(word.value < vocabulary.word_count(), "a word that does not exist");
  }
  const BowVector vector = vocabulary.VectorOf(words);
  Expect(std::isfinite(Score(vector, vector)), "a score that is not finite");
  vocabulary.NodesOf(words, vocabulary.levels() - 1);
  const std::string text = FormatVocabularyText(vocabulary);
  Expect(ParseVocabularyText(text, "again", {}).hash() == vocabulary.hash(),
         "another vocabulary after writing and reading");
}

// The hash is made to fit, so that the search gets past it.
void FuzzVocabularyBinary(std::string_view bytes) {
  std::string content(bytes);
  if (content.size() >= sizeof(VocabularyHeader)) {
    const uint64_t hash = HashVocabulary(std::as_bytes(std::span(content)));
    std::memcpy(content.data() + offsetof(VocabularyHeader, hash), &hash, sizeof(hash));
  }
  TryFile(content, [](const fs::path& path) { UseVocabulary(ReadVocabulary(path)); });
}

void FuzzVocabularyText(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) { UseVocabulary(ReadVocabulary(path)); });
}

// Edits a map as a new session does.
void UseMap(Map& map) {
  map.BeginSession({"next", map.NextFrame()});
  auto frame = std::make_shared<Frame>();
  frame->id = map.NextFrame();
  const KeyframeId added = map.AddKeyframe(frame, {}, map.BeginIsland());
  Expect(map.KeyframeOfFrame(frame->id) == added, "a frame that is not found");
  std::vector<KeyframeId> keyframes;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe&) { keyframes.push_back(id); });
  map.culled().ForEach([&](KeyframeId id, const CulledKeyframe&) {
    map.CamFromWorld(id);
    map.ScaleOf(id);
  });
  for (const KeyframeId id : keyframes) {
    UpdateCovisibility(map, id);
    if (map.keyframes().At(id).parent.IsValid()) {
      map.CullKeyframe(id);
    }
  }
  for (int i = 0; i < 3; ++i) {
    map.AddLandmark({0.0, 0.0, 1.0}, added);
    map.AddObject();
  }
  Expect(FindViolations(map).empty(), "an inconsistent map after edits");
}

// Map files below the checksum: the bytes are those of a map file, whose first bytes and checksum
// are not looked at. A map that is accepted must be usable, and give
// the same bytes again.
void FuzzMap(std::string_view bytes) {
  constexpr size_t kPrefix = 14;
  constexpr size_t kChecksum = 4;
  if (bytes.size() < kPrefix + kChecksum) {
    return;
  }
  Try([&] {
    const std::string content(bytes.substr(kPrefix, bytes.size() - kPrefix - kChecksum));
    std::istringstream in(content);
    StoredMap stored = ParseMap(in, content.size(), "map", nullptr);
    Expect(FindViolations(stored.map).empty(), "an inconsistent map");
    static const InputFolder folder("unused");
    WriteMap(folder.path() / "first", stored.map, stored.settings);
    const StoredMap again = ReadMap(folder.path() / "first");
    WriteMap(folder.path() / "second", again.map, again.settings);
    Expect(ReadFile(folder.path() / "first") == ReadFile(folder.path() / "second"),
           "other bytes when it is written again");
    UseMap(stored.map);
  });
}

// Also the names of the classes, which stand in the metadata.
void FuzzOnnx(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const OnnxFile file = ReadOnnx(path);
    Expect(!file.inputs.empty() && !file.outputs.empty(), "a network without inputs or outputs");
    for (const auto& [key, value] : file.metadata) {
      const auto names = ParseClassNames(value);
      Expect(!names || !names->empty(), "a dictionary without names");
    }
    for (const OnnxValue& value : file.inputs) {
      Expect(!DescribeShape(value.shape).empty() || value.shape.empty(), "no shape");
    }
  });
}

// An output whose values are the bytes, again and again, each as the logit of its sixteenth.
NetworkOutput MakeOutput(std::string_view bytes, const std::vector<int>& shape) {
  NetworkOutput output{.name = "output", .values = cv::Mat(shape, CV_32F)};
  auto* const values = output.values.ptr<float>();
  for (size_t i = 0; i < output.values.total(); ++i) {
    values[i] = static_cast<float>(static_cast<signed char>(bytes[i % bytes.size()])) / 16.0F;
  }
  return output;
}

// The outputs of a network with 3 classes and 4 coefficients for an input of 64x96 px, in the
// layout that the first byte chooses. The second one is the exponent of the boxes of decoded ones.
void FuzzNetworkOutputs(std::string_view bytes) {
  if (bytes.size() < 3) {
    return;
  }
  constexpr int kCells = 8 * 12 + 4 * 6 + 2 * 3;
  const std::string_view rest = bytes.substr(2);
  const auto maps = [&](int channels) {
    return std::vector{MakeOutput(rest, {1, channels, 8, 12}),
                       MakeOutput(rest, {1, channels, 4, 6}),
                       MakeOutput(rest, {1, channels, 2, 3})};
  };
  const std::array<std::vector<NetworkOutput>, 4> layouts = {
      {{MakeOutput(rest, {1, 11, kCells})},
       {MakeOutput(rest, {1, 3 * kCells, 12})},
       maps(64 + 7),
       maps(3 * 12)}};
  std::vector<NetworkOutput> outputs = layouts[static_cast<unsigned char>(bytes[0]) % 4];
  if (outputs.size() == 1) {
    outputs[0].values *= std::ldexp(1.0, static_cast<signed char>(bytes[1]));
    outputs[0].values = cv::max(cv::min(outputs[0].values, 1e30), -1e30);
  }
  outputs.push_back(MakeOutput(rest, {1, 4, 16, 24}));
  const cv::Size input(96, 64);
  Try([&] {
    const NetworkLayout layout = RecogniseLayout(outputs, input, 3);
    const Letterbox letterbox = FitLetterbox({100, 50}, input);
    const std::vector<Candidate> found = SuppressOverlaps(
        layout.decode(layout, outputs, {.min_score = 0.25, .classes = std::vector<bool>(3, true)}));
    Expect(found.size() <= kMostInstances, "too many instances");
    for (const Candidate& candidate : found) {
      for (const auto& outline : {FindInstanceOutline(candidate, outputs.back().values, letterbox),
                                  BoxOutline(candidate, letterbox)}) {
        for (const Eigen::Vector2d& point : outline) {
          Expect(point.x() >= -0.5 && point.x() <= 99.5 && point.y() >= -0.5 && point.y() <= 49.5,
                 "an outline outside of the image");
        }
      }
    }
  });
}

constexpr auto kReaders = std::to_array<FuzzedReader>({{"trajectory", FuzzTrajectory},
                                                       {"pose_file", FuzzPoseFile},
                                                       {"settings", FuzzSettings},
                                                       {"preset", FuzzPreset},
                                                       {"grey_image", FuzzGreyImage},
                                                       {"depth_image", FuzzDepthImage},
                                                       {"objects", FuzzObjects},
                                                       {"ply_points", FuzzPlyPoints},
                                                       {"ply_surface", FuzzPlySurface},
                                                       {"true_objects", FuzzTrueObjects},
                                                       {"true_bodies", FuzzTrueBodies},
                                                       {"true_body_text", FuzzTrueBodyText},
                                                       {"summary", FuzzSummary},
                                                       {"scene", FuzzScene},
                                                       {"npy", FuzzNpy},
                                                       {"mask_probe", FuzzMaskProbe},
                                                       {"classes", FuzzClasses},
                                                       {"yolo_seg", FuzzYoloSeg},
                                                       {"paper", FuzzPaper},
                                                       {"boxes", FuzzBoxes},
                                                       {"coco", FuzzCoco},
                                                       {"json_folder", FuzzJsonFolder},
                                                       {"oa_slam", FuzzOaSlam},
                                                       {"label_png", FuzzLabelPng},
                                                       {"classes_json", FuzzClassesJson},
                                                       {"vocabulary_binary", FuzzVocabularyBinary},
                                                       {"vocabulary_text", FuzzVocabularyText},
                                                       {"map", FuzzMap},
                                                       {"onnx", FuzzOnnx},
                                                       {"network_outputs", FuzzNetworkOutputs}});

const KnownReaders kKnownReaders(kReaders);

}  // namespace
}  // namespace hullslam
