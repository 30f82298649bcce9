// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/named_lens.h"

#include <algorithm>
#include <array>

#include "camera/wide_lens.h"
#include "util/text.h"

namespace hullslam {
namespace {

using Field = double PinholeCamera::*;

struct NamedModel {
  std::string_view name;  // in lower case
  size_t fewest = 4;      // coefficients
  size_t most = 5;
};

constexpr std::array<NamedModel, 8> kModels = {{
    {.name = "plumb_bob"},
    {.name = "radtan"},
    {.name = "radtan4", .most = 4},
    {.name = "radtan5", .fewest = 5},
    {.name = "radial-tangential"},
    {.name = "brown conrady"},
    {.name = "rational_polynomial", .most = 8},
    {.name = "opencv", .most = 8},
}};

bool AreZero(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return number == 0.0; });
}

void ForgetLens(PinholeCamera& camera) {
  camera.lens = LensModel::kBrown;
  for (const LensCoefficient& one : CoefficientsOf(LensModel::kBrown)) {
    camera.*one.field = 0.0;
  }
  for (const Field field : {&PinholeCamera::xi, &PinholeCamera::alpha, &PinholeCamera::beta}) {
    camera.*field = PinholeCamera().*field;
  }
}

std::string SetWide(const WideModel& model, std::span<const double> coefficients,
                    PinholeCamera& camera) {
  const size_t count = model.coefficients.size();
  if (coefficients.size() < count || !AreZero(coefficients.subspan(count))) {
    std::string names;
    for (const LensCoefficient& one : model.coefficients) {
      (names += ' ') += one.name;
    }
    return "expected " + std::to_string(count) + " coefficients:" + names;
  }
  camera.lens = model.lens;
  for (size_t i = 0; i < count; ++i) {
    camera.*model.coefficients[i].field = coefficients[i];
  }
  return {};
}

}  // namespace

std::string SetNamedLens(std::string_view model, std::span<const double> coefficients,
                         PinholeCamera& camera) {
  const std::string name = LowerCase(model);
  ForgetLens(camera);
  if (const WideModel* const wide = FindWideModel(name)) {
    return SetWide(*wide, coefficients, camera);
  }
  if (AreZero(coefficients)) {
    return {};
  }
  const auto known = std::find_if(kModels.begin(), kModels.end(),
                                  [&](const NamedModel& one) { return one.name == name; });
  if (known == kModels.end()) {
    return "expected plumb_bob (radtan) with 4 or 5 coefficients, rational_polynomial with 8, "
           "equidistant (fisheye) with 4, or ds (double sphere) or eucm with 2";
  }
  const size_t used = std::min(known->most, coefficients.size());
  const bool breaks_off = used > 5 && used < known->most;  // k4 k5 k6 are given together
  if (coefficients.size() < known->fewest || breaks_off || !AreZero(coefficients.subspan(used))) {
    return "expected " +
           (known->fewest == known->most
                ? std::to_string(known->most)
                : std::to_string(known->fewest) + " to " + std::to_string(known->most)) +
           " coefficients: k1 k2 p1 p2 [k3 [k4 k5 k6]]";
  }
  for (size_t i = 0; i < used; ++i) {
    camera.*CoefficientsOf(LensModel::kBrown)[i].field = coefficients[i];
  }
  return {};
}

std::string SetLensOfKalibr(std::string_view model, std::span<const double> coefficients,
                            PinholeCamera& camera) {
  std::string expected = SetNamedLens(model, coefficients, camera);
  camera.fx /= 1.0 + camera.xi;
  camera.fy /= 1.0 + camera.xi;
  return expected;
}

NamedLens LensOfRos(const PinholeCamera& camera) {
  NamedLens lens;
  for (const LensCoefficient& one : CoefficientsOf(camera.lens)) {
    lens.coefficients.push_back(camera.*one.field);
  }
  if (const WideModel* const wide = FindWideModel(camera.lens)) {
    lens.model = wide->names.front();
    return lens;
  }
  constexpr size_t kOfPlumbBob = 5;
  const bool is_rational = !AreZero(std::span(lens.coefficients).subspan(kOfPlumbBob));
  lens.model = is_rational ? "rational_polynomial" : "plumb_bob";
  lens.coefficients.resize(is_rational ? lens.coefficients.size() : kOfPlumbBob);
  return lens;
}

std::string DescribeLens(const PinholeCamera& camera) {
  if (const WideModel* const wide = FindWideModel(camera.lens)) {
    return "with " + std::string(wide->title);
  }
  if (camera.k4 != 0.0 || camera.k5 != 0.0 || camera.k6 != 0.0) {
    return "with rational distortion";
  }
  return camera.IsDistorted() ? "with radial-tangential distortion" : "without distortion";
}

}  // namespace hullslam
