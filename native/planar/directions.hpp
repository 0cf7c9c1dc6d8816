// Derivatives of a model's numbers along directions in the space of parameters (tangent arithmetic only).
#pragma once

#include <vector>

#include "planar/stepper.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

// Sets the derivative (up - down)/width of every number of the model along each direction; `up` and `down` are the same model
// with that parameter increased and decreased.  False if they differ in more than numbers.
bool set_directions(Model& model, const std::vector<Model*>& up, const std::vector<Model*>& down,
                    const std::vector<double>& width);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
