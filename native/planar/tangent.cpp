// The planar kernel with derivatives: the same sources compiled with the tangent arithmetic of real.hpp.
#define CRUMPLE_TANGENT

#include "hinge/curve.cpp"
#include "hinge/hinge.cpp"
#include "planar/tree.cpp"
#include "planar/newton.cpp"
#include "planar/stepper.cpp"
#include "planar/simulation.cpp"
#include "planar/step_control.cpp"
#include "planar/bind/bind_model.cpp"
#include "planar/directions.cpp"
#include "planar/bind/bind_tangent.cpp"
