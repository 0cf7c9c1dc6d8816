// Drilling stiffness: resists the rotation of a corner about the element's normal relative to the element's own spin.
//
// Without it this degree of freedom has no stiffness in a smooth sheet, and if the warping terms couple it with curvature, bending
// moments relax.  Theory: docs/theory/shell_element.md.
#pragma once
#include "shell/element/kinematics.hpp"

namespace crumple::shell {
namespace {

struct DrillMoment {
    Real corner[4]{}, sum{};     // [N m]
};

// New drilling moments; adds the work done on them [J].  If thickness points yield, the moments are reduced by `kept`, the mean share
// of the deviatoric stress left by the plastic return.
CRUMPLE_INLINE DrillMoment update_drill(const Part& part, const Frame& f, const Motion& m, const Vec (&omega)[4], double dt,
                                        Real volume, Real kept, Real* extra, Real& work) {
    DrillMoment d;
    const Real spin = 0.5 * (m.vy.x - m.vx.y), stiffness = (0.25 * dt * part.drill_stiffness * part.shear_modulus) * volume;
    for (int c = 0; c < 4; c++) {
        const Real rate = dot(omega[c], f.e3) - spin, old = extra[drill_1 + c];
        const Real now = kept * (old + stiffness * rate);
        extra[drill_1 + c] = now;
        work += (0.5 * dt) * (old + now) * rate;
        d.corner[c] = now;
        d.sum += now;
    }
    return d;
}

}  // namespace
}  // namespace crumple::shell
