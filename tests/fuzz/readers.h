// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace hullslam {

// A reader of files under arbitrary input. `read` gives the bytes to the reader as its file. The
// reader may accept or refuse them with an InputError whose message is one short line; anything
// else ends the program: another exception, a crash, or a value that was read but cannot be used.
struct FuzzedReader {
  std::string_view name;
  void (*read)(std::string_view bytes);
};

// Makes the readers of a file known: a constant of this type in each file NAME_readers.cc.
struct KnownReaders {
  explicit KnownReaders(std::span<const FuzzedReader> readers);
};

// A known reader. Ends the program if there is none of this name.
const FuzzedReader& FindFuzzedReader(std::string_view name);

}  // namespace hullslam
