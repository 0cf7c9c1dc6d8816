// The thickness points: stress update of each, integrated to resultants.
#pragma once
#include "kinematics.hpp"
#include "plasticity.hpp"

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

template <Law law>
CRUMPLE_INLINE void update_point(const Part& part, int k, const StrainIncrement& s, Real thickness, double dt, Real* slots,
                                 Resultants& r) {
    const double z = part.z[k], weight = part.weight[k];
    const Real zt = z * thickness;
    const Real ex = s.xx + zt * s.kx, ey = s.yy + zt * s.ky, exy = s.xy + zt * s.kxy;
    Real* point = slots + point_slot(k, 0);
    const Stress old = {point[stress_x], point[stress_y], point[stress_xy]};
    // elastic trial
    const double C = part.plane_modulus, nu = part.poissons_ratio;
    Stress now = {old.x + C * (ex + nu * ey), old.y + C * (ey + nu * ex), old.xy + part.shear_modulus * exy};
    // return to the yield surface
    Returned plastic;
    if constexpr (law == Law::linear) plastic = return_linear(part, old, now, point[plastic_strain]);
    if constexpr (law == Law::general) {
        Real factor = all(1.0);
        if (part.rate != Rate::none) {
            const Real e2 = (4.0 / 3.0) * (ex * ex + ey * ey + ex * ey + 0.25 * exy * exy);
            factor = rate_factor(part, slots[rate_slot(part.points, k)], root(e2), dt);
        }
        plastic = return_general(part, old, now, point[plastic_strain], factor);
    }
    r.plastic += weight * plastic.work;
    r.kept += weight * plastic.kept;
    point[stress_x] = now.x;
    point[stress_y] = now.y;
    point[stress_xy] = now.xy;
    r.internal += weight * ((old.x + now.x) * ex + (old.y + now.y) * ey + (old.xy + now.xy) * exy);
    r.nx += weight * now.x;
    r.ny += weight * now.y;
    r.nxy += weight * now.xy;
    r.mx += (weight * z) * now.x;
    r.my += (weight * z) * now.y;
    r.mxy += (weight * z) * now.xy;
}

// points > 0: the compiler unrolls them; 0: as many as the part has
template <Law law, int points>
CRUMPLE_INLINE Resultants update_points(const Part& part, const StrainIncrement& s, Real thickness, double dt, Real* slots) {
    Resultants r;
    if constexpr (points > 0) {
#pragma GCC unroll 10
        for (int k = 0; k < points; k++) update_point<law>(part, k, s, thickness, dt, slots, r);
    } else {
        for (int k = 0; k < part.points; k++) update_point<law>(part, k, s, thickness, dt, slots, r);
    }
    r.internal *= 0.5;
    return r;
}

}  // namespace
}  // namespace crumple::shell
