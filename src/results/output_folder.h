// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hullslam {

class StagingFolder;

// The name of a surface of a run in its output folder, where `hullslam mesh` may write it.
inline constexpr const char* kSurfaceFile = "mesh.ply";

// A file of a run, by its name in the output folder.
struct FileContent {
  std::string name;
  std::string content;
};

// The program that writes a run, and whether it may replace a run of another program.
struct OutputOwner {
  std::string program = {};  // empty: any
  bool may_replace_others = false;
};

// The folder that a run writes its files to. At the end of a run all its files are moved into the
// folder together, and the files of the former run are removed, so the folder never mixes two runs.
// Every run has an index: a JSON file whose list "files" names all its other files.
//
// Until the end the files are in a staging folder inside the output folder. Several runs may have
// the same output folder at once; the one that ends last leaves its files. If a process is killed
// while it moves its files, the next run moves the others. If it is killed before, the next run
// removes its files.
class OutputFolder {
 public:
  // Creates the folder if it does not exist. `index` is the name of the index, "summary.json" or
  // "pictures.json". `inputs` are the files and folders that the run reads; empty paths are
  // ignored.
  //
  // Throws InputError if the folder is inside an input folder or contains an input; if it contains
  // files that are not from a former run with an index of the same name; if the former run is of
  // another program, which its index names in provenance.program, unless the owner may replace it;
  // or if files cannot be written there. In these cases nothing is changed. Files with the names of
  // KeptNames() are allowed.
  OutputFolder(const std::filesystem::path& folder, std::string index,
               std::span<const std::filesystem::path> inputs, const OutputOwner& owner = {});
  // Removes the files if Commit() was not called.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }

  // Writes a file to the staging folder. Throws InputError if this fails.
  void Write(const FileContent& file);
  // The names of the files that were written, for the index.
  const std::vector<std::string>& names() const { return names_; }
  // Moves all files into the output folder, the index last. To be called once, after the index was
  // written. Throws InputError if a file cannot be moved; the message says where the files are.
  void Commit();

  // Files that the user or a script may keep beside the results. No run writes or removes them.
  static std::vector<std::string> KeptNames();

 private:
  std::filesystem::path folder_;
  std::string index_;
  std::vector<std::string> names_;
  std::unique_ptr<StagingFolder> staging_;
};

// Throws InputError if the folder (or file) is inside an input folder, contains an input or is one.
// Empty paths are ignored.
void CheckApartFromInputs(const std::filesystem::path& folder,
                          std::span<const std::filesystem::path> inputs);

}  // namespace hullslam
