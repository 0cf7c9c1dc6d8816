#pragma once

#include "multibody/bind_model.hpp"

namespace crumple::multibody {

void bind_batch(nb::module_& m);

}  // namespace crumple::multibody
