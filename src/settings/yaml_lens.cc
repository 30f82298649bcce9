// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_lens.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "camera/named_lens.h"
#include "util/shown_text.h"

namespace hullslam {

void ReadLens(const YamlMap& map, const char* model_key, const char* coefficients_key,
              PinholeCamera& camera) {
  const std::string model = map.Text(model_key);
  const std::vector<double> coefficients = map.Numbers(coefficients_key);
  if (const std::string expected = SetNamedLens(model, coefficients, camera); !expected.empty()) {
    map.Fail(model_key, fmt::format("is '{}' and {} has {} number(s), {}", ShowText(model),
                                    coefficients_key, coefficients.size(), expected));
  }
}

PinholeCamera ReadPinhole(const YamlMap& map, const char* coefficients_key) {
  if (const std::string model = map.Text("camera_model"); model != "pinhole") {
    map.Fail("camera_model", fmt::format("is '{}', expected 'pinhole'; HullSLAM has no other "
                                         "projection",
                                         ShowText(model)));
  }
  const std::vector<double> focal = map.Numbers("intrinsics", 4, "fu fv cu cv");
  const std::vector<double> size = map.Numbers("resolution", 2, "width height");
  PinholeCamera camera{.fx = focal[0],
                       .fy = focal[1],
                       .cx = focal[2],
                       .cy = focal[3],
                       .width = map.Pixels("resolution", size[0]),
                       .height = map.Pixels("resolution", size[1])};
  ReadLens(map, "distortion_model", coefficients_key, camera);
  return camera;
}

}  // namespace hullslam
