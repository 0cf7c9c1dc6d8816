// Transverse shear measured along the edges of an element.
//
// The rotation of an edge d relative to the mean rotation rate w of its ends, s = n . (v_j - v_i - w x d), is zero for bending without
// shear with constant curvature along the edge and for every rigid motion; a term of second order in the step extends this to
// finite rotations, seen from the end of the step.  MITC elements interpolate this shear.
// Theory: docs/theory/stabilised_element.md, docs/theory/shell_triangle.md.
#pragma once
#include "shell/element/kinematics.hpp"

namespace crumple::shell {
namespace {

struct Corners {
    const Vec (&x)[4];
    const Vec (&v)[4];
    const Vec (&w)[4];
    double dt;
};
struct CornerForces {
    Vec force[4], moment[4];
};

CRUMPLE_INLINE Real edge_rate(const Corners& c, int i, int j, Vec normal) {
    const Vec w = 0.5 * (c.w[i] + c.w[j]), turned = cross(w, c.x[j] - c.x[i]);
    return dot(normal, c.v[j] - c.v[i] - turned + (0.5 * c.dt) * cross(w, turned));
}

// Adds the corner forces conjugate to edge_rate.
CRUMPLE_INLINE void add_edge_force(CornerForces& out, const Vec (&x)[4], int i, int j, Vec normal, Real force) {
    const Vec f = force * normal, m = (0.5 * force) * cross(normal, x[j] - x[i]);
    out.force[i] = out.force[i] - f;
    out.force[j] = out.force[j] + f;
    out.moment[i] = out.moment[i] + m;
    out.moment[j] = out.moment[j] + m;
}

}  // namespace
}  // namespace crumple::shell
