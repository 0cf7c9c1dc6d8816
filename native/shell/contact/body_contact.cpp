#include "shell/contact/body_contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::shell {

namespace {

// Sum of the weights of all contacts relative to the mass that they accelerate: the resulting stiffness is then a tenth below the
// requested one.  Much larger values would make the forces on single nodes change with every step.
constexpr double firmness = 10.0;
// Least cosine of the angle between guide and normal that counts where the set is held: an obstacle that grazes it along its guide
// would otherwise be wedged with a force without limit.
constexpr double least_slope = 0.1;
// Damping ratio of the friction springs: critical, so that a sticking contact does not rebound.
constexpr double stick_damping = 1.0;
// The active set of the pressures converges in two or three iterations; the weights of sliding contacts converge to this relative
// tolerance in a few more.
constexpr int most_rounds = 20;
constexpr double settled_share = 1e-3;

// Accelerations of a body (translation of its centre, rotation) and, from the seventh on, of the obstacles with a mass that touch
// it, along their guides; or the generalised forces conjugate to them.
using Many = std::vector<double>;
struct Matrix {
    std::size_t size;
    std::vector<double> m = std::vector<double>(size * size, 0.0);
    double& operator()(std::size_t i, std::size_t j) { return m[size * i + j]; }
};

// acceleration of the body at a contact relative to the obstacle
Vec3 at(const Many& a, const BodyTouch& t) {
    const Vec3 body = read3(a.data()) + cross(read3(a.data() + 3), t.arm);
    return t.partner < 0 ? body : body - a[6 + std::size_t(t.partner)] * t.guide;
}

void add(Many& sum, Vec3 force, const BodyTouch& t) {
    add3(sum.data(), force);
    add3(sum.data() + 3, cross(t.arm, force));
    if (t.partner >= 0) sum[6 + std::size_t(t.partner)] -= dot(force, t.guide);
}

// adds w b b^T with b.a the relative acceleration along `direction`
void add_row(Matrix& H, double w, Vec3 direction, const BodyTouch& t) {
    Many b(H.size);
    add(b, direction, t);
    for (std::size_t i = 0; i < H.size; i++)
        for (std::size_t j = 0; j < H.size; j++) H(i, j) += w * b[i] * b[j];
}

Matrix inertia_of(const RigidBody& body, const RigidState& s, const std::vector<double>& partners) {
    Matrix M{6 + partners.size()};
    const Mat3 J = world_inertia(body, s.rotation);
    for (std::size_t i = 0; i < 3; i++) {
        M(i, i) = body.mass;
        for (std::size_t j = 0; j < 3; j++) M(3 + i, 3 + j) = J.m[3 * i + j];
    }
    for (std::size_t i = 0; i < partners.size(); i++) M(6 + i, 6 + i) = partners[i];
    return M;
}

// solves H a = f by Cholesky factorisation; held components of the body do not accelerate
Many solved(Matrix H, Many f, unsigned held) {
    const std::size_t n = H.size;
    for (std::size_t i = 0; i < 6; i++) {
        if (!(held & (1u << i))) continue;
        for (std::size_t j = 0; j < n; j++) H(i, j) = H(j, i) = 0.0;
        H(i, i) = 1.0;
        f[i] = 0.0;
    }
    for (std::size_t i = 0; i < n; i++)
        for (std::size_t j = 0; j <= i; j++) {
            double sum = H(i, j);
            for (std::size_t k = 0; k < j; k++) sum -= H(i, k) * H(j, k);
            H(i, j) = i == j ? std::sqrt(sum) : sum / H(j, j);
        }
    for (std::size_t i = 0; i < n; i++) {
        for (std::size_t k = 0; k < i; k++) f[i] -= H(i, k) * f[k];
        f[i] /= H(i, i);
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; k++) f[i] -= H(k, i) * f[k];
        f[i] /= H(i, i);
    }
    return f;
}

// Mass that a force along the normal accelerates: 1 / (1/m + 1/M), without the part of a set that a support holds.
double moved_mass(const RigidBody& body, const std::vector<double>& partners, const BodyTouch& t) {
    if (t.partner < 0) return body.mass;
    const double free[3] = {body.held & 1u ? 0.0 : t.normal.x, body.held & 2u ? 0.0 : t.normal.y, body.held & 4u ? 0.0 : t.normal.z};
    const double along = dot(t.normal, t.guide);
    const double inverse = (free[0] * free[0] + free[1] * free[1] + free[2] * free[2]) / body.mass +
                           along * along / partners[std::size_t(t.partner)];
    return 1.0 / std::max(inverse, least_slope * least_slope / partners[std::size_t(t.partner)]);
}

// Accelerations that a contact requests, divided by 1 + c dt for the implicit dampers, and their weights.
struct Asked {
    double normal, weight;
    Vec3 tangent;
    double tangent_weight;
};

