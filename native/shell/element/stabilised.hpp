// Physical stabilisation: resultants of the strains that vary over the element, with the elastic moduli of the material.
//
// Velocities are split as v = linear part + (q/4) h, h = xi eta.  The varying membrane stress is that of in-plane
// bending (uniaxial along each axis), the varying curvature that of bilinear rotations, and the varying transverse
// shear is interpolated from the edges, so that twist causes no shear.  Integrals over the element are those of the
// parallelogram with the same gradients at the centre.  Theory: docs/theory/stabilised_element.md.
#pragma once
#include "shell/element/edge_shear.hpp"
#include "shell/element/hourglass.hpp"
#include "shell/element/points.hpp"

namespace crumple::shell {
namespace {

// Geometry for the transverse shear of the edges, with its mean and varying parts along both natural directions.
struct EdgeShear {
    Vec xi, eta;                 // gradients of the natural coordinates [1/m], in world axes
    Vec n12, n43, n14, n23;      // normals at the middle of the edges
};

CRUMPLE_INLINE EdgeShear edges_of(const Frame& f) {
    EdgeShear s;
    s.xi = 2.0 * ((f.bx2 - f.bx1) * f.e1 + (f.by2 - f.by1) * f.e2);
    s.eta = -2.0 * ((f.bx1 + f.bx2) * f.e1 + (f.by1 + f.by2) * f.e2);
    // perpendicular to the edges even in a warped element, so that a drilling rotation causes no shear
    const Vec px = (0.25 * f.hz) * s.xi, py = (0.25 * f.hz) * s.eta;
    s.n12 = f.e3 + px;
    s.n43 = f.e3 - px;
    s.n14 = f.e3 + py;
    s.n23 = f.e3 - py;
    return s;
}

struct ShearRate {
    Real xz, yz;                 // at the centre [1/s]
    Real xi, eta;                // varying part of the natural components: times eta, times xi [m/s]
};

CRUMPLE_INLINE ShearRate shear_rate(const Frame& f, const EdgeShear& s, const Corners& c) {
    const Real s12 = edge_rate(c, 0, 1, s.n12), s43 = edge_rate(c, 3, 2, s.n43);
    const Real s14 = edge_rate(c, 0, 3, s.n14), s23 = edge_rate(c, 1, 2, s.n23);
    const Vec mean = (0.25 * (s12 + s43)) * s.xi + (0.25 * (s14 + s23)) * s.eta;
    ShearRate r{dot(mean, f.e1), dot(mean, f.e2), {}, {}};
    // constant shear in a trapezoid has varying natural components
    const Real skew = 0.25 * (f.hx * r.xz + f.hy * r.yz);
    r.xi = 0.25 * (s43 - s12) - skew;
    r.eta = 0.25 * (s23 - s14) - skew;
    return r;
}

struct VaryingShear {
    Real xi, eta;                // resultants conjugate to ShearRate::xi and ::eta [N]
};

CRUMPLE_INLINE void add_shear_forces(const Frame& f, const EdgeShear& s, const Vec (&x)[4], Real fxz, Real fyz, const VaryingShear& p,
                                     CornerForces& out) {
    const Real skew = 0.25 * (p.xi + p.eta);
    const Vec mean = (fxz - f.hx * skew) * f.e1 + (fyz - f.hy * skew) * f.e2;
    const Real along_xi = dot(mean, s.xi), along_eta = dot(mean, s.eta);
    add_edge_force(out, x, 0, 1, s.n12, 0.25 * (along_xi - p.xi));
    add_edge_force(out, x, 3, 2, s.n43, 0.25 * (along_xi + p.xi));
    add_edge_force(out, x, 0, 3, s.n14, 0.25 * (along_eta - p.eta));
    add_edge_force(out, x, 1, 2, s.n23, 0.25 * (along_eta + p.eta));
}

struct Stabilisation {
    HourglassForce hourglass;    // z is unused
    VaryingShear shear;
    Real work;                   // [J]
};

// New resultants.  Those of membrane and bending are reduced with the plastic return, transverse shear stays elastic.
CRUMPLE_INLINE Stabilisation stabilise(const Part& part, const Frame& f, const HourglassRate& q, const ShearRate& g, double dt,
                                       const Integrals& in, Real* slots, Real* extra) {
    const double nu = part.poissons_ratio;
    const Real volume = in.volume, thickness = in.thickness, kept = in.r.kept;
    const Real xx = f.bx1 * f.bx1 + f.bx2 * f.bx2, yy = f.by1 * f.by1 + f.by2 * f.by2, xy = f.bx1 * f.by1 + f.bx2 * f.by2;
    const Real membrane = (dt * part.youngs_modulus / 6.0) * volume;
    const Real bending = (dt * part.plane_modulus / 72.0) * volume * thickness * thickness;
    // 4/3 of |grad xi|^2 and |grad eta|^2 over 4
    const Real shear = (dt * part.transverse_modulus * 4.0 / 3.0) * volume;
    const double twist = 0.5 * (1.0 - nu), cross = 0.5 * (1.0 + nu);
    const HourglassForce old = {slots[hourglass_x], slots[hourglass_y], slots[hourglass_z], slots[hourglass_rx], slots[hourglass_ry]};
    const Real old_eta = extra[edge_shear];
    Stabilisation s;
    HourglassForce& now = s.hourglass;
    now.x = kept * (old.x + membrane * (xx * q.x - nu * xy * q.y));
    now.y = kept * (old.y + membrane * (yy * q.y - nu * xy * q.x));
    now.rx = kept * (old.rx + bending * ((yy + twist * xx) * q.rx - cross * xy * q.ry));
    now.ry = kept * (old.ry + bending * ((xx + twist * yy) * q.ry - cross * xy * q.rx));
    const Real b12 = 2.0 * (f.bx1 * f.bx2 + f.by1 * f.by2), bb = xx + yy;
    s.shear.xi = old.z + shear * (bb - b12) * g.xi;
    s.shear.eta = old_eta + shear * (bb + b12) * g.eta;
    now.z = s.shear.xi;
    s.work = (0.5 * dt) * ((old.x + now.x) * q.x + (old.y + now.y) * q.y + (old.rx + now.rx) * q.rx + (old.ry + now.ry) * q.ry +
                           (old.z + s.shear.xi) * g.xi + (old_eta + s.shear.eta) * g.eta);
    slots[hourglass_x] = now.x;
    slots[hourglass_y] = now.y;
    slots[hourglass_z] = now.z;
    slots[hourglass_rx] = now.rx;
    slots[hourglass_ry] = now.ry;
    extra[edge_shear] = s.shear.eta;
    now.z = Real{};
    return s;
}

}  // namespace
}  // namespace crumple::shell
