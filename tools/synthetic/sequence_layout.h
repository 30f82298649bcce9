// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hullslam::synthetic {

// The data sets in whose form a sequence can be written.
enum class DatasetForm { kTum, kIcl };

// "tum" or "icl", as in the names of the programs that read it.
std::string_view DatasetName(DatasetForm form);

// Where the files of a sequence are and how its frames are numbered. In the form of TUM everything
// is in one folder. In the form of ICL-NUIM the folder has the images and the ground truth of that
// data set, and a folder in it has what ICL-NUIM has no files for (masks, true objects), together
// with lists in TUM's form.
struct SequenceLayout {
  DatasetForm form = DatasetForm::kTum;

  // Time stamp of a frame in seconds: 1000 s plus frame / 30 s, or in ICL-NUIM frame / 30 s, which
  // is what its readers make of the number of the frame.
  double Stamp(int frame) const;
  // Name of the images and masks of a frame, without extension: "1000.033333", or "1" in ICL-NUIM.
  std::string Stem(int frame) const;
  // The folder of the lists in TUM's form, relative to that of the sequence: "" or "tum".
  std::filesystem::path TumFolder() const;
  // The folder of the images, relative to the one of the lists in TUM's form: "" or "../".
  std::string ImagesFromTumFolder() const;
  // The entries that a sequence has at its top, so that an earlier one can be recognised. `name` is
  // the name of the sequence.
  bool IsEntry(std::string_view entry, std::string_view name) const;
};

}  // namespace hullslam::synthetic
