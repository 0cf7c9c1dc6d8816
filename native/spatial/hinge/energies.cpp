// Energies that hinges store and have dissipated.
#include "spatial/hinge/hinge.hpp"

namespace crumple::spatial {

namespace {

const hinge::Hinge& law_of(const SpatialHinge& hinge, int k) { return hinge.components[static_cast<size_t>(k)].law; }

}  // namespace

double elastic_energy(const SpatialHinge& hinge, const SpatialHingeState& s) {
    double sum = 0;
    for (int k = 0; k < size(hinge); k++) sum += hinge::elastic_energy(law_of(hinge, k), s.component[k]);
    return sum;
}

double stop_energy(const SpatialHinge& hinge, const double* q) {
    double sum = 0;
    for (int k = 0; k < size(hinge); k++) sum += hinge::stop_energy(law_of(hinge, k), q[k]);
    return sum;
}

double dissipated(const SpatialHinge& hinge, const SpatialHingeState& s) {
    double sum = 0;
    for (int k = 0; k < size(hinge); k++) sum += s.component[k].dissipated;
    return sum;
}

double damped(const SpatialHinge& hinge, const SpatialHingeState& s) {
    double sum = 0;
    for (int k = 0; k < size(hinge); k++) sum += s.component[k].damped;
    return sum;
}

double stop_dissipated(const SpatialHinge& hinge, const SpatialHingeState& s) {
    double sum = 0;
    for (int k = 0; k < size(hinge); k++) sum += s.component[k].stop_dissipated;
    return sum;
}

}  // namespace crumple::spatial
