// The engine once more, with derivatives: the same sources over the other arithmetic of real.hpp.
#define CRUMPLE_TANGENT

#include "multibody/hinge.cpp"
#include "multibody/tree.cpp"
#include "multibody/newton.cpp"
#include "multibody/stepper.cpp"
#include "multibody/simulation.cpp"
#include "multibody/bind_model.cpp"
#include "multibody/directions.cpp"
#include "multibody/bind_tangent.cpp"
