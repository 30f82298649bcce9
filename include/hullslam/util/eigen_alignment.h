// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

// Eigen aligns its types as the flags of the compiler allow, so with -mavx or -march=native a
// program would see other types than the library has: it would print wrong poses, and crash. The
// library always has 16 bytes. The targets of CMake and the file of pkg-config define this for
// their users; this header stops programs that are built otherwise.
static_assert(EIGEN_MAX_ALIGN_BYTES == 16 && EIGEN_MAX_STATIC_ALIGN_BYTES == 16,
              "Eigen's types are not aligned as in HullSLAM: compile all files of the program with "
              "-DEIGEN_MAX_ALIGN_BYTES=16 (hullslam::hullslam of CMake does), and without "
              "EIGEN_DONT_VECTORIZE, EIGEN_DONT_ALIGN and EIGEN_MAX_STATIC_ALIGN_BYTES");
