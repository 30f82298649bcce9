// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates finished runs: the error of a trajectory against ground truth, and the mapped objects.
#include "run/tools/evaluate.h"

#include "run/program.h"

int main(int argc, char** argv) { return hullslam::RunMain(hullslam::RunEvaluate, argc, argv); }
