#include "multibody/tree.hpp"

#include <cmath>

namespace crumple::multibody {

namespace {

// sine and cosine of a small angle to round-off, else the library's
inline void sine_cosine(double a, double& s, double& c) {
    if (std::fabs(a) > 0.125) {
        s = std::sin(a);
        c = std::cos(a);
        return;
    }
    const double b = a * a;
    s = a * (1 - b / 6 * (1 - b / 20 * (1 - b / 42 * (1 - b / 72 * (1 - b / 110)))));
    c = 1 - b / 2 * (1 - b / 12 * (1 - b / 30 * (1 - b / 56 * (1 - b / 90 * (1 - b / 132)))));
}

// Inverse of a symmetric positive definite 3x3 matrix, stored full.
void invert(const Inertia& a, double* out) {
    const double p = a.xx * a.yy - a.xy * a.xy, q = a.ry * a.xy - a.rx * a.yy, r = a.rx * a.xy - a.ry * a.xx;
    const double d = 1 / (a.rr * p + a.rx * q + a.ry * r);
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

void Tree::place(const double* q, Pose* pose) const {
    for (int i = 0; i < bodies(); i++) {
        const Body& b = (*this)[i];
        const double* qi = q + b.dof;
        Pose& p = pose[i];
        p.phi = qi[0];
        p.origin = b.anchor;
        if (b.parent >= 0) {
            p.phi += pose[b.parent].phi;
            p.origin = pose[b.parent].at(b.anchor);
        }
        if (b.joint == Joint::free) p.origin = p.origin + Vec2{qi[1], qi[2]};
        p.s = std::sin(p.phi);
        p.c = std::cos(p.phi);
    }
}

void Tree::place_near(const Pose* from, const double* q, const double* dq, Pose* pose) const {
    for (int i = 0; i < bodies(); i++) {
        const Body& b = (*this)[i];
        Pose& p = pose[i];
        double dphi = dq[b.dof];
        p.origin = b.anchor;
        if (b.parent >= 0) {
            dphi += pose[b.parent].phi - from[b.parent].phi;
            p.origin = pose[b.parent].at(b.anchor);
        }
        if (b.joint == Joint::free) {
            p.origin = p.origin + Vec2{q[b.dof + 1] + dq[b.dof + 1], q[b.dof + 2] + dq[b.dof + 2]};
        }
        double s, c;
        sine_cosine(dphi, s, c);
        p.phi = from[i].phi + dphi;
        p.c = from[i].c * c - from[i].s * s;
        p.s = from[i].s * c + from[i].c * s;
    }
}

void Tree::twists(const Pose* pose, const double* w, Twist* twist) const {
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
      articulated_(static_cast<size_t>(tree.bodies())),
      rhs_(static_cast<size_t>(tree.bodies())),
      twist_(static_cast<size_t>(tree.bodies())),
      free_factor_(static_cast<size_t>(9 * tree.bodies())) {}

void ArticulatedSolver::absorb(int parent, const Inertia& a, Vec2 r) {
    Inertia& p = articulated_[static_cast<size_t>(parent)];
    const double rx = a.rx - r.y * a.xx + r.x * a.xy, ry = a.ry - r.y * a.xy + r.x * a.yy;
    p.rr += a.rr + r.x * (a.ry + ry) - r.y * (a.rx + rx);
    p.rx += rx;
    p.ry += ry;
    p.xx += a.xx;
    p.xy += a.xy;
    p.yy += a.yy;
}

void ArticulatedSolver::factor(const Pose* pose, const double* impedance) {
    const int n = tree_.bodies();
    for (int i = 0; i < n; i++) {
        const Body& b = tree_[i];
        const Vec2 c = pose[i].turned(b.centre), mc = b.mass * c;
        articulated_[static_cast<size_t>(i)] = {b.inertia + dot(c, mc), -mc.y, mc.x, b.mass, 0, b.mass};
    }
    for (int i = n - 1; i >= 0; i--) {
        const Body& b = tree_[i];
        Inertia a = articulated_[static_cast<size_t>(i)];
        Row& row = row_[static_cast<size_t>(i)];
        row.arm = b.parent >= 0 ? pose[i].origin - pose[b.parent].origin : Vec2{};
        const double* z = impedance + b.dof;
        if (b.joint == Joint::free) {
            a.rr += z[0];
            a.xx += z[1];
            a.yy += z[2];
            invert(a, &free_factor_[static_cast<size_t>(9 * i)]);
            continue;  // a free body hands nothing to its parent
        }
        row.rr = a.rr;
        row.rx = a.rx;
        row.ry = a.ry;
        row.inverse = 1 / (a.rr + z[0]);
        row.kept = z[0] * row.inverse;
        if (b.parent < 0) continue;
        const double fx = a.rx * row.inverse, fy = a.ry * row.inverse;
        absorb(b.parent,
               {a.rr * row.kept, a.rx * row.kept, a.ry * row.kept, a.xx - a.rx * fx, a.xy - a.rx * fy, a.yy - a.ry * fy},
               row.arm);
    }
}

void ArticulatedSolver::solve(Twist* b, const double* r, double* w) {
    const int n = tree_.bodies();
    for (int i = n - 1; i >= 0; i--) {
        const Body& body = tree_[i];
        const Row& row = row_[static_cast<size_t>(i)];
        if (body.joint == Joint::free) continue;
        const double u = r[body.dof] + b[i].w;
        rhs_[static_cast<size_t>(i)] = u;
        if (body.parent < 0) continue;
        const double g = u * row.inverse;
        const Vec2 linear{b[i].v.x - row.rx * g, b[i].v.y - row.ry * g};
        Twist& p = b[body.parent];
        p.w += b[i].w * row.kept - row.rr * row.inverse * r[body.dof] + cross(row.arm, linear);
        p.v = p.v + linear;
    }
    for (int i = 0; i < n; i++) {
        const Body& body = tree_[i];
        const Row& row = row_[static_cast<size_t>(i)];
        Twist t;
        if (body.parent >= 0) t = carried(twist_[static_cast<size_t>(body.parent)], row.arm);
        if (body.joint == Joint::free) {
            // the carried motion of a parent is part of the body's own free motion only for ground parents
            const double* f = &free_factor_[static_cast<size_t>(9 * i)];
            const double b0 = b[i].w + r[body.dof], b1 = b[i].v.x + r[body.dof + 1], b2 = b[i].v.y + r[body.dof + 2];
            double* wi = w + body.dof;
            for (int k = 0; k < 3; k++) wi[k] = f[3 * k] * b0 + f[3 * k + 1] * b1 + f[3 * k + 2] * b2;
            t.w += wi[0];
            t.v = t.v + Vec2{wi[1], wi[2]};
        } else {
            const double rate = (rhs_[static_cast<size_t>(i)] - row.rr * t.w - row.rx * t.v.x - row.ry * t.v.y) * row.inverse;
            w[body.dof] = rate;
            t.w += rate;
        }
        twist_[static_cast<size_t>(i)] = t;
    }
}

}  // namespace crumple::multibody
