// Spatial hinges from Python's plain values, and one hinge by itself for tests of the element.
#pragma once

#include <nanobind/nanobind.h>

#include "spatial/hinge/hinge.hpp"

namespace crumple::spatial {

SpatialHinge make_hinge(const nanobind::dict& d);
void bind_hinge(nanobind::module_& m);

}  // namespace crumple::spatial
