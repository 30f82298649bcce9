// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace hullslam {

// Looks through the graph of a network (a GraphProto) for what OpenCV would not notice before it
// reads or writes memory that is not its own: tensors without their values, and attributes of nodes
// that are out of range. Throws InputError with the name of the tensor or node. Adds the names of
// the files that have values of tensors to `weight_files`.
void CheckGraph(std::string_view graph, std::set<std::string>& weight_files);

}  // namespace hullslam
