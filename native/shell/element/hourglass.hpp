// Hourglass control, by stiffness or by viscosity, of the five modes without strain at the single integration point.
//
// Stiffness: the rates of the resultants are proportional to the hourglass rates (Flanagan-Belytschko type, coefficients of Belytschko,
// Lin and Tsay); viscosity: the resultants themselves are.  If thickness points yield, the resultants of stiffness are reduced by the
// mean share of the stress that the points keep, as the stresses elsewhere in the element would be; otherwise they would carry load
// that the metal cannot.  The work done on them is the hourglass energy.  Theory: docs/theory/hourglass.md.
#pragma once
#include "shell/element/kinematics.hpp"

namespace crumple::shell {
namespace {

struct HourglassForce {
    Real x, y, z, rx, ry;
};

struct HourglassRange {
    Real membrane, shear, bending;   // force or moment per hourglass displacement or rate
};

CRUMPLE_INLINE HourglassRange hourglass_stiffness(const Part& part, const Frame& f, Real thickness, Real volume, double dt) {
    const Real bb = dt * 2.0 * (f.bx1 * f.bx1 + f.bx2 * f.bx2 + f.by1 * f.by1 + f.by2 * f.by2);
    const Real tt = thickness * thickness;
    const Real vb = volume * bb;
    return {part.hourglass_moduli[0] * vb, part.hourglass_moduli[1] * (tt * (thickness * bb)), part.hourglass_moduli[2] * (tt * vb)};
}

CRUMPLE_INLINE HourglassRange hourglass_viscosity(const Part& part, const Frame& f, Real thickness) {
    // impedance of a quarter element: density, wave speed, thickness and half a side
    const double impedance = 0.25 * __builtin_sqrt(part.density * part.plane_modulus);
    const Real base = impedance * thickness * root(f.area), tt = thickness * thickness;
    return {part.hourglass_membrane * base, part.hourglass_shear * base * tt / (f.area + tt),
            (part.hourglass_bending / 12.0) * base * tt};
}

// New hourglass resultants; returns the work done on them [J].
CRUMPLE_INLINE Real update_hourglass(const Part& part, const Frame& f, const HourglassRate& rate, double dt, Real thickness,
                                     Real volume, Real kept, Real* slots, HourglassForce& now) {
    const HourglassForce old = {slots[hourglass_x], slots[hourglass_y], slots[hourglass_z], slots[hourglass_rx],
                                slots[hourglass_ry]};
    if (part.viscous_hourglass) {
        const HourglassRange c = hourglass_viscosity(part, f, thickness);
        now = {c.membrane * rate.x, c.membrane * rate.y, c.shear * rate.z, c.bending * rate.rx, c.bending * rate.ry};
    } else {
        const HourglassRange c = hourglass_stiffness(part, f, thickness, volume, dt);
        now = {kept * (old.x + c.membrane * rate.x), kept * (old.y + c.membrane * rate.y), kept * (old.z + c.shear * rate.z),
               kept * (old.rx + c.bending * rate.rx), kept * (old.ry + c.bending * rate.ry)};
    }
    slots[hourglass_x] = now.x;
    slots[hourglass_y] = now.y;
    slots[hourglass_z] = now.z;
    slots[hourglass_rx] = now.rx;
    slots[hourglass_ry] = now.ry;
    return (0.5 * dt) * ((old.x + now.x) * rate.x + (old.y + now.y) * rate.y + (old.z + now.z) * rate.z +
                         (old.rx + now.rx) * rate.rx + (old.ry + now.ry) * rate.ry);
}

}  // namespace
}  // namespace crumple::shell
