// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/mask_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "support/expect_error.h"
#include "support/made_network.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

class MaskFolderTest : public testing::Test {
 protected:
  MaskFolderTest() { WriteImages("walk", {"b", "c"}, 128); }

  void WriteImages(const std::string& folder, const std::vector<std::string>& names,
                   int brightness) const {
    fs::create_directories(folder_.path() / folder);
    for (const std::string& name : names) {
      cv::imwrite((folder_.path() / folder / (name + ".png")).string(),
                  cv::Mat(96, 128, CV_8UC3, cv::Scalar::all(brightness)));
    }
  }

  fs::path WriteNetwork(const std::string& name, const MadeNetwork& network = {}) const {
    return folder_.Write(name, network.Bytes());
  }

  void Prepare(const fs::path& input, const fs::path& network,
               const SegmenterOptions& options = {}) const {
    const DatasetChoices choices;
    const ImageSequence sequence = OpenImages(input, choices);
    const Segmenter segmenter(network, options);
    PrepareMaskFolder(output_, {.input = input,
                                .choices = choices,
                                .sequence = sequence,
                                .network = network,
                                .options = options,
                                .segmenter = segmenter});
  }

  std::string Record() const {
    std::ifstream stream(output_ / "segment.json");
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  TemporaryFolder folder_;
  fs::path output_ = folder_.path() / "masks";
  fs::path walk_ = folder_.path() / "walk";
  fs::path network_ = WriteNetwork("net.onnx");
};

TEST_F(MaskFolderTest, AFolderThatGrowsIsTheSameInput) {
  Prepare(walk_, network_);
  const std::string record = Record();
  Prepare(walk_ / "", network_);
  WriteImages("walk", {"a", "d"}, 50);  // before and after the first one
  Prepare(walk_, network_);
  EXPECT_EQ(Record(), record);
}

TEST_F(MaskFolderTest, AnInputOfTheSameNameIsAnotherOne) {
  Prepare(walk_, network_);
  WriteImages("other/walk", {"b", "c"}, 128);
  ExpectInputError([&] { Prepare(folder_.path() / "other/walk", network_); },
                   {"masks", "input", "other/walk", "--output"});
  WriteImages("walk", {"b"}, 129);
  ExpectInputError([&] { Prepare(walk_, network_); }, {"frame", "\"b\""});
  fs::remove(walk_ / "b.png");
  ExpectInputError([&] { Prepare(walk_, network_); }, {"frame"});
}

TEST_F(MaskFolderTest, ANetworkOfTheSameNameAndSizeIsAnotherOne) {
  fs::create_directory(folder_.path() / "new");
  const fs::path other = WriteNetwork("new/net.onnx", {.bias = 1.0F});
  ASSERT_EQ(fs::file_size(other), fs::file_size(network_));
  Prepare(walk_, network_);
  ExpectInputError([&] { Prepare(walk_, other); }, {"masks", "network_hash"});
  // The same network under another name is no other one.
  const fs::path renamed = folder_.path() / "renamed.onnx";
  fs::copy(network_, renamed);
  Prepare(walk_, renamed);
  // Other names of the classes are other masks.
  const fs::path names = folder_.Write("names.txt", "cup\ntv\n");
  ExpectInputError([&] { Prepare(walk_, network_, {.names = names}); }, {"names"});
}

TEST_F(MaskFolderTest, WhatAKilledCallHasLeftIsNoFileOfTheUser) {
  folder_.Write("masks/.segment.json.abc123/lock", "");
  folder_.Write("masks/.segment.json.abc123/content/file", "{\"inp");
  Prepare(walk_, network_);
  EXPECT_TRUE(fs::exists(output_ / "classes.txt"));
  EXPECT_FALSE(fs::exists(output_ / ".segment.json.abc123"));
  fs::remove_all(output_);
  folder_.Write("masks/notes.txt", "mine");
  ExpectInputError([&] { Prepare(walk_, network_); }, {"contains files"});
}

TEST_F(MaskFolderTest, NamesOfFilesNeedNotBeUtf8) {
  const std::string name = "n\xff";
  WriteImages(name, {"b"}, 128);
  const fs::path network = WriteNetwork(name + ".onnx");
  Prepare(folder_.path() / name, network);
  EXPECT_NE(Record().find("n\\\\xff.onnx"), std::string::npos) << Record();
  Prepare(folder_.path() / name, network);
  WriteImages("n\xfe", {"b"}, 128);
  ExpectInputError([&] { Prepare(folder_.path() / "n\xfe", network); }, {"input"});
}

TEST_F(MaskFolderTest, ABrokenRecordIsReported) {
  for (const char* const record : {"[]", "{\"input\"", "{\"frame\": \"b\"}", "\"text\""}) {
    folder_.Write("masks/segment.json", record);
    ExpectInputError([&] { Prepare(walk_, network_); }, {"masks"});
  }
}

}  // namespace
}  // namespace hullslam
