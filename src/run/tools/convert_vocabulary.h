// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program convert_vocabulary.
// Converts a vocabulary between the text format of ORB-SLAM2 and the binary form of HullSLAM.
// Parses the command line and returns the exit code. Throws InputError for bad input.
int RunConvertVocabulary(int argc, char** argv);

}  // namespace hullslam
