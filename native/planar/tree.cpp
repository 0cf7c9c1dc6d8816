#include "planar/tree.hpp"

#include <cmath>

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// sine and cosine: power series to round-off for small angles, library functions otherwise
inline void sine_cosine(Real a, Real& s, Real& c) {
    if (fabs(a) > 0.125) {
        s = sin(a);
        c = cos(a);
        return;
    }
    const Real b = a * a;
    s = a - a * b * (1.0 / 6 - b * (1.0 / 120 - b * (1.0 / 5040 - b * (1.0 / 362880))));
    c = 1 - b * (0.5 - b * (1.0 / 24 - b * (1.0 / 720 - b * (1.0 / 40320 - b * (1.0 / 3628800)))));
}

// Inverse of a symmetric positive definite 3x3 matrix, stored full.
void invert(const Inertia& a, Real* out) {
    const Real p = a.xx * a.yy - a.xy * a.xy, q = a.ry * a.xy - a.rx * a.yy, r = a.rx * a.xy - a.ry * a.xx;
    const Real d = 1 / (a.rr * p + a.rx * q + a.ry * r);
    out[0] = p * d;
    out[1] = out[3] = q * d;
    out[2] = out[6] = r * d;
    out[4] = (a.rr * a.yy - a.ry * a.ry) * d;
    out[5] = out[7] = (a.rx * a.ry - a.rr * a.xy) * d;
    out[8] = (a.rr * a.xx - a.rx * a.rx) * d;
}

inline Twist carried(Twist parent, Vec2 arm) { return {parent.w, parent.v + turn(parent.w, arm)}; }

}  // namespace

Tree::Tree(std::vector<Body> bodies) : body_(std::move(bodies)) {
    for (auto& body : body_) {
        body.dof = dofs_;
        dofs_ += body.joint == Joint::revolute ? 1 : 3;
    }
}

void Tree::place(const Real* q, Pose* pose) const {
    for (int i = 0; i < bodies(); i++) {
        const Body& b = (*this)[i];
        const Real* qi = q + b.dof;
        Pose& p = pose[i];
        p.phi = qi[0];
        p.origin = b.anchor;
        if (b.parent >= 0) {
            p.phi += pose[b.parent].phi;
            p.origin = pose[b.parent].at(b.anchor);
        }
        if (b.joint == Joint::free) p.origin = p.origin + Vec2{qi[1], qi[2]};
        p.s = sin(p.phi);
        p.c = cos(p.phi);
    }
}

void Tree::place_after(const Pose* from, const Real* q, Pose* pose) const {
    for (int i = 0; i < bodies(); i++) {
        const Body& b = (*this)[i];
        const Pose& f = from[i];
        Pose& p = pose[i];
        p.phi = q[b.dof];
        p.origin = b.anchor;
        if (b.parent >= 0) {
            p.phi += pose[b.parent].phi;
            p.origin = pose[b.parent].at(b.anchor);
        }
        if (b.joint == Joint::free) p.origin = p.origin + Vec2{q[b.dof + 1], q[b.dof + 2]};
        Real s, c;
        sine_cosine(p.phi - f.phi, s, c);
        const Real cosine = f.c * c - f.s * s, sine = f.s * c + f.c * s;
        // normalise: rounding errors of cosine and sine would accumulate
        const Real unit = (3 - cosine * cosine - sine * sine) / 2;
        p.c = unit * cosine;
        p.s = unit * sine;
    }
}

void Tree::place_ahead(const Pose* from, const Real* q, const Real* dq, Pose* middle, Pose* end) const {
    for (int i = 0; i < bodies(); i++) {
        const Body& b = (*this)[i];
        const Pose& f = from[i];
        Pose &m = middle[i], &e = end[i];
        Real turn = dq[b.dof];
        m.origin = e.origin = b.anchor;
        if (b.parent >= 0) {
            turn += middle[b.parent].phi - from[b.parent].phi;
            m.origin = middle[b.parent].at(b.anchor);
            e.origin = end[b.parent].at(b.anchor);
        }
        if (b.joint == Joint::free) {
            const Vec2 moved{dq[b.dof + 1], dq[b.dof + 2]}, to = Vec2{q[b.dof + 1], q[b.dof + 2]} + moved;
            m.origin = m.origin + to;
            e.origin = e.origin + to + moved;
        }
        Real s, c;
        sine_cosine(turn, s, c);
        m.phi = f.phi + turn;
        m.c = f.c * c - f.s * s;
        m.s = f.s * c + f.c * s;
        // the same rotation again, from the middle to the end
        e.phi = m.phi + turn;
        e.c = m.c * c - m.s * s;
        e.s = m.s * c + m.c * s;
    }
}

void Tree::twists(const Pose* pose, const Real* w, Twist* twist) const {
    for (int i = 0; i < bodies(); i++) {
        const Body& b = (*this)[i];
        Twist t;
        if (b.parent >= 0) t = carried(twist[b.parent], pose[i].origin - pose[b.parent].origin);
        t.w += w[b.dof];
        if (b.joint == Joint::free) t.v = t.v + Vec2{w[b.dof + 1], w[b.dof + 2]};
        twist[i] = t;
    }
}

void Tree::to_centres(const Pose* pose, Twist* twist) const {
    for (int i = 0; i < bodies(); i++) twist[i] = carried(twist[i], pose[i].turned((*this)[i].centre));
}

