// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/mapped_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>

#include "support/expect_error.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

std::string Text(const FileBytes& file) {
  return {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
}

TEST(MappedFile, GivesTheContentOfAFile) {
  const TemporaryFolder folder;
  const std::string content(100'000, 'a');
  EXPECT_EQ(Text(MapFile(folder.Write("file", content), 100'000)), content);
  EXPECT_EQ(Text(MapFile(folder.Write("empty", ""), 10)), "");
}

TEST(MappedFile, TheContentOutlivesTheFile) {
  const TemporaryFolder folder;
  const FileBytes file = MapFile(folder.Write("file", "content"), 10);
  const FileBytes copy = file;
  std::filesystem::rename(folder.Write("other", "another text"), folder.path() / "file");
  EXPECT_EQ(Text(copy), "content");
  EXPECT_EQ(Text(MapFile(folder.path() / "file", 100)), "another text");
}

TEST(MappedFile, APipeIsRead) {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path() / "pipe").string();
  ASSERT_EQ(RunShell("mkfifo '" + pipe + "'"), 0);
  std::jthread writer([&] { RunShell("printf content > '" + pipe + "'"); });
  EXPECT_EQ(Text(MapFile(pipe, 10)), "content");
}

TEST(MappedFile, UnreadableFilesAreRefused) {
  const TemporaryFolder folder;
  ExpectInputError([&] { MapFile(folder.path() / "none", 10); }, {"none", "No such file"});
  ExpectInputError([&] { MapFile(folder.path(), 10); }, {"folder"});
  ExpectInputError([&] { MapFile(folder.Write("large", "12345678901"), 10); }, {"large", "11"});
}

}  // namespace
}  // namespace hullslam