// Pressures by an active-set iteration: a contact pushes if the other contacts do not give it the requested acceleration.
void press(const RigidBody& body, const Matrix& M, const std::vector<Asked>& asked, std::vector<BodyTouch>& touches) {
    std::vector<std::uint8_t> pushes(touches.size(), 1), now(touches.size());
    Many a;
    for (int round = 0; round < most_rounds; round++) {
        Matrix H = M;
        Many f(M.size);
        for (std::size_t i = 0; i < touches.size(); i++) {
            if (!pushes[i]) continue;
            add_row(H, asked[i].weight, touches[i].normal, touches[i]);
            add(f, (asked[i].weight * asked[i].normal) * touches[i].normal, touches[i]);
        }
        a = solved(H, f, body.held);
        for (std::size_t i = 0; i < touches.size(); i++) now[i] = asked[i].normal > dot(touches[i].normal, at(a, touches[i]));
        if (now == pushes) break;
        pushes = now;
    }
    for (std::size_t i = 0; i < touches.size(); i++) {
        const double missing = asked[i].normal - dot(touches[i].normal, at(a, touches[i]));
        touches[i].force = (asked[i].weight * std::max(missing, 0.0)) * touches[i].normal;
    }
}

Vec3 in_plane(Vec3 v, Vec3 normal) { return v - dot(v, normal) * normal; }

// Friction: the force that would make every contact stick, limited by Coulomb's law.  Iteratively reweighted least squares: each
// iteration gives a sliding contact the weight with which its force lies at the limit.  The direction of friction thus follows
// the motion of the coming step; the direction of the last motion would make a set of small inertia oscillate.
void rub(const RigidBody& body, const Matrix& M, const std::vector<Asked>& asked, double friction_damper,
         std::vector<BodyTouch>& touches) {
    std::vector<double> weight(touches.size());
    std::vector<Vec3> force(touches.size());
    for (std::size_t i = 0; i < touches.size(); i++) weight[i] = touches[i].friction > 0.0 ? asked[i].tangent_weight : 0.0;
    bool settled = false;
    for (int round = 0; round < most_rounds && !settled; round++) {
        Matrix H = M;
        Many f(M.size);
        for (std::size_t i = 0; i < touches.size(); i++) {
            if (!(weight[i] > 0.0)) continue;
            const BodyTouch& t = touches[i];
            const Vec3 rows[3] = {in_plane({1, 0, 0}, t.normal), in_plane({0, 1, 0}, t.normal), in_plane({0, 0, 1}, t.normal)};
            for (Vec3 row : rows) add_row(H, weight[i], row, t);
            add(f, weight[i] * asked[i].tangent, t);
        }
        const Many a = solved(H, f, body.held);
        settled = true;
        for (std::size_t i = 0; i < touches.size(); i++) {
            const BodyTouch& t = touches[i];
            if (!(weight[i] > 0.0)) continue;
            const Vec3 missing = asked[i].tangent - in_plane(at(a, t), t.normal);
            const double limit = t.friction * norm(t.force), size = norm(missing);
            const double next = std::min(asked[i].tangent_weight, size > 0.0 ? limit / size : asked[i].tangent_weight);
            settled &= std::abs(next - weight[i]) <= settled_share * weight[i];
            force[i] = std::min(weight[i], next) * missing;
            weight[i] = next;
        }
    }
    for (std::size_t i = 0; i < touches.size(); i++) {
        BodyTouch& t = touches[i];
        // limit the spring to what corresponds to the Coulomb limit
        const double most = (1.0 + friction_damper) * norm(force[i]) / asked[i].tangent_weight;
        if (weight[i] < asked[i].tangent_weight) t.stick = std::min(1.0, most / norm(t.stick)) * t.stick;
        t.force = t.force + force[i];
    }
}

}  // namespace

void hold(const RigidBody& body, const RigidState& state, const std::vector<double>& partners, double stiffness, double step,
          std::vector<BodyTouch>& touches) {
    const Matrix M = inertia_of(body, state, partners);
    const double root = std::sqrt(stiffness), rubbing = 2.0 * stick_damping * root;
    std::vector<Asked> asked;
    bool rough = false;
    for (BodyTouch& t : touches) {
        // the damper acts on the velocity after the step (implicit), so that it may be strong enough for an impact without rebound
        const double damper = 2.0 * t.damping * root, implicit = 1.0 + damper * step, approach = dot(t.slip, t.normal);
        const Vec3 tangent = t.slip - approach * t.normal;
        t.stick = in_plane(t.stick, t.normal) - (stiffness * step) * tangent;
        const double normal = wanted(t, stiffness) / implicit;
        const Vec3 held = (1.0 / (1.0 + rubbing * step)) * (t.stick - rubbing * tangent);
        const double weight = firmness * moved_mass(body, partners, t) * t.share;
        asked.push_back({normal, weight * implicit, held, weight * (1.0 + rubbing * step)});
        rough |= t.friction > 0.0;
    }
    press(body, M, asked, touches);
    if (rough) rub(body, M, asked, rubbing * step, touches);
}

}  // namespace crumple::shell
