// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program train_vocabulary.
// Trains a vocabulary of visual words on images. Parses the command line and returns the exit
// code. Throws InputError for bad input.
int RunTrainVocabulary(int argc, char** argv);

}  // namespace hullslam
