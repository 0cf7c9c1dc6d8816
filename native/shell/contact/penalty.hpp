// Penalty force of one contact: spring on the depth, damper on the approach velocity, and friction with a sticking spring up to the
// Coulomb limit.
#pragma once
#include <algorithm>

#include "shell/simd/layout.hpp"
#include "shell/run/model.hpp"

namespace crumple::shell {

// Motion of the nodes as contact reads it; `step` is the time step that led to it [s].
struct Motions {
    const double* position;
    const double* velocity;
    double step;
};

inline Vec3 position_of(const Motions& m, std::size_t node) { return read3(m.position + position_record * node); }
inline Vec3 velocity_of(const Motions& m, std::size_t node) { return read3(m.velocity + velocity_record * node); }

struct Bond {
    double stiffness;                // [N/m]
    double damper;                   // [N s/m]
    double friction;
};

// Stiffness as a share of the stability limit m / dt^2, and the damper from its damping ratio.
inline Bond bond_of(const ContactSettings& s, double mass, double step, double friction) {
    const double k = s.stiffness * mass / (step * step);
    return {k, 2.0 * s.damping * std::sqrt(k * mass), friction};
}

// Force along `direction` and against the slip; it never pulls.  `stick` is the friction force: kept from step to step, projected
// onto the tangent plane, changed by the slip, limited by Coulomb's law.
inline Vec3 force_of(const Bond& b, double depth, Vec3 direction, Vec3 slip, double step, Vec3& stick) {
    const double approach = dot(slip, direction);
    const double normal = std::max(b.stiffness * depth - b.damper * approach, 0.0);
    const Vec3 force = normal * direction;
    if (!(b.friction > 0.0)) return force;
    const Vec3 tangent = slip - approach * direction;
    const double limit = b.friction * normal;
    auto cut = [limit](Vec3 f) {
        const double size = norm(f);
        return size > limit ? (limit / size) * f : f;
    };
    stick = cut(stick - dot(stick, direction) * direction - (b.stiffness * step) * tangent);
    return force + cut(stick - b.damper * tangent);
}

}  // namespace crumple::shell