ArticulatedSolver::ArticulatedSolver(const Tree& tree)
    : tree_(tree),
      row_(static_cast<size_t>(tree.bodies())),
      own_(static_cast<size_t>(tree.bodies())),
      articulated_(static_cast<size_t>(tree.bodies())),
      rhs_(static_cast<size_t>(tree.bodies())),
      twist_(static_cast<size_t>(tree.bodies())),
      free_factor_(static_cast<size_t>(9 * tree.bodies())) {}

void ArticulatedSolver::place(const Pose* pose) {
    for (int i = 0; i < tree_.bodies(); i++) {
        const Body& b = tree_[i];
        const Vec2 c = pose[i].turned(b.centre), mc = b.mass * c;
        own_[static_cast<size_t>(i)] = {b.inertia + dot(c, mc), -mc.y, mc.x, b.mass, 0, b.mass};
        row_[static_cast<size_t>(i)].arm = b.parent >= 0 ? pose[i].origin - pose[b.parent].origin : Vec2{};
    }
}

// Eliminates joint i after all bodies further out, and adds the remaining articulated inertia to the parent.
inline void ArticulatedSolver::eliminate(int i, const Real* impedance) {
    const Body& b = tree_[i];
    Inertia& a = articulated_[static_cast<size_t>(i)];
    Row& row = row_[static_cast<size_t>(i)];
    const Real* z = impedance + b.dof;
    if (b.joint == Joint::free) {  // its parent is the ground, to which nothing is added
        a.rr += z[0];
        a.xx += z[1];
        a.yy += z[2];
        invert(a, &free_factor_[static_cast<size_t>(9 * i)]);
        return;
    }
    row.rr = a.rr;
    row.rx = a.rx;
    row.ry = a.ry;
    row.inverse = 1 / (a.rr + z[0]);
    row.kept = z[0] * row.inverse;
    if (b.parent < 0) return;
    const Vec2 r = row.arm;
    const Real fx = a.rx * row.inverse, fy = a.ry * row.inverse;
    const Real xx = a.xx - a.rx * fx, xy = a.xy - a.rx * fy, yy = a.yy - a.ry * fy;
    const Real kx = a.rx * row.kept, ky = a.ry * row.kept;
    const Real rx = kx - r.y * xx + r.x * xy, ry = ky - r.y * xy + r.x * yy;
    Inertia& p = articulated_[static_cast<size_t>(b.parent)];
    p.rr += a.rr * row.kept + r.x * (ky + ry) - r.y * (kx + rx);
    p.rx += rx;
    p.ry += ry;
    p.xx += xx;
    p.xy += xy;
    p.yy += yy;
}

inline void ArticulatedSolver::eliminate_impulse(int i, Twist* b, const Real* r) {
    const Body& body = tree_[i];
    if (body.joint == Joint::free) return;
    const Row& row = row_[static_cast<size_t>(i)];
    const Real u = r[body.dof] + b[i].w;
    rhs_[static_cast<size_t>(i)] = u;
    if (body.parent < 0) return;
    const Real g = u * row.inverse;
    const Vec2 linear{b[i].v.x - row.rx * g, b[i].v.y - row.ry * g};
    Twist& p = b[body.parent];
    p.w += b[i].w * row.kept - row.rr * row.inverse * r[body.dof] + cross(row.arm, linear);
    p.v = p.v + linear;
}

void ArticulatedSolver::solve(const Real* impedance, Twist* b, const Real* r, Real* w) {
    articulated_ = own_;
    for (int i = tree_.bodies() - 1; i >= 0; i--) {
        eliminate(i, impedance);
        eliminate_impulse(i, b, r);
    }
    substitute(b, r, w);
}

void ArticulatedSolver::solve_again(Twist* b, const Real* r, Real* w) {
    for (int i = tree_.bodies() - 1; i >= 0; i--) eliminate_impulse(i, b, r);
    substitute(b, r, w);
}

void ArticulatedSolver::substitute(const Twist* b, const Real* r, Real* w) {
    for (int i = 0; i < tree_.bodies(); i++) {
        const Body& body = tree_[i];
        const Row& row = row_[static_cast<size_t>(i)];
        Twist t;
        if (body.parent >= 0) t = carried(twist_[static_cast<size_t>(body.parent)], row.arm);
        if (body.joint == Joint::free) {
            // the motion relative to the ground is solved directly: the parent of a free body is the ground
            const Real* f = &free_factor_[static_cast<size_t>(9 * i)];
            const Real b0 = b[i].w + r[body.dof], b1 = b[i].v.x + r[body.dof + 1], b2 = b[i].v.y + r[body.dof + 2];
            Real* wi = w + body.dof;
            for (int k = 0; k < 3; k++) wi[k] = f[3 * k] * b0 + f[3 * k + 1] * b1 + f[3 * k + 2] * b2;
            t.w += wi[0];
            t.v = t.v + Vec2{wi[1], wi[2]};
        } else {
            const Real rate = (rhs_[static_cast<size_t>(i)] - row.rr * t.w - row.rx * t.v.x - row.ry * t.v.y) * row.inverse;
            w[body.dof] = rate;
            t.w += rate;
        }
        twist_[static_cast<size_t>(i)] = t;
    }
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
