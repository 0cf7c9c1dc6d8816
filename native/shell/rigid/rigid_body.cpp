#include "shell/rigid/rigid_body.hpp"

#include <stdexcept>

namespace crumple::shell {

// adds m (r.r 1 - r r^T)
static void add_point(Mat3& J, double m, Vec3 r) {
    const double rr = dot(r, r);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) J.m[3 * i + j] += m * ((i == j ? rr : 0.0) - r[i] * r[j]);
}

RigidBody make_body(const Model& model, const RigidSet& set, const Masses& masses) {
    RigidBody b;
    b.nodes = set.nodes;
    b.held = set.fixed;
    b.mass = set.added_mass;
    Vec3 moment = set.added_mass * set.added_at;
    for (Index n : set.nodes) {
        b.mass += masses.mass[n];
        moment = moment + masses.mass[n] * read3(&model.position[3 * n]);
    }
    if (!(b.mass > 0.0)) throw std::invalid_argument("a rigid set has no mass");
    const Vec3 of_mass = (1.0 / b.mass) * moment;
    b.centre0 = set.pinned ? set.pin : of_mass;
    b.mass_arm = of_mass - b.centre0;
    const double* a = set.added_inertia;
    b.inertia = Mat3{{a[0], a[3], a[5], a[3], a[1], a[4], a[5], a[4], a[2]}};
    add_point(b.inertia, set.added_mass, set.added_at - b.centre0);
    for (Index n : set.nodes) {
        b.arm.push_back(read3(&model.position[3 * n]) - b.centre0);
        b.member_inertia.push_back(masses.inertia[n]);
        add_point(b.inertia, masses.mass[n], b.arm.back());
        for (int i = 0; i < 3; i++) b.inertia.m[4 * i] += masses.inertia[n];
    }
    return b;
}

void push(const RigidBody& b, RigidState& s, const Masses& masses, const double* velocity, const double* spin) {
    double mass = 0.0;
    Vec3 moment, momentum;
    for (std::size_t k = 0; k < b.nodes.size(); k++) {
        const Index n = b.nodes[k];
        mass += masses.mass[n];
        moment = moment + masses.mass[n] * (s.rotation * b.arm[k]);
        momentum = momentum + masses.mass[n] * read3(velocity + 3 * n);
    }
    if (!(mass > 0.0)) return;
    // motion of the members alone, about their own centre; the added mass moves with them
    const Vec3 centre = (1.0 / mass) * moment;
    Mat3 J{{0, 0, 0, 0, 0, 0, 0, 0, 0}};
    Vec3 L;
    for (std::size_t k = 0; k < b.nodes.size(); k++) {
        const Index n = b.nodes[k];
        const Vec3 r = s.rotation * b.arm[k] - centre;
        add_point(J, masses.mass[n], r);
        for (int i = 0; i < 3; i++) J.m[4 * i] += b.member_inertia[k];
        L = L + masses.mass[n] * cross(r, read3(velocity + 3 * n)) + b.member_inertia[k] * read3(spin + 3 * n);
    }
    const Vec3 omega = solve(J, L), there = (1.0 / mass) * momentum - cross(omega, centre);
    // a pin takes up linear momentum but no moment about itself
    const Vec3 turned = b.mass * cross(s.rotation * b.mass_arm, there);
    const Vec3 v = s.velocity + there, w = s.omega + omega + solve(world_inertia(b, s.rotation), turned);
    double free[6];
    for (int i = 0; i < 3; i++) {
        free[i] = b.held & (1u << i) ? s.velocity[i] : v[i];
        free[i + 3] = b.held & (8u << i) ? s.omega[i] : w[i];
    }
    s.velocity = read3(free);
    s.omega = read3(free + 3);
    s.angular_momentum = world_inertia(b, s.rotation) * s.omega;
}

// rigid motion with the linear and angular momentum of the members
RigidState start_body(const RigidBody& b, const Model& model, const Masses& masses) {
    RigidState s;
    s.centre = b.centre0;
    push(b, s, masses, model.velocity.data(), model.spin.data());
    return s;
}

Mat3 world_inertia(const RigidBody& b, const Mat3& Q) { return Q * b.inertia * transposed(Q); }

Vec3 omega_of(const RigidBody& b, const Mat3& Q, Vec3 L, Vec3 held) {
    Mat3 J = world_inertia(b, Q);
    double rhs[3] = {L.x, L.y, L.z};
    // rows of held components become omega = given
    for (int i = 0; i < 3; i++) {
        if (!(b.held & (8u << i))) continue;
        rhs[i] = held[i];
        for (int j = 0; j < 3; j++) J.m[3 * i + j] = i == j ? 1.0 : 0.0;
    }
    return solve(J, {rhs[0], rhs[1], rhs[2]});
}

// rotation of the Cayley transform of a rotation vector
static Mat3 cayley(Vec3 a) {
    const Vec3 h = 0.5 * a;
    const double s = 2.0 / (1.0 + dot(h, h)), c = 1.0 - s * dot(h, h);
    return Mat3{{c + s * h.x * h.x, s * (h.x * h.y - h.z), s * (h.x * h.z + h.y),
                 s * (h.x * h.y + h.z), c + s * h.y * h.y, s * (h.y * h.z - h.x),
                 s * (h.x * h.z - h.y), s * (h.y * h.z + h.x), c + s * h.z * h.z}};
}

// one Newton iteration for the polar factor: keeps the columns orthonormal despite round-off
static Mat3 straightened(const Mat3& Q) {
    const Mat3 g = transposed(Q) * Q;
    Mat3 half;
    for (int i = 0; i < 9; i++) half.m[i] = (i % 4 == 0 ? 1.5 : 0.0) - 0.5 * g.m[i];
    return Q * half;
}

void drift(const RigidBody& b, RigidState& s, double dt, Vec3 held) {
    Mat3 next = s.rotation;
    if (b.held & 0x38u) {
        s.omega = omega_of(b, s.rotation, s.angular_momentum, held);
        next = cayley(dt * s.omega) * s.rotation;
        const Vec3 L = world_inertia(b, next) * s.omega;
        s.angular_momentum = {b.held & 8u ? L.x : s.angular_momentum.x, b.held & 16u ? L.y : s.angular_momentum.y,
                              b.held & 32u ? L.z : s.angular_momentum.z};
    } else {
        // body rate at the midpoint: J omega = mean of the body momenta at both ends
        const Vec3 before = transposed_times(s.rotation, s.angular_momentum);
        Vec3 rate = solve(b.inertia, before);
        for (int i = 0; i < 20; i++) {
            const Vec3 after = transposed_times(cayley(dt * rate), before), old = rate;
            rate = solve(b.inertia, 0.5 * (before + after));
            if (norm(rate - old) <= 1e-16 * norm(rate)) break;
        }
        next = s.rotation * cayley(dt * rate);
        s.omega = s.rotation * rate;
    }
    s.rotation = straightened(next);
    s.centre = s.centre + dt * s.velocity;
}

}  // namespace crumple::shell
