// What the bindings of the multibody kernels share: the model and settings from plain Python data.
#pragma once

#include "multibody/bind_hinge.hpp"
#include "multibody/simulation.hpp"

namespace crumple::multibody {
inline namespace CRUMPLE_ARITHMETIC {

namespace nb = nanobind;

Settings make_settings(double accuracy, double minimum_step, double maximum_step);
void bind_model(nb::module_& m);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::multibody
