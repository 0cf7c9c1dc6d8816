// Models and conditions from plain Python values.
#pragma once

#include <nanobind/nanobind.h>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

Model make_model(const nanobind::dict& d);
Condition make_condition(const Model& model, nanobind::handle given);
// flags of n things, true for the indices given
std::vector<bool> chosen(const std::vector<int>& indices, size_t n, const char* unknown);

}  // namespace crumple::spatial
