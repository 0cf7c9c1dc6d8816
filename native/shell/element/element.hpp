// One step of a block of elements: one-point quadrilateral (hourglass control or physical stabilisation) or triangle.
#pragma once
#include "shell/element/drill.hpp"
#include "shell/element/points.hpp"
#include "shell/element/stabilised.hpp"
#include "shell/element/triangle.hpp"

namespace crumple::shell {
namespace {

// In a warped element the moment resultants act on the in-plane velocities too.
struct InPlane {
    Real x1{}, x2{}, y1{}, y2{};
};

CRUMPLE_INLINE InPlane warp_forces(const Warp& w, Real mx, Real my, Real mxy) {
    return {w.cx1 * mx + w.cy1 * mxy, w.cx2 * mx + w.cy2 * mxy, w.cy1 * my + w.cx1 * mxy, w.cy2 * my + w.cx2 * mxy};
}

// Transpose of project_drill: the moment of a corner lies in its own tangent plane.
CRUMPLE_INLINE void tilt_moments(const Frame& f, const Warp& w, Vec (&moment)[4]) {
    moment[0] = moment[0] + dot(w.tilt1, moment[0]) * f.e3;
    moment[1] = moment[1] - dot(w.tilt2, moment[1]) * f.e3;
    moment[2] = moment[2] - dot(w.tilt1, moment[2]) * f.e3;
    moment[3] = moment[3] + dot(w.tilt2, moment[3]) * f.e3;
}

// Force and moment that vary like (1, 0, -1, 0) and (0, 1, 0, -1) over the corners.
struct Pair {
    Real along_13, along_24;
};

CRUMPLE_INLINE Pair divergence(const Frame& f, Real p, Real q, Real hourglass) {
    p -= f.hx * hourglass;
    q -= f.hy * hourglass;
    return {f.bx1 * p + f.by1 * q, f.bx2 * p + f.by2 * q};
}

// Internal forces at the corners of a quadrilateral; `mean_shear`: the transverse shear is conjugate to the gradient and the mean
// rotation.
CRUMPLE_INLINE CornerForces quad_forces(const Part& part, const Frame& f, const Integrals& s, const HourglassForce& h,
                                        const DrillMoment& drill, bool mean_shear) {
    const Resultants& r = s.r;
    const Real vt = s.volume * s.thickness, mx = vt * r.mx, my = vt * r.my, mxy = vt * r.mxy, fxy = s.volume * r.nxy;
    const Real fxz = mean_shear ? s.xz : Real{}, fyz = mean_shear ? s.yz : Real{}, half = 0.5 * drill.sum;
    const InPlane warp = part.warping_correction ? warp_forces(warp_of(f), mx, my, mxy) : InPlane{};
    const Pair x = divergence(f, s.volume * r.nx, fxy + half, h.x), y = divergence(f, fxy - half, s.volume * r.ny, h.y);
    const Pair z = divergence(f, fxz + f.hz * h.x, fyz + f.hz * h.y, h.z);
    const Pair rx = divergence(f, -mxy, -my, h.rx), ry = divergence(f, mx, mxy, h.ry);
    auto to_world = [&](Real cx, Real cy, Real cz) { return cx * f.e1 + cy * f.e2 + cz * f.e3; };
    const Vec a = to_world(x.along_13 + warp.x1, y.along_13 + warp.y1, z.along_13);
    const Vec b = to_world(x.along_24 + warp.x2, y.along_24 + warp.y2, z.along_24), hg = to_world(h.x, h.y, h.z);
    const Vec ma = rx.along_13 * f.e1 + ry.along_13 * f.e2, mb = rx.along_24 * f.e1 + ry.along_24 * f.e2;
    const Vec mh = h.rx * f.e1 + h.ry * f.e2, shear = 0.25 * (fxz * f.e2 - fyz * f.e1);
    CornerForces c = {{hg + a, b - hg, hg - a, Vec{} - b - hg}, {shear + mh + ma, shear - mh + mb, shear + mh - ma, shear - mh - mb}};
    if (part.warping_correction) tilt_moments(f, warp_of(f), c.moment);
    return c;
}

// Internal forces at the corners of a triangle, without transverse shear.
CRUMPLE_INLINE CornerForces triangle_forces(const Frame& f, const Integrals& s) {
    const Resultants& r = s.r;
    const Real vt = s.volume * s.thickness, mx = vt * r.mx, my = vt * r.my, mxy = vt * r.mxy, fxy = s.volume * r.nxy;
    const Pair x = divergence(f, s.volume * r.nx, fxy, Real{}), y = divergence(f, fxy, s.volume * r.ny, Real{});
    const Pair rx = divergence(f, -mxy, -my, Real{}), ry = divergence(f, mx, mxy, Real{});
    const Vec a = x.along_13 * f.e1 + y.along_13 * f.e2, b = x.along_24 * f.e1 + y.along_24 * f.e2;
    const Vec ma = rx.along_13 * f.e1 + ry.along_13 * f.e2, mb = rx.along_24 * f.e1 + ry.along_24 * f.e2;
    return {{a, b, Vec{} - a - b, Vec{}}, {ma, mb, Vec{} - ma - mb, Vec{}}};
}

// Failed lanes keep their state and carry no force; returns which lanes are alive.
CRUMPLE_INLINE Mask still_alive(const Part& part, Real* slots) {
    Real least = slots[point_slot(0, plastic_strain)], largest = least;
    for (int k = 1; k < part.points; k++) {
        const Real ep = slots[point_slot(k, plastic_strain)];
        least = ep < least ? ep : least;
        largest = larger(largest, ep);
    }
    const Mask alive_now = (slots[alive] > 0.5) & ((part.fails_at_any_point ? largest : least) < part.failure_strain);
    slots[alive] = alive_now ? all(1.0) : Real{};
    return alive_now;
}

CRUMPLE_INLINE void silence(CornerForces& c, Mask live) {
    auto keep = [&](Vec v) { return Vec{live ? v.x : Real{}, live ? v.y : Real{}, live ? v.z : Real{}}; };
    for (int i = 0; i < 4; i++) {
        c.force[i] = keep(c.force[i]);
        c.moment[i] = keep(c.moment[i]);
    }
}

// Half of the step's work, done by the forces at its end.  An element that is deleted in this step does not apply these forces, so
// this half is not done: it is subtracted from the dissipated energy; the energy stored in the element is kept.
CRUMPLE_INLINE Real second_half(const Corners& corners, const CornerForces& c) {
    Real power{};
    for (int i = 0; i < 4; i++) power += dot(c.force[i], corners.v[i]) + dot(c.moment[i], corners.w[i]);
    return (0.5 * corners.dt) * power;
}

// A strain increment above this value in one step is not physical: the solution has diverged.
constexpr double torn_strain = 0.33;

// Frame, motion and strain of a step; members that a formulation does not use are removed by the compiler.
struct Step {
    Frame f;
    Motion motion;
    StrainIncrement strain;
    EdgeShear edges;             // stabilised
    ShearRate shear;
    TriangleEdges sides;         // triangle
};

template <Formulation kind> CRUMPLE_INLINE Step step_of(const Part& part, const Corners& c) {
    const double dt = c.dt;
    Step s;
    s.f = frame_of(c.x);
    const bool warped = kind != Formulation::triangle && part.warping_correction;
    Vec w[4] = {c.w[0], c.w[1], c.w[2], c.w[3]};
    if (warped) project_drill(s.f, warp_of(s.f), w);
    const Pattern v = pattern(c.v);
    s.motion = motion_of(s.f, v, pattern(w));
    s.strain = membrane_and_bending(s.motion, dt);
    if (warped) add_warp(s.f, warp_of(s.f), v, dt, s.strain);
    if constexpr (kind == Formulation::one_point) {
        // half the product of spin and slope: term of second order in the step, like that of the membrane strain
        const Gradient& vz = s.motion.vz;
        const Vec mean = 0.25 * ((w[0] + w[1]) + (w[2] + w[3]));
        const Real turn = 0.25 * dt * (s.motion.vy.x - s.motion.vx.y);
        s.shear.xz = vz.x + dot(mean, s.f.e2) + turn * vz.y;
        s.shear.yz = vz.y - dot(mean, s.f.e1) - turn * vz.x;
    } else if constexpr (kind == Formulation::stabilised) {
        s.edges = edges_of(s.f);
        s.shear = shear_rate(s.f, s.edges, c);
    } else {
        s.sides = triangle_edges(s.f);
        const Vec at_centroid = triangle_shear(s.f, s.sides, c);
        s.shear.xz = dot(at_centroid, s.f.e1);
        s.shear.yz = dot(at_centroid, s.f.e2);
    }
    s.strain.xz = dt * s.shear.xz;
    s.strain.yz = dt * s.shear.yz;
    return s;
}

// Forces at the corners, including those of hourglass and drilling modes; adds the work done on these modes.
template <Formulation kind>
CRUMPLE_INLINE CornerForces corner_forces(const Part& part, const Step& s, const Corners& corners, const Integrals& in,
                                          Real* slots, Real& held_work) {
    const double dt = corners.dt;
    if constexpr (kind == Formulation::triangle) {
        CornerForces c = triangle_forces(s.f, in);
        add_triangle_shear(s.f, s.sides, corners.x, in.xz * s.f.e1 + in.yz * s.f.e2, c);
        return c;
    }
    Real* extra = slots + extra_slot(part.points, part.rate != Rate::none, 0);
    HourglassRate q = hourglass_rate(s.f, s.motion);
    DrillMoment drill;
    if (part.drill_stiffness > 0.0)
        drill = update_drill(part, s.f, s.motion, corners.w, dt, in.volume, in.r.kept, extra, held_work);
    CornerForces c;
    if constexpr (kind == Formulation::one_point) {
        HourglassForce h;
        held_work += update_hourglass(part, s.f, q, dt, in.thickness, in.volume, in.r.kept, slots, h);
        c = quad_forces(part, s.f, in, h, drill, true);
    } else {
        correct_for_spin(s.f, s.motion, dt, q);
        const Stabilisation held = stabilise(part, s.f, q, s.shear, dt, in, slots, extra);
        held_work += held.work;
        c = quad_forces(part, s.f, in, held.hourglass, drill, false);
        add_shear_forces(s.f, s.edges, corners.x, in.xz, in.yz, held.shear, c);
    }
    if (part.drill_stiffness > 0.0)
        for (int i = 0; i < 4; i++) c.moment[i] = c.moment[i] + drill.corner[i] * s.f.e3;
    return c;
}

// Stresses at the thickness points and transverse shear, which stays elastic; `work` receives the work of the step.
template <Law law, int points>
CRUMPLE_INLINE Integrals integrate(const Part& part, const Step& s, double dt, Real* slots, Real& work) {
    const Real t = slots[thickness];
    Integrals in;
    in.r = update_points<law, points>(part, s.strain, t, dt, slots);
    const Real old_xz = slots[shear_xz], old_yz = slots[shear_yz];
    const Real xz = old_xz + part.transverse_modulus * s.strain.xz, yz = old_yz + part.transverse_modulus * s.strain.yz;
    slots[shear_xz] = xz;
    slots[shear_yz] = yz;
    // thickness from the volume, which plastic flow preserves and the elastic trace of stress changes
    in.volume = s.f.area * t;
    in.thickness = t;
    if (part.thickness_update) {
        in.volume = slots[volume0] * (1.0 + part.bulk_compliance * (in.r.nx + in.r.ny));
        in.thickness = in.volume * s.f.inverse_area;
        slots[thickness] = in.thickness;
    }
    in.xz = in.volume * xz;
    in.yz = in.volume * yz;
    work = in.volume * (in.r.internal + 0.5 * ((old_xz + xz) * s.strain.xz + (old_yz + yz) * s.strain.yz));
    return in;
}

// Advances the state of a block; `stiffest` receives the squared frequency: NaN if the state is not finite, infinite if the element is
// torn or inverted.
template <Formulation kind, Law law, int points>
CRUMPLE_INLINE CornerForces update_block(const Part& part, const Corners& corners, Real* slots, Real& stiffest) {
    const Step s = step_of<kind>(part, corners);
    Real work, held_work{};
    const Integrals in = integrate<law, points>(part, s, corners.dt, slots, work);
    CornerForces c = corner_forces<kind>(part, s, corners, in, slots, held_work);
    stiffest = kind == Formulation::triangle ? triangle_frequency(s.f, slots[wave]) : frequency(s.f, slots[wave]);
    stiffest += 0.0 * (work + s.f.area);
    const StrainIncrement& e = s.strain;
    Mask lost = e.xx * e.xx + e.yy * e.yy + e.xy * e.xy > torn_strain * torn_strain;
    if constexpr (kind != Formulation::triangle) lost |= inverted(s.f);
    stiffest = lost ? all(__builtin_inf()) : stiffest;
    // accumulate energies, of lanes that are alive
    if (part.fails) {
        const Mask before = slots[alive] > 0.5, live = still_alive(part, slots);
        const Real undone = (before & ~live) ? second_half(corners, c) : Real{};
        slots[internal_energy] += before ? work - undone : Real{};
        slots[plastic_energy] += before ? in.volume * in.r.plastic - undone : Real{};
        slots[hourglass_energy] += before ? held_work : Real{};
        stiffest = live ? stiffest : Real{};
        silence(c, live);
    } else {
        slots[internal_energy] += work;
        slots[plastic_energy] += in.volume * in.r.plastic;
        slots[hourglass_energy] += held_work;
    }
    return c;
}

}  // namespace
}  // namespace crumple::shell
