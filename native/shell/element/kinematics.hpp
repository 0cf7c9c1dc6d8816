// Strain increments of one step, seen from the end of the step.
//
// With L' = dt grad v at the end of the step, the increment is the Almansi strain sym(L') - L'^T L' / 2:
// it is zero for any finite rigid rotation, where sym(L') alone has an error of (1 - cos) per step.  The transverse
// shear is corrected to the same order.  Theory: docs/theory/shell_element.md.
#pragma once
#include "shell/element/frame.hpp"
#include "shell/element/part.hpp"

namespace crumple::shell {
namespace {

struct StrainIncrement {
    Real xx, yy, xy;             // membrane; xy is the engineering shear
    Real kx, ky, kxy;            // change of curvature [1/m]
    Real xz{}, yz{};             // engineering transverse shear
};
struct HourglassRate {
    Real x, y, z, rx, ry;        // [m/s], [rad/s]
};
// Gradients of velocity and of rotation rate in the element's axes.
struct Motion {
    Gradient vx, vy, vz, wx, wy;
};

CRUMPLE_INLINE Motion motion_of(const Frame& f, const Pattern& v, const Pattern& w) {
    return {gradient(f, v, f.e1), gradient(f, v, f.e2), gradient(f, v, f.e3), gradient(f, w, f.e1), gradient(f, w, f.e2)};
}

CRUMPLE_INLINE StrainIncrement membrane_and_bending(const Motion& m, double dt) {
    const Gradient &vx = m.vx, &vy = m.vy, &vz = m.vz;
    const double half = 0.5 * dt;
    StrainIncrement s;
    // membrane: linear part and the quadratic part of the Almansi strain
    s.xx = dt * (vx.x - half * (vx.x * vx.x + vy.x * vy.x + vz.x * vz.x));
    s.yy = dt * (vy.y - half * (vx.y * vx.y + vy.y * vy.y + vz.y * vz.y));
    s.xy = dt * (vx.y + vy.x - dt * (vx.x * vx.y + vy.x * vy.y + vz.x * vz.y));
    // bending
    s.kx = dt * m.wy.x;
    s.ky = -dt * m.wx.y;
    s.kxy = dt * (m.wy.y - m.wx.x);
    return s;
}

// Belytschko-Wong-Chiang: in a warped element the normals p_I differ from corner to corner, so that the
// gradient changes through the thickness, b(z) = b + z b_c.  In the plane p_1 = -p_3 = -hz b_1, p_2 = -p_4 = hz b_2.
struct Warp {
    Real cx1, cx2, cy1, cy2;     // b_c [1/m2]
    Vec tilt1, tilt2;            // hz b_1, hz b_2 in the world
};

CRUMPLE_INLINE Warp warp_of(const Frame& f) {
    const Real c = f.hz * f.inverse_area;
    return {c * f.by2, c * f.by1, -c * f.bx2, -c * f.bx1, f.hz * (f.bx1 * f.e1 + f.by1 * f.e2), f.hz * (f.bx2 * f.e1 + f.by2 * f.e2)};
}

CRUMPLE_INLINE void add_warp(const Frame& f, const Warp& w, const Pattern& v, double dt, StrainIncrement& s) {
    const Real x13 = dot(v.along_13, f.e1), x24 = dot(v.along_24, f.e1);
    const Real y13 = dot(v.along_13, f.e2), y24 = dot(v.along_24, f.e2);
    s.kx += dt * (w.cx1 * x13 + w.cx2 * x24);
    s.ky += dt * (w.cy1 * y13 + w.cy2 * y24);
    s.kxy += dt * (w.cx1 * y13 + w.cx2 * y24 + w.cy1 * x13 + w.cy2 * x24);
}

// Removes the rotation rate about each corner's own normal: only rotations that tilt the normal bend the element.
CRUMPLE_INLINE void project_drill(const Frame& f, const Warp& w, Vec (&omega)[4]) {
    omega[0] = omega[0] + dot(omega[0], f.e3) * w.tilt1;
    omega[1] = omega[1] - dot(omega[1], f.e3) * w.tilt2;
    omega[2] = omega[2] - dot(omega[2], f.e3) * w.tilt1;
    omega[3] = omega[3] + dot(omega[3], f.e3) * w.tilt2;
}

// Hourglass rates, orthogonal to linear fields and to the rigid rotation of a warped element.
CRUMPLE_INLINE HourglassRate hourglass_rate(const Frame& f, const Motion& m) {
    return {m.vx.hourglass + f.hz * m.vz.x, m.vy.hourglass + f.hz * m.vz.y, m.vz.hourglass, m.wx.hourglass, m.wy.hourglass};
}

// Correction of second order in the step, with dvx/dz = -dvz/dx - dt dvy/dx dvz/dy: needed if the hourglass modes are held stiffly.
CRUMPLE_INLINE void correct_for_spin(const Frame& f, const Motion& m, double dt, HourglassRate& q) {
    q.x += dt * f.hz * m.vy.x * m.vz.y;
    q.y += dt * f.hz * m.vx.y * m.vz.x;
}

}  // namespace
}  // namespace crumple::shell
