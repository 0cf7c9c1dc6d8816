// One step of a block of elements: Belytschko-Lin-Tsay quadrilateral, or the triangle it degenerates to.
#pragma once
#include "hourglass.hpp"
#include "points.hpp"

namespace crumple::shell {
namespace {

struct CornerForces {
    Vec force[4], moment[4];
};

// Moment resultants of the warped surface act on the in-plane velocities too.
struct InPlane {
    Real x1{}, x2{}, y1{}, y2{};
};

CRUMPLE_INLINE InPlane warp_forces(const Warp& w, Real mx, Real my, Real mxy) {
    return {w.cx1 * mx + w.cy1 * mxy, w.cx2 * mx + w.cy2 * mxy, w.cy1 * my + w.cx1 * mxy, w.cy2 * my + w.cx2 * mxy};
}

// The counterpart of project_drill: a corner's moment lies in its own tangent plane.
CRUMPLE_INLINE void tilt_moments(const Frame& f, const Warp& w, Vec (&moment)[4]) {
    moment[0] = moment[0] + dot(w.tilt1, moment[0]) * f.e3;
    moment[1] = moment[1] - dot(w.tilt2, moment[1]) * f.e3;
    moment[2] = moment[2] - dot(w.tilt1, moment[2]) * f.e3;
    moment[3] = moment[3] + dot(w.tilt2, moment[3]) * f.e3;
}

// Internal force at the corners from the stress integrals (stress times volume) and the hourglass resultants.
CRUMPLE_INLINE CornerForces corner_forces(const Part& part, const Frame& f, const Resultants& r, Real xz, Real yz, Real volume,
                                          Real thickness, const HourglassForce& h) {
    const Real vt = volume * thickness, mx = vt * r.mx, my = vt * r.my, mxy = vt * r.mxy;
    const Real fxy = volume * r.nxy, fxz = volume * xz, fyz = volume * yz;
    const InPlane warp = part.warping_correction ? warp_forces(warp_of(f), mx, my, mxy) : InPlane{};
    struct Pair {
        Real along_13, along_24;
    };
    auto divergence = [&](Real p, Real q, Real hourglass) -> Pair {
        p -= f.hx * hourglass;
        q -= f.hy * hourglass;
        return {f.bx1 * p + f.by1 * q, f.bx2 * p + f.by2 * q};
    };
    const Pair x = divergence(volume * r.nx, fxy, h.x), y = divergence(fxy, volume * r.ny, h.y);
    const Pair z = divergence(fxz + f.hz * h.x, fyz + f.hz * h.y, h.z);
    const Pair rx = divergence(-mxy, -my, h.rx), ry = divergence(mx, mxy, h.ry);
    auto to_world = [&](Real cx, Real cy, Real cz) { return cx * f.e1 + cy * f.e2 + cz * f.e3; };
    const Vec a = to_world(x.along_13 + warp.x1, y.along_13 + warp.y1, z.along_13);
    const Vec b = to_world(x.along_24 + warp.x2, y.along_24 + warp.y2, z.along_24), hg = to_world(h.x, h.y, h.z);
    const Vec ma = rx.along_13 * f.e1 + ry.along_13 * f.e2, mb = rx.along_24 * f.e1 + ry.along_24 * f.e2;
    const Vec mh = h.rx * f.e1 + h.ry * f.e2, shear = fxz * f.e2 - fyz * f.e1;
    const Vec m12 = part.mean_12 * shear, m34 = part.mean_34 * shear;
    CornerForces c = {{hg + a, b - hg, hg - a, Vec{} - b - hg}, {m12 + mh + ma, m12 - mh + mb, m34 + mh - ma, m34 - mh - mb}};
    if (part.warping_correction) tilt_moments(f, warp_of(f), c.moment);
    return c;
}

// A lane that has failed keeps its state and carries no force; returns which lanes are alive.
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

// A strain increment beyond a third in one step is not a motion of metal but a run that has gone astray.
constexpr double torn_strain = 0.33;

// Advances the state of a block; `stiffest` gets its squared frequency: NaN where the state is not finite, infinite where it is torn.
template <Law law, int points>
CRUMPLE_INLINE CornerForces update_block(const Part& part, const Vec (&x)[4], const Vec (&v)[4], const Vec (&w)[4], double dt,
                                         Real* slots, Real& stiffest) {
    // shape and motion
    const Frame f = frame_of(x);
    const Kinematics k = kinematics(f, v, w, dt, part);
    // stresses at the thickness points
    const Real t_old = slots[thickness];
    const Resultants r = update_points<law, points>(part, k.strain, t_old, dt, slots);
    // transverse shear stays elastic
    const Real old_xz = slots[shear_xz], old_yz = slots[shear_yz];
    const Real xz = old_xz + part.transverse_modulus * k.strain.xz, yz = old_yz + part.transverse_modulus * k.strain.yz;
    slots[shear_xz] = xz;
    slots[shear_yz] = yz;
    // thickness from the volume: plastic flow keeps it, the elastic trace of stress changes it
    Real t = t_old, volume = f.area * t_old;
    if (part.thickness_update) {
        volume = slots[volume0] * (1.0 + part.bulk_compliance * (r.nx + r.ny));
        t = volume / f.area;
        slots[thickness] = t;
    }
    HourglassForce h;
    const Real hourglass_work = update_hourglass(part, f, k.hourglass, dt, t, volume, r.kept, slots, h);
    const Real work = volume * (r.internal + 0.5 * ((old_xz + xz) * k.strain.xz + (old_yz + yz) * k.strain.yz));
    CornerForces c = corner_forces(part, f, r, xz, yz, volume, t, h);
    stiffest = frequency(f, slots[wave], part.triangle) + 0.0 * (work + f.area);
    const StrainIncrement& e = k.strain;
    stiffest = e.xx * e.xx + e.yy * e.yy + e.xy * e.xy > torn_strain * torn_strain ? all(__builtin_inf()) : stiffest;
    // accumulate energies, of lanes that are alive
    if (part.fails) {
        const Mask before = slots[alive] > 0.5, live = still_alive(part, slots);
        slots[internal_energy] += before ? work : Real{};
        slots[plastic_energy] += before ? volume * r.plastic : Real{};
        slots[hourglass_energy] += before ? hourglass_work : Real{};
        stiffest = live ? stiffest : Real{};
        silence(c, live);
    } else {
        slots[internal_energy] += work;
        slots[plastic_energy] += volume * r.plastic;
        slots[hourglass_energy] += hourglass_work;
    }
    return c;
}

}  // namespace
}  // namespace crumple::shell
