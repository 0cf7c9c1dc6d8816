// Transverse shear measured along the edges of an element.
//
// The turning of an edge against the mean of the rotations at its ends, s = n . [v_j - v_i - (w_i + w_j)/2 x (x_j - x_i)],
// vanishes when the plate bends without shear and curves evenly along the edge, and for every rigid motion.  It is what
// MITC elements interpolate.  Theory: docs/theory/stabilised_element.md, docs/theory/shell_triangle.md.
#pragma once
#include "kinematics.hpp"

namespace crumple::shell {
namespace {

struct Corners {
    const Vec (&x)[4];
    const Vec (&v)[4];
    const Vec (&w)[4];
};
struct CornerForces {
    Vec force[4], moment[4];
};

CRUMPLE_INLINE Real edge_rate(const Corners& c, int i, int j, Vec normal) {
    return dot(normal, c.v[j] - c.v[i] - 0.5 * cross(c.w[i] + c.w[j], c.x[j] - c.x[i]));
}

// The force that works on edge_rate.
CRUMPLE_INLINE void add_edge_force(CornerForces& out, const Vec (&x)[4], int i, int j, Vec normal, Real force) {
    const Vec f = force * normal, m = (0.5 * force) * cross(normal, x[j] - x[i]);
    out.force[i] = out.force[i] - f;
    out.force[j] = out.force[j] + f;
    out.moment[i] = out.moment[i] + m;
    out.moment[j] = out.moment[j] + m;
}

}  // namespace
}  // namespace crumple::shell
