// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/read_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

using std::chrono::milliseconds;

TEST(ReadFile, UnreadableFilesAreReportedByName) {
  const TemporaryFolder folder;
  const auto file = folder.Write("file", "x");
  const auto missing = folder.path() / "none.txt";
  ExpectInputError([&] { ReadFile(missing); }, {missing.string(), "No such file"});
  ExpectInputError([&] { ReadFile(folder.path()); }, {folder.path().string(), "is a folder"});
  ExpectInputError([&] { ReadFile(file / "below"); }, {"file/below", "Not a directory"});
}

TEST(ReadFile, ReadsAllBytes) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n", 5);
  EXPECT_EQ(ReadFile(folder.Write("bytes", bytes)), bytes);
  EXPECT_EQ(ReadFile(folder.Write("empty", "")), "");
}

TEST(ReadFile, FilesWithoutASizeAreRead) {
  EXPECT_NE(ReadFile("/proc/self/status").find("Pid:"), std::string::npos);
}

TEST(ReadFile, LargeFilesAreRefusedBeforeTheyAreRead) {
  const TemporaryFolder folder;
  const auto path = folder.Write("sparse", "");
  std::filesystem::resize_file(path, 100'000'000'000);
  ExpectInputError([&] { ReadFile(path); },
                   {"sparse: 100000000000 bytes, expected at most 128 MB"});
  const auto small = folder.Write("small", "12345");
  EXPECT_EQ(ReadFile(small, 5), "12345");
  ExpectInputError([&] { ReadFile(small, 4); }, {"small: 5 bytes"});
  ExpectInputError([&] { CheckFileSize(small, 4); }, {"small: 5 bytes"});
}

// A shell gives the two ends of a pipe for `<(command)`.
TEST(ReadFile, PipesAreReadToTheirEnd) {
  const std::string content = std::string(300'000, 'a') + "end";
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::string path = "/dev/fd/" + std::to_string(ends[0]);
  std::thread writer([&] {
    for (size_t at = 0; at < content.size();) {
      std::this_thread::sleep_for(milliseconds(5));
      const ssize_t written =
          ::write(ends[1], content.data() + at, std::min<size_t>(50'000, content.size() - at));
      ASSERT_GT(written, 0);
      at += static_cast<size_t>(written);
    }
    ::close(ends[1]);
  });
  EXPECT_EQ(ReadFile(path), content);
  writer.join();
  ::close(ends[0]);
}

TEST(ReadFile, PipesHaveTheSameLimit) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], "123456", 6), 6);
  ::close(ends[1]);
  const std::string path = "/dev/fd/" + std::to_string(ends[0]);
  ExpectInputError([&] { ReadFile(path, 5); }, {path, "more than 5 bytes"});
  ::close(ends[0]);
}

TEST(ReadFile, AFifoIsReadAndWaitingForItEnds) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "fifo";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  ExpectInputError([&] { ReadFile(path, 100, milliseconds(20)); },
                   {"fifo: is a pipe, and nothing was written to it for 0.02 s"});
  std::thread writer([&] {
    std::this_thread::sleep_for(milliseconds(20));
    std::ofstream(path) << "late";
  });
  EXPECT_EQ(ReadFile(path, 100, milliseconds(10'000)), "late");
  writer.join();
}

TEST(ReadFile, DevicesAndSocketsAreRefused) {
  ExpectInputError([] { ReadFile("/dev/zero"); }, {"/dev/zero: is neither a file nor a pipe"});
  const TemporaryFolder folder;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = folder.path() / "socket";
  ASSERT_LT(path.size(), sizeof(address.sun_path));
  std::strcpy(address.sun_path, path.c_str());
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  ExpectInputError([&] { ReadFile(path); }, {"socket: is neither a file nor a pipe"});
  ::close(socket);
}

using namespace std::string_view_literals;

// "1 \u00e9\n\U0001f600\r\n" in all encodings.
constexpr std::string_view kText = "1 \xc3\xa9\n\xf0\x9f\x98\x80\r\n";
constexpr std::string_view kLittle = "1\0 \0\xe9\0\n\0\x3d\xd8\x00\xde\r\0\n\0"sv;

std::string SwapBytes(std::string_view text) {
  std::string swapped(text);
  for (size_t i = 0; i + 1 < swapped.size(); i += 2) {
    std::swap(swapped[i], swapped[i + 1]);
  }
  return swapped;
}

TEST(ReadText, AllEncodingsOfWindowsGiveTheSameText) {
  const TemporaryFolder folder;
  const std::string big = SwapBytes(kLittle);
  for (const std::string& bytes :
       {std::string(kText), "\xef\xbb\xbf" + std::string(kText), "\xff\xfe" + std::string(kLittle),
        "\xfe\xff" + big, std::string(kLittle), big}) {
    EXPECT_EQ(ReadText(folder.Write("a.txt", bytes)), kText);
  }
}

TEST(ReadText, OtherBytesStayAsTheyAre) {
  const TemporaryFolder folder;
  for (const std::string_view bytes : {""sv, "a"sv, "\0"sv, "1 B\xfcro.png\n"sv, "a\0b\n"sv}) {
    EXPECT_EQ(ReadText(folder.Write("a.txt", bytes)), bytes);
  }
  EXPECT_EQ(ReadText(folder.Write("a.txt", "1\r2\r")), "1\n2\n");
}

TEST(ReadText, WhatIsNoTextIsNamed) {
  const TemporaryFolder folder;
  const auto read = [&](std::string_view bytes) {
    return [&folder, bytes] { ReadText(folder.Write("a.txt", bytes)); };
  };
  ExpectInputError(read("\xff\xfe\0\0a\0\0\0"sv), {"a.txt: is text in UTF-32"});
  ExpectInputError(read("\0\0\xfe\xff\0\0\0a"sv), {"a.txt: is text in UTF-32"});
  ExpectInputError(read("\xff\xfe"
                        "a\0b"sv),
                   {"a.txt: ", "half a character at byte 2"});
  ExpectInputError(read("\xff\xfe\x3d\xd8"
                        "a\0"sv),
                   {"half a character at byte 0"});
  ExpectInputError(read("\xff\xfe\x00\xde"
                        "a\0"sv),
                   {"half a character at byte 0"});
}

TEST(ReadText, EightBitEncodingsAreNamed) {
  CheckUtf8("a.txt", kText);
  ExpectInputError([] { CheckUtf8("a.txt", "cup\nB\xfcro\n"); },
                   {"a.txt:2: 'B?ro' is not UTF-8", "saved as UTF-8"});
}

TEST(LinesOf, EachEndsAtItsNewline) {
  using Lines = std::vector<std::string_view>;
  EXPECT_EQ(LinesOf(""), Lines());
  EXPECT_EQ(LinesOf("a"), Lines({"a"}));
  EXPECT_EQ(LinesOf("a\n"), Lines({"a"}));
  EXPECT_EQ(LinesOf("\na\r\n\nb"), Lines({"", "a\r", "", "b"}));
}

}  // namespace

}  // namespace hullslam
