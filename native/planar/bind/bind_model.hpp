// Shared by the bindings of the planar kernel: the model from plain Python data.
#pragma once

#include "hinge/bind_hinge.hpp"
#include "planar/simulation.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace nb = nanobind;

void bind_model(nb::module_& m);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
