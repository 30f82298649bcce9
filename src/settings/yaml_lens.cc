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

}  // namespace hullslam
