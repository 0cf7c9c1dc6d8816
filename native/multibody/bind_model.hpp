// What the bindings of the multibody kernels share: arrays in and out, and the model from plain Python data.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <initializer_list>
#include <vector>

#include "multibody/bind_hinge.hpp"
#include "multibody/simulation.hpp"

namespace crumple::multibody {
inline namespace CRUMPLE_ARITHMETIC {

namespace nb = nanobind;

using Array = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Integers = nb::ndarray<const int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

// a NumPy array of its own memory
nb::object array(const Doubles& values, std::initializer_list<size_t> shape);
Settings make_settings(double accuracy, double minimum_step, double maximum_step);
void bind_model(nb::module_& m);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::multibody
