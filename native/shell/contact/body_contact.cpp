#include "shell/contact/body_contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::shell {

namespace {

// Sum of the weights of all contacts relative to the set's mass: the resulting stiffness is then a tenth below the requested one.
// Much larger values would make the forces on single nodes change with every step.
constexpr double firmness = 10.0;
// Damping ratio of the friction springs: critical, so that a sticking contact does not rebound.
constexpr double stick_damping = 1.0;
// The active set of the pressures converges in two or three iterations; the weights of sliding contacts converge to this relative
// tolerance in a few more.
constexpr int most_rounds = 20;
constexpr double settled_share = 1e-3;

// Accelerations of a body (translation of its centre, rotation), or the generalised forces conjugate to them.
struct Six {
    double v[6] = {0, 0, 0, 0, 0, 0};
};
struct Matrix {
    double m[6][6] = {};
};

Vec3 at(const Six& a, Vec3 arm) { return read3(a.v) + cross(read3(a.v + 3), arm); }

void add(Six& sum, Vec3 force, Vec3 arm) {
    add3(sum.v, force);
    add3(sum.v + 3, cross(arm, force));
}

// adds w b b^T with b.a the acceleration along `direction` at `arm`
void add_row(Matrix& H, double w, Vec3 direction, Vec3 arm) {
    Six b;
    add(b, direction, arm);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) H.m[i][j] += w * b.v[i] * b.v[j];
}

Matrix inertia_of(const RigidBody& body, const RigidState& s) {
    Matrix M;
    const Mat3 J = world_inertia(body, s.rotation);
    for (int i = 0; i < 3; i++) {
        M.m[i][i] = body.mass;
        for (int j = 0; j < 3; j++) M.m[3 + i][3 + j] = J.m[3 * i + j];
    }
    return M;
}

// solves H a = f by Cholesky factorisation; held components do not accelerate
Six solved(Matrix H, Six f, unsigned held) {
    for (int i = 0; i < 6; i++) {
        if (!(held & (1u << i))) continue;
        for (int j = 0; j < 6; j++) H.m[i][j] = H.m[j][i] = 0.0;
        H.m[i][i] = 1.0;
        f.v[i] = 0.0;
    }
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) {
            double sum = H.m[i][j];
            for (int k = 0; k < j; k++) sum -= H.m[i][k] * H.m[j][k];
            H.m[i][j] = i == j ? std::sqrt(sum) : sum / H.m[j][j];
        }
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < i; k++) f.v[i] -= H.m[i][k] * f.v[k];
        f.v[i] /= H.m[i][i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int k = i + 1; k < 6; k++) f.v[i] -= H.m[k][i] * f.v[k];
        f.v[i] /= H.m[i][i];
    }
    return f;
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
    Six a;
    for (int round = 0; round < most_rounds; round++) {
        Matrix H = M;
        Six f;
        for (std::size_t i = 0; i < touches.size(); i++) {
            if (!pushes[i]) continue;
            add_row(H, asked[i].weight, touches[i].normal, touches[i].arm);
            add(f, (asked[i].weight * asked[i].normal) * touches[i].normal, touches[i].arm);
        }
        a = solved(H, f, body.held);
        for (std::size_t i = 0; i < touches.size(); i++) now[i] = asked[i].normal > dot(touches[i].normal, at(a, touches[i].arm));
        if (now == pushes) break;
        pushes = now;
    }
    for (std::size_t i = 0; i < touches.size(); i++) {
        const double missing = asked[i].normal - dot(touches[i].normal, at(a, touches[i].arm));
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
        Six f;
        for (std::size_t i = 0; i < touches.size(); i++) {
            if (!(weight[i] > 0.0)) continue;
            const BodyTouch& t = touches[i];
            const Vec3 rows[3] = {in_plane({1, 0, 0}, t.normal), in_plane({0, 1, 0}, t.normal), in_plane({0, 0, 1}, t.normal)};
            for (Vec3 row : rows) add_row(H, weight[i], row, t.arm);
            add(f, weight[i] * asked[i].tangent, t.arm);
        }
        const Six a = solved(H, f, body.held);
        settled = true;
        for (std::size_t i = 0; i < touches.size(); i++) {
            const BodyTouch& t = touches[i];
            if (!(weight[i] > 0.0)) continue;
            const Vec3 missing = asked[i].tangent - in_plane(at(a, t.arm), t.normal);
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

void hold(const RigidBody& body, const RigidState& state, double stiffness, double step, std::vector<BodyTouch>& touches) {
    const Matrix M = inertia_of(body, state);
    const double root = std::sqrt(stiffness), rubbing = 2.0 * stick_damping * root;
    std::vector<Asked> asked;
    bool rough = false;
    for (BodyTouch& t : touches) {
        // the damper acts on the velocity after the step (implicit), so that it may be strong enough for an impact without rebound
        const double damper = 2.0 * t.damping * root, implicit = 1.0 + damper * step, approach = dot(t.slip, t.normal);
        const Vec3 tangent = t.slip - approach * t.normal;
        t.stick = in_plane(t.stick, t.normal) - (t.soft * stiffness * step) * tangent;
        const double normal = t.soft * std::max(stiffness * t.depth - damper * approach, 0.0) / implicit;
        const Vec3 held = (1.0 / (1.0 + rubbing * step)) * (t.stick - (t.soft * rubbing) * tangent);
        const double weight = firmness * body.mass * t.share;
        asked.push_back({normal, weight * implicit, held, weight * (1.0 + rubbing * step)});
        rough |= t.friction > 0.0;
    }
    press(body, M, asked, touches);
    if (rough) rub(body, M, asked, rubbing * step, touches);
}

}  // namespace crumple::shell
