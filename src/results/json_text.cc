// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/json_text.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "files/plausible.h"
#include "hullslam/util/check.h"

namespace hullslam {

double Rounded(double value, double unit) {
  Check(std::isfinite(value), "a number of an object is not finite");
  const double units = std::round(1.0 / unit);
  return std::round(value * units) / units + 0.0;
}

std::string DumpLine(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string WithEntries(const nlohmann::ordered_json& head, const char* name,
                        const std::vector<std::string>& entries) {
  std::string text = DumpLine(head);
  text.pop_back();
  text += fmt::format(",\"{}\":[", name);
  for (const std::string& entry : entries) {
    text += (&entry == &entries.front() ? "\n " : ",\n ") + entry;
  }
  return text + "\n]}\n";
}

Rigid3 PoseOf(const JsonNode& node) {
  const std::vector<double> v = node.Numbers(7, "tx, ty, tz, qx, qy, qz, qw");
  Rigid3 pose(Eigen::Quaterniond(v[6], v[3], v[4], v[5]), {v[0], v[1], v[2]});
  if (!(pose.translation.cwiseAbs().maxCoeff() <= kMostMetres)) {
    node.Fail(fmt::format("a position from {:g} to {:g} m", -kMostMetres, kMostMetres));
  }
  if (!IsPlausibleRotation(pose.rotation)) {
    node.Fail("a quaternion of length 1");
  }
  pose.rotation.normalize();
  return pose;
}

}  // namespace hullslam
