// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

constexpr size_t kMostTextFileBytes = 128'000'000;  // limit for lists, trajectories and settings

// How long ReadFile() waits for the next bytes of a pipe.
constexpr std::chrono::milliseconds kPipePatience{30'000};

// All bytes of a regular file or of a pipe, such as `<(command)` of a shell or a FIFO. Throws
// InputError with the name of the file and the reason if it is missing, is neither a file nor a
// pipe, cannot be read, has more than `most_bytes`, or is a pipe and no bytes arrive for the time
// `patience`. The size of a regular file is checked before anything is read.
std::string ReadFile(const std::filesystem::path& path, size_t most_bytes = kMostTextFileBytes,
                     std::chrono::milliseconds patience = kPipePatience);

// Throws InputError if the file has more than `most_bytes`. If the size cannot be read, it does
// nothing, because reading the file will report the error.
void CheckFileSize(const std::filesystem::path& path, size_t most_bytes);

// The text of a file in UTF-8, with lines that end in "\n" or "\r\n". Every reader of text files
// uses this function, because programs on Windows write text in several forms: with a byte order
// mark, in UTF-16 (with or without a mark), and formerly with lines that end in "\r". Bytes without
// a mark that are not UTF-16 stay as they are, because names of files may be in any encoding.
// Throws InputError for a file that ReadFile() refuses, for UTF-32, and for UTF-16 that breaks off.
std::string ReadText(const std::filesystem::path& path, size_t most_bytes = kMostTextFileBytes);

// The lines of a text without their "\n". There is none behind the last "\n".
std::vector<std::string_view> LinesOf(std::string_view text);

// Throws InputError "FILE:LINE: ..." for the first bytes of `text` that are not UTF-8. For texts
// with names that people read. In the file, `text` begins at line 1.
void CheckUtf8(const std::filesystem::path& path, std::string_view text);

}  // namespace hullslam
