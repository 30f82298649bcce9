// SPDX-License-Identifier: GPL-3.0-or-later
// A user's program: finds the installed package, links it and uses it.
#include <cmath>
#include <filesystem>
#include <iostream>

#include "hullslam/geometry/rigid3.h"

int main() {
  const hullslam::Rigid3 b_from_a(hullslam::ExpSo3({0.0, 0.0, 0.5}), {1.0, 2.0, 3.0});
  const hullslam::Rigid3 a_from_a = hullslam::Inverse(b_from_a) * b_from_a;
  if (a_from_a.translation.norm() > 1e-12) {
    std::cerr << "the library computes nonsense\n";
    return 1;
  }
  if (!std::filesystem::is_directory(HULLSLAM_CONFIG_DIR)) {
    std::cerr << "no settings in " << HULLSLAM_CONFIG_DIR << "\n";
    return 1;
  }
  std::cout << "consumer: ok\n";
  return 0;
}
