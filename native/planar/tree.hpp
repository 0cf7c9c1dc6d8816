// Trees of rigid bodies in the plane: mass properties, positions, velocities, and the O(N) solution for joint rates.
//
// Every body has one inboard joint; parents come before children.  A body's frame is aligned with the world axes in the reference
// configuration and has its origin at the inboard joint.  Velocities are twists (rotation rate, velocity of the body's origin) in
// world axes.
//
// The solver minimises  sum_i 1/2 |V_i|^2_{I_i} - b_i.V_i + sum_j 1/2 Z_j w_j^2 - r_j w_j  over the joint rates w, with V = T w:
// Gauss's principle of least constraint for impulses b_i on bodies and r_j on joints, with joint impedances Z_j.
// The articulated-body algorithm solves it in one sweep from the leaves to the root and one sweep back.
#pragma once

#include <cstddef>
#include <vector>

#include "hinge/real.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

using namespace hinge;
using std::size_t;

struct Vec2 {
    Real x = 0, y = 0;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(Real s, Vec2 a) { return {s * a.x, s * a.y}; }
inline Real dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline Real cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline Vec2 turn(Real rate, Vec2 arm) { return {-rate * arm.y, rate * arm.x}; }  // rate times unit normal, crossed with arm

// rotation rate and velocity of a body; also used for angular and linear impulse
struct Twist {
    Real w = 0;
    Vec2 v;
};

// rate along a direction (rotation, x, y) of a point at `arm` from the reference point of the twist `body`
inline Real point_rate(const Twist& direction, const Twist& body, Vec2 arm) {
    return direction.w * body.w + dot(direction.v, body.v + turn(body.w, arm));
}

// symmetric inertia about a point, rows and columns (rotation, x, y)
struct Inertia {
    Real rr = 0, rx = 0, ry = 0, xx = 0, xy = 0, yy = 0;
};

struct Pose {
    Real phi = 0, c = 1, s = 0;  // angle to the reference configuration, its cosine and sine
    Vec2 origin;
    Vec2 turned(Vec2 a) const { return {c * a.x - s * a.y, s * a.x + c * a.y}; }
    Vec2 at(Vec2 a) const { return origin + turned(a); }
};

enum class Joint { revolute, free };

struct Body {
    int parent = -1;  // -1: ground
    Joint joint = Joint::revolute;
    int dof = 0;      // first joint coordinate; revolute has one (rotation), free three (rotation, x, y)
    Vec2 anchor;      // inboard joint in the parent's frame (world for ground)
    Vec2 centre;      // centre of mass in the body's frame
    Real mass = 0, inertia = 0;  // inertia about the centre of mass
};

class Tree {
public:
    explicit Tree(std::vector<Body> bodies);

    int bodies() const { return static_cast<int>(body_.size()); }
    int dofs() const { return dofs_; }
    const Body& operator[](int i) const { return body_[static_cast<size_t>(i)]; }
    Body& body(int i) { return body_[static_cast<size_t>(i)]; }

    // poses from joint coordinates
    void place(const Real* q, Pose* pose) const;
    // poses at q, faster than `place`; `from` holds poses that differ by a small rotation
    void place_after(const Pose* from, const Real* q, Pose* pose) const;
    // poses at q + dq and at q + 2 dq; `from` holds those at q
    void place_ahead(const Pose* from, const Real* q, const Real* dq, Pose* middle, Pose* end) const;
    // twists of the body origins from joint rates
    void twists(const Pose* pose, const Real* w, Twist* twist) const;
    // velocities of the centres of mass (w unchanged) from twists of the origins
    void to_centres(const Pose* pose, Twist* twist) const;

private:
    std::vector<Body> body_;
    int dofs_ = 0;
};

// Factorisation and workspace of the articulated-body recursion.
class ArticulatedSolver {
public:
    explicit ArticulatedSolver(const Tree& tree);
    // sets the configuration for the following solutions
    void place(const Pose* pose);
    // Joint rates w for impedances Z >= 0 of the joint coordinates, body impulses b about the body origins (overwritten) and joint
    // impulses r.
    void solve(const Real* impedance, Twist* b, const Real* r, Real* w);
    // the same for other impulses, with the factorisation of the last `solve`
    void solve_again(Twist* b, const Real* r, Real* w);

private:
    struct Row {
        Real rr, rx, ry;     // column of the articulated inertia for the joint's rotation
        Real inverse;        // 1 / (rr + Z)
        Real kept;           // Z / (rr + Z)
        Vec2 arm;              // from the parent's origin to this body's
    };
    void eliminate(int i, const Real* impedance);
    void eliminate_impulse(int i, Twist* b, const Real* r);
    void substitute(const Twist* b, const Real* r, Real* w);

    const Tree& tree_;
    std::vector<Row> row_;
    std::vector<Inertia> own_, articulated_;  // about the body origins: the body alone, and with all bodies outboard of it
    std::vector<Real> rhs_;
    std::vector<Twist> twist_;
    std::vector<Real> free_factor_;  // inverse 3x3 articulated inertia of every free joint
};

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
