// Capacities of a hinge with coupled components over a step, and the measure of rotation by which they soften; used by hinge.cpp alone.
#pragma once

#include "spatial/hinge/hinge.hpp"

namespace crumple::spatial {

inline Form form_of(const SpatialHinge& hinge) { return hinge.components[0].law.form; }
inline const hinge::Hinge& law_of(const SpatialHinge& hinge, int k) { return hinge.components[static_cast<size_t>(k)].law; }
inline bool rotates(const SpatialHinge& hinge, int k) { return hinge.components[static_cast<size_t>(k)].freedom >= 3; }
inline bool on_flange(const SpatialHinge& hinge) { return hinge.surface.coupling == Coupling::tension_flange; }
inline const hinge::Curve& curve_of(const hinge::Hinge& law, int sense) { return sense == 0 ? law.positive : law.negative; }

double first_capacity(const SpatialHinge& hinge, int k, int sense);
// work D_0(e) of a proportional rotation by e at the initial capacities, and the point of the surface where it is found
double measure(const SpatialHinge& hinge, const double* e);
// Updates the measure of softening after a flow that has led to the rotation e.
void soften(const SpatialHinge& hinge, SpatialHingeState& s, const double* e, const double* flow);
// whether no component flows
bool stands_still(const SpatialHinge& hinge, const double* flow);
bool softens(const SpatialHinge& hinge);
// whether a capacity depends on the rate
bool rated(const SpatialHinge& hinge);
// Capacities of a coupled hinge over a plastic flow from e, the mean over the flow (elastic-plastic: the value at its end), and the centre of
// its set.  `rate`: of the rate factors; null: without them.
void set_coupled_capacity(const SpatialHinge& hinge, const SpatialHingeState& s, const double* e, const double* flow, const double* rate,
                          FrozenSpatialHinge& f);

}  // namespace crumple::spatial
