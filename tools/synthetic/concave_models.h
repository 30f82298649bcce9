// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "synthetic/object_models.h"

namespace hullslam::synthetic {

// Objects with hollows and notches, so that an ellipsoid describes them badly and the convex hull
// of an outline is larger than the outline. All of them stand on z = 0, with the front at -y.

// An open cup with a handle, 10 cm high.
ObjectBuilder MakeOpenMug(const Material& material);
// An open bowl with a foot, 24 cm wide.
ObjectBuilder MakeOpenBowl(const Material& material);
// A wine glass, 21 cm high.
ObjectBuilder MakeWineGlass(const Material& material);
// A vase with a waist below its wide mouth, 26 cm high.
ObjectBuilder MakeWaistedVase(const Material& material);
// A banana of 19 cm that lies on its side.
ObjectBuilder MakeBanana(const Material& peel);
// A ring of dough that lies flat, 11 cm wide.
ObjectBuilder MakeDonut(const Material& dough);
// A couch around a corner: an L of 1.5 m x 1.5 m, seen from above.
ObjectBuilder MakeCornerCouch(const Material& cushion, const Material& frame);
// A bench without a back: a seat on two trestles, 1.1 m long.
ObjectBuilder MakeBench(const Material& wood);

}  // namespace hullslam::synthetic
