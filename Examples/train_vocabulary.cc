// SPDX-License-Identifier: GPL-3.0-or-later
// Trains a vocabulary of visual words on images.
#include "run/tools/train_vocabulary.h"

#include "run/program.h"

int main(int argc, char** argv) {
  return hullslam::RunMain(hullslam::RunTrainVocabulary, argc, argv);
}
