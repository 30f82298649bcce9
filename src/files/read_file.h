// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>

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

}  // namespace hullslam
