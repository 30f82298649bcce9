// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/named_lens.h"

#include <algorithm>
#include <array>
#include <vector>

#include "util/lower_case.h"

namespace hullslam {
namespace {

using Field = double PinholeCamera::*;

struct NamedModel {
  std::string_view name;  // in lower case
  LensModel lens = LensModel::kBrown;
  size_t fewest = 4;  // coefficients
  size_t most = 5;
};

constexpr std::array<NamedModel, 12> kModels = {{
    {.name = "plumb_bob"},
    {.name = "radtan"},
    {.name = "radtan4", .most = 4},
    {.name = "radtan5", .fewest = 5},
    {.name = "radial-tangential"},
    {.name = "brown conrady"},
    {.name = "rational_polynomial", .most = 8},
    {.name = "opencv", .most = 8},
    {.name = "equidistant", .lens = LensModel::kKannalaBrandt, .most = 4},
    {.name = "fisheye", .lens = LensModel::kKannalaBrandt, .most = 4},
    {.name = "kannala_brandt", .lens = LensModel::kKannalaBrandt, .most = 4},
    {.name = "kannalabrandt8", .lens = LensModel::kKannalaBrandt, .most = 4},
}};

constexpr std::array<Field, 8> kBrownFields = {
    &PinholeCamera::k1, &PinholeCamera::k2, &PinholeCamera::p1, &PinholeCamera::p2,
    &PinholeCamera::k3, &PinholeCamera::k4, &PinholeCamera::k5, &PinholeCamera::k6};
constexpr std::array<Field, 4> kFisheyeFields = {&PinholeCamera::k1, &PinholeCamera::k2,
                                                 &PinholeCamera::k3, &PinholeCamera::k4};

bool AreZero(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return number == 0.0; });
}

}  // namespace

std::string SetNamedLens(std::string_view model, std::span<const double> coefficients,
                         PinholeCamera& camera) {
  const std::string name = LowerCase(model);
  const auto known = std::find_if(kModels.begin(), kModels.end(),
                                  [&](const NamedModel& one) { return one.name == name; });
  for (const Field field : kBrownFields) {
    camera.*field = 0.0;
  }
  camera.lens = LensModel::kBrown;
  const bool is_fisheye = known != kModels.end() && known->lens == LensModel::kKannalaBrandt;
  if (!is_fisheye && AreZero(coefficients)) {
    return {};
  }
  if (known == kModels.end()) {
    return "expected plumb_bob (radtan) with 4 or 5 coefficients, rational_polynomial with 8, or "
           "equidistant (fisheye) with 4";
  }
  const size_t used = std::min(known->most, coefficients.size());
  const bool breaks_off = used > 5 && used < known->most;  // k4 k5 k6 are given together
  if (coefficients.size() < known->fewest || breaks_off || !AreZero(coefficients.subspan(used))) {
    return "expected " +
           (known->fewest == known->most
                ? std::to_string(known->most)
                : std::to_string(known->fewest) + " to " + std::to_string(known->most)) +
           " coefficients: " + (is_fisheye ? "k1 k2 k3 k4" : "k1 k2 p1 p2 [k3 [k4 k5 k6]]");
  }
  camera.lens = known->lens;
  for (size_t i = 0; i < used; ++i) {
    camera.*(is_fisheye ? kFisheyeFields.at(i) : kBrownFields.at(i)) = coefficients[i];
  }
  return {};
}

std::string DescribeLens(const PinholeCamera& camera) {
  if (camera.IsFisheye()) {
    return "with a fisheye lens (Kannala-Brandt)";
  }
  if (camera.k4 != 0.0 || camera.k5 != 0.0 || camera.k6 != 0.0) {
    return "with rational distortion";
  }
  return camera.IsDistorted() ? "with radial-tangential distortion" : "without distortion";
}

}  // namespace hullslam
