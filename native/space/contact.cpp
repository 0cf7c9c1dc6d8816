#include "space/contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::space {

FrozenContact freeze(const ContactLaw& law, const ContactMotion& m) {
    FrozenContact f;
    if (m.gap > m.closed_gap) {
        // may close within the step, but not overlap at its end
        const double closing = (m.gap / m.h + (1 - m.share) * m.rate) / m.share;
        f.allowed = -std::max(0.0, closing);
    } else if (m.rate < -m.rest_rate) {
        f.allowed = -law.restitution * m.restitution_share * m.rate;
    }
    f.bias = m.bias;
    f.compliance = softness * m.inverse_mass;
    f.limit = law.friction * std::max(m.normal_impulse, 0.0);
    f.width = creep_rate;
    return f;
}

void respond(const FrozenContact& f, const double* w, double* impulse, double* tangent, double* potential) {
    const double approach = std::min(0.0, w[0] + f.bias.x - f.allowed), normal = approach / f.compliance;
    const double x = w[1] + f.bias.y, y = w[2] + f.bias.z, slip = std::hypot(x, y);
    const bool sliding = slip > f.width;
    const double slope = f.limit / (sliding ? slip : f.width);
    if (impulse) {
        impulse[0] = normal;
        impulse[1] = slope * x;
        impulse[2] = slope * y;
    }
    if (tangent) {
        std::fill(tangent, tangent + 9, 0.0);
        if (approach < 0) tangent[0] = 1 / f.compliance;
        // sliding friction only turns with the direction of slip
        const double u = sliding ? x / slip : 0, v = sliding ? y / slip : 0;
        tangent[4] = slope * (1 - u * u);
        tangent[5] = tangent[7] = -slope * u * v;
        tangent[8] = slope * (1 - v * v);
    }
    if (potential) {
        *potential = normal * approach / 2 + (sliding ? f.limit * (slip - f.width / 2) : slope * slip * slip / 2);
    }
}

}  // namespace crumple::space
