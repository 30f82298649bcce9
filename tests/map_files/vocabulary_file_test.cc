// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map_files/vocabulary_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/expect_error.h"
#include "support/made_vocabulary.h"
#include "support/paths.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(VocabularyFile, BothFormsAreReadWhateverTheirNames) {
  const TemporaryFolder folder;
  const Vocabulary vocabulary = MadeVocabulary();
  const std::filesystem::path path = folder.path() / "vocabulary";
  for (const VocabularyForm form : {VocabularyForm::kBinary, VocabularyForm::kText}) {
    WriteVocabulary(path, vocabulary, form);
    const Vocabulary read = ReadVocabulary(path);
    EXPECT_EQ(read.hash(), vocabulary.hash());
    EXPECT_EQ(BytesOf(read), BytesOf(vocabulary));
  }
}

TEST(VocabularyFile, AVocabularyOutlivesItsFile) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "vocabulary";
  WriteVocabulary(path, MadeVocabulary(), VocabularyForm::kBinary);
  const Vocabulary first = ReadVocabulary(path);
  WriteVocabulary(path, MadeVocabulary(4, 3, 2), VocabularyForm::kBinary);
  EXPECT_EQ(BytesOf(first), BytesOf(MadeVocabulary()));
  EXPECT_NE(ReadVocabulary(path).hash(), first.hash());
}

// Another program may write into the file of a vocabulary that a run uses.
TEST(VocabularyFile, AVocabularyDoesNotChangeWithItsFile) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "vocabulary";
  WriteVocabulary(path, MadeVocabulary(), VocabularyForm::kBinary);
  const Vocabulary vocabulary = ReadVocabulary(path);
  std::fstream(path, std::ios::in | std::ios::out) << std::string(1000, 'x');
  EXPECT_EQ(BytesOf(vocabulary), BytesOf(MadeVocabulary()));
  std::filesystem::resize_file(path, 0);
  EXPECT_EQ(BytesOf(vocabulary), BytesOf(MadeVocabulary()));
}

TEST(VocabularyFile, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::string& content, const std::string& why) {
    const std::filesystem::path path = folder.Write("file", content);
    ExpectInputError([&] { ReadVocabulary(path); }, {path.string(), why});
  };
  refuse("", "is empty, expected a vocabulary");
  refuse("%YAML:1.0\n", "is not a vocabulary");
  refuse(BytesOf(MadeVocabulary()).substr(0, 1000), "cut off");
  refuse("10 6 0 0\n0 1 2\n", "file:2: ");
  ExpectInputError([&] { ReadVocabulary(folder.path() / "none"); }, {"none", "No such file"});
  ExpectInputError([&] { ReadVocabulary(folder.path()); }, {"is a folder"});
}

TEST(VocabularyFile, AMissingFolderIsAnError) {
  const TemporaryFolder folder;
  ExpectInputError(
      [&] {
        WriteVocabulary(folder.path() / "no" / "file", MadeVocabulary(), VocabularyForm::kText);
      },
      {"cannot be written"});
}

TEST(VocabularyFile, TheDefaultIsFoundAndSmall) {
  // NOLINTBEGIN(concurrency-mt-unsafe): this test has one thread
  ::unsetenv("HULLSLAM_VOCABULARY");
  ::setenv("HULLSLAM_CONFIG", (SourceFolder() / "config").c_str(), 1);
  const std::filesystem::path file = SourceFolder() / "Vocabulary" / "hullslam.bow";
  EXPECT_TRUE(std::filesystem::equivalent(FindDefaultVocabulary(), file));
  EXPECT_LE(std::filesystem::file_size(file), 5'000'000u);
  const Vocabulary vocabulary = ReadVocabulary(FindDefaultVocabulary());
  EXPECT_EQ(vocabulary.branching(), 10);
  EXPECT_GT(vocabulary.word_count(), 5'000u);

  const TemporaryFolder folder;
  const std::filesystem::path other = folder.Write("other.bow", "");
  ::setenv("HULLSLAM_VOCABULARY", other.c_str(), 1);
  EXPECT_EQ(FindDefaultVocabulary(), other);
  ::setenv("HULLSLAM_VOCABULARY", folder.path().c_str(), 1);
  ExpectInputError([] { FindDefaultVocabulary(); }, {"HULLSLAM_VOCABULARY", "is not a file"});
  ::unsetenv("HULLSLAM_VOCABULARY");
  ::unsetenv("HULLSLAM_CONFIG");
  EXPECT_NO_THROW(FindDefaultVocabulary());
  // NOLINTEND(concurrency-mt-unsafe)
}

}  // namespace
}  // namespace hullslam
