#include "spatial/contact/contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

double allowed_rate(double restitution, double gap, double rate, double h, double closed, double rest) {
    if (gap > closed) return -std::max(0.0, 2 * gap / h + rate);
    return rate < -rest ? -restitution * rate : 0;
}

double friction_limit(const ContactLaw& law, double normal_impulse) { return law.friction * std::max(normal_impulse, 0.0); }

FrozenContact freeze(const ContactLaw& law, double inverse_mass, double normal_impulse, double cap) {
    return {softness * inverse_mass, cap, friction_limit(law, normal_impulse), creep_rate};
}

namespace {

// potential of the normal impulse
double pressed(const FrozenContact& f, double approach, double normal) { return normal * (approach - normal * f.compliance / 2); }

}  // namespace

void respond(const FrozenContact& f, size_t n, const double* w, double* impulse, double* tangent, double* potential) {
    const double approach = std::min(0.0, w[0]), normal = std::max(approach / f.compliance, -f.cap);
    const bool crushes = normal <= -f.cap;
    if (n == 1) {
        if (impulse) impulse[0] = normal;
        if (tangent) tangent[0] = approach < 0 && !crushes ? 1 / f.compliance : 0;
        if (potential) *potential = pressed(f, approach, normal);
        return;
    }
    const double slip = std::hypot(w[1], w[2]);
    const bool sliding = slip > f.width;
    const double slope = f.limit / (sliding ? slip : f.width);
    if (impulse) {
        impulse[0] = normal;
        impulse[1] = slope * w[1];
        impulse[2] = slope * w[2];
    }
    if (tangent) {
        std::fill(tangent, tangent + 9, 0.0);
        if (approach < 0 && !crushes) tangent[0] = 1 / f.compliance;
        // sliding friction changes only with the direction of slip
        const double u = sliding ? w[1] / slip : 0, v = sliding ? w[2] / slip : 0;
        tangent[4] = slope * (1 - u * u);
        tangent[5] = tangent[7] = -slope * u * v;
        tangent[8] = slope * (1 - v * v);
    }
    if (potential) {
        *potential = pressed(f, approach, normal) +
                     (sliding ? f.limit * (slip - f.width / 2) : slope * slip * slip / 2);
    }
}

}  // namespace crumple::spatial
