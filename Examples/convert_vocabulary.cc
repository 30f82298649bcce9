// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a vocabulary between the text format of ORB-SLAM2 and the binary form of HullSLAM.
#include "run/tools/convert_vocabulary.h"

#include "run/program.h"

int main(int argc, char** argv) {
  return hullslam::RunMain(hullslam::RunConvertVocabulary, argc, argv);
}
