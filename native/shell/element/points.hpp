// Thickness points: stress update of each point, and integration to resultants.
#pragma once
#include "shell/element/kinematics.hpp"
#include "shell/element/plasticity.hpp"

namespace crumple::shell {
namespace {

// Means over the thickness: stress [Pa], stress times z/t [Pa], energies per volume [J/m3].
struct Resultants {
    Real nx{}, ny{}, nxy{}, mx{}, my{}, mxy{};
    Real internal{}, plastic{};
    Real kept{};                 // mean share of the deviator left by plastic return
};

// Stress integrals: resultants over the thickness, and the transverse shear stress times volume [N m].
struct Integrals {
    Resultants r;
    Real volume, thickness, xz, yz;
};

// Elastic change of stress in a step: at the mid-surface, and its slope over z/t.
struct ElasticStep {
    Stress membrane, bending;
};

CRUMPLE_INLINE ElasticStep elastic_step(const Part& part, const StrainIncrement& s, Real thickness) {
    const double C = part.plane_modulus, nu = part.poissons_ratio;
    const Real kx = thickness * s.kx, ky = thickness * s.ky;
    return {{C * (s.xx + nu * s.yy), C * (s.yy + nu * s.xx), part.shear_modulus * s.xy},
            {C * (kx + nu * ky), C * (ky + nu * kx), part.shear_modulus * (thickness * s.kxy)}};
}

CRUMPLE_INLINE Real rate_factor_at(const Part& part, int k, const StrainIncrement& s, Real thickness, double dt, Real* slots) {
    if (part.rate == Rate::none) return all(1.0);
    const Real zt = part.z[k] * thickness, ex = s.xx + zt * s.kx, ey = s.yy + zt * s.ky, exy = s.xy + zt * s.kxy;
    const Real e2 = (4.0 / 3.0) * (ex * ex + ey * ey + ex * ey + 0.25 * exy * exy);
    return rate_factor(part, slots[rate_slot(part.points, k)], root(e2), dt);
}

// Plastic return of the points k; subtracts the change of stress from the resultants of the elastic trial and adds the plastic work.
template <Law law, int n>
CRUMPLE_INLINE void return_points(const Part& part, const int (&k)[n], const StrainIncrement& s, Real thickness, double dt,
                                  const Stress (&old)[n], Stress (&now)[n], Real* slots, Resultants& r) {
    Stress trial[n];
    Real kept[n];
    bool yields = false;
    for (int i = 0; i < n; i++) trial[i] = now[i];
    if constexpr (law == Law::linear) {
        Real ep[n];
        for (int i = 0; i < n; i++) ep[i] = slots[point_slot(k[i], plastic_strain)];
        yields = return_linear(part, now, ep, kept);
        for (int i = 0; yields && i < n; i++) slots[point_slot(k[i], plastic_strain)] = ep[i];
    } else {
        for (int i = 0; i < n; i++) {
            const Real factor = rate_factor_at(part, k[i], s, thickness, dt, slots);
            yields |= return_general(part, now[i], slots[point_slot(k[i], plastic_strain)], factor, kept[i]);
        }
    }
    if (!yields) return;
    for (int i = 0; i < n; i++) {
        const double weight = part.weight[k[i]], moment = weight * part.z[k[i]];
        const Real x = trial[i].x - now[i].x, y = trial[i].y - now[i].y, xy = trial[i].xy - now[i].xy;
        r.nx -= weight * x;
        r.ny -= weight * y;
        r.nxy -= weight * xy;
        r.mx -= moment * x;
        r.my -= moment * y;
        r.mxy -= moment * xy;
        r.plastic += weight * plastic_work(part, old[i], trial[i], now[i]);
        r.kept -= weight * (1.0 - kept[i]);
    }
}

// Two points k symmetric about the mid-surface, or the point on it: new stresses; adds the old stresses to the resultants `before`.
template <Law law, int n>
CRUMPLE_INLINE void update_mirrored(const Part& part, const int (&k)[n], const ElasticStep& step, const StrainIncrement& s, Real thickness,
                                    double dt, Real* slots, Resultants& before, Resultants& returned) {
    const double z = part.z[k[0]], weight = part.weight[k[0]];
    Stress old[n], now[n];
    for (int i = 0; i < n; i++) {
        const Real* point = slots + point_slot(k[i], 0);
        old[i] = {point[stress_x], point[stress_y], point[stress_xy]};
    }
    const Stress& m = step.membrane;
    if constexpr (n == 1) {
        now[0] = {old[0].x + m.x, old[0].y + m.y, old[0].xy + m.xy};
        before.nx += weight * old[0].x;
        before.ny += weight * old[0].y;
        before.nxy += weight * old[0].xy;
    } else {
        const Real bx = z * step.bending.x, by = z * step.bending.y, bxy = z * step.bending.xy;
        now[0] = {old[0].x + (m.x + bx), old[0].y + (m.y + by), old[0].xy + (m.xy + bxy)};
        now[1] = {old[1].x + (m.x - bx), old[1].y + (m.y - by), old[1].xy + (m.xy - bxy)};
        before.nx += weight * (old[0].x + old[1].x);
        before.ny += weight * (old[0].y + old[1].y);
        before.nxy += weight * (old[0].xy + old[1].xy);
        before.mx += (weight * z) * (old[0].x - old[1].x);
        before.my += (weight * z) * (old[0].y - old[1].y);
        before.mxy += (weight * z) * (old[0].xy - old[1].xy);
    }
    if constexpr (law != Law::elastic) return_points<law>(part, k, s, thickness, dt, old, now, slots, returned);
    for (int i = 0; i < n; i++) {
        Real* point = slots + point_slot(k[i], 0);
        point[stress_x] = now[i].x;
        point[stress_y] = now[i].y;
        point[stress_xy] = now[i].xy;
    }
}

// points > 0: number of points, unrolled by the compiler; 0: as many as the part has.  The rule is symmetric, so the elastic change of
// the resultants is known in closed form, and only the change by the plastic return is summed over the points.
template <Law law, int points>
CRUMPLE_INLINE Resultants update_points(const Part& part, const StrainIncrement& s, Real thickness, double dt, Real* slots) {
    const int count = points > 0 ? points : part.points;
    const ElasticStep step = elastic_step(part, s, thickness);
    Resultants before, r;
    r.kept = all(1.0);
#pragma GCC unroll 5
    for (int k = 0; k < count / 2; k++) {
        const int pair[2] = {k, count - 1 - k};
        update_mirrored<law>(part, pair, step, s, thickness, dt, slots, before, r);
    }
    if (count % 2 == 1) {
        const int middle[1] = {count / 2};
        update_mirrored<law>(part, middle, step, s, thickness, dt, slots, before, r);
    }
    const Stress &m = step.membrane, &b = step.bending;
    r.nx += before.nx + m.x;
    r.ny += before.ny + m.y;
    r.nxy += before.nxy + m.xy;
    r.mx += before.mx + part.second_moment * b.x;
    r.my += before.my + part.second_moment * b.y;
    r.mxy += before.mxy + part.second_moment * b.xy;
    // work with the mean of old and new stress
    r.internal = 0.5 * (((before.nx + r.nx) * s.xx + (before.ny + r.ny) * s.yy + (before.nxy + r.nxy) * s.xy) +
                        thickness * ((before.mx + r.mx) * s.kx + (before.my + r.my) * s.ky + (before.mxy + r.mxy) * s.kxy));
    return r;
}

}  // namespace
}  // namespace crumple::shell
