// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

namespace hullslam {

// The tools, each in the file of this folder that has its name (those for vocabularies are in
// vocabulary_commands.cc). Each parses its command line, in which argv[0] is the name for --help,
// and returns the exit code. Throws InputError for bad usage or input.
int RunCalibrate(int argc, char** argv);
int RunCheckMasks(int argc, char** argv);
int RunConvertVocabulary(int argc, char** argv);
int RunEvaluate(int argc, char** argv);
int RunExport(int argc, char** argv);
int RunMapObjects(int argc, char** argv);
int RunMesh(int argc, char** argv);
int RunQueryObjects(int argc, char** argv);
int RunRelocalise(int argc, char** argv);
int RunRun(int argc, char** argv);  // in run/slam_program.cc
int RunSegment(int argc, char** argv);
int RunTrainVocabulary(int argc, char** argv);
int RunView(int argc, char** argv);

// A command of the program hullslam.
struct Command {
  const char* wish;     // the heading in `hullslam --help`: why a user needs it
  const char* name;     // "check-masks"
  const char* meaning;  // one line for --help
  // Null if the command is a program of its own in the folder of hullslam, because it needs
  // libraries that the other tools do not need: make-synthetic starts make_synthetic.
  int (*run)(int argc, char** argv);
};

// In the order of --help.
std::span<const Command> Commands();

// The program hullslam: `hullslam COMMAND ...` runs a command of tools/commands.h. Returns the exit
// code. Throws InputError for bad usage or input.
int RunHullslam(int argc, char** argv);

}  // namespace hullslam
