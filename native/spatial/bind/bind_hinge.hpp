// Spatial hinges from plain Python values, and a single hinge for tests of the element.
#pragma once

#include <nanobind/nanobind.h>

#include "spatial/hinge/hinge.hpp"

namespace crumple::spatial {

SpatialHinge make_hinge(const nanobind::dict& d);
void bind_hinge(nanobind::module_& m);

}  // namespace crumple::spatial
