#pragma once

#include "planar/bind/bind_model.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

void bind_batch(nb::module_& m);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
