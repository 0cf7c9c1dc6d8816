// Solids from plain Python values.
#pragma once

#include <nanobind/nanobind.h>

#include "spatial/contact/contact_geometry.hpp"

namespace crumple::spatial {

Solid make_solid(const nanobind::dict& d);
void bind_contact(nanobind::module_& m);

}  // namespace crumple::spatial
