// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace hullslam {

// Throws InputError: "PATH: cannot be written: REASON", with the system's text for this error code.
[[noreturn]] void FailWriting(const std::filesystem::path& path, int code);

// Writes all bytes to an open file. Returns false with the reason in errno if the system refuses.
bool WriteAll(int descriptor, std::string_view content);

// Writes a new file and waits until the disk has it, because some disks only then report that they
// are full. If this fails, removes the file and throws InputError like FailWriting(), with the path
// `shown` in the message.
void WriteSyncedFile(const std::filesystem::path& path, std::string_view content,
                     const std::filesystem::path& shown);

}  // namespace hullslam
