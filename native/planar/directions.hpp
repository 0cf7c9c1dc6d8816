// Derivatives of a model's numbers along directions in the space of parameters (tangent arithmetic only).
#pragma once

#include <vector>

#include "planar/stepper.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

// Gives every number of the model the derivative (up - down)/width along each direction, up and down being the same
// model with that parameter moved either way.  False when they differ in more than numbers.
bool set_directions(Model& model, const std::vector<Model*>& up, const std::vector<Model*>& down,
                    const std::vector<double>& width);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
