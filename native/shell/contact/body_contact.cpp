#include "shell/contact/body_contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::shell {

namespace {

// Weight of all touches over the set's mass: a set then falls short of the stiffness asked for by a tenth.  Much more would leave single nodes with forces that change with every step.
constexpr double firmness = 10.0;
// Share of critical of the springs of friction: what sticks gives nothing back.
constexpr double stick_damping = 1.0;
// The set of touching nodes settles in two or three rounds, the weights of sliding ones within this share in a few more.
constexpr int most_rounds = 20;
constexpr double settled_share = 1e-3;

// Accelerations of a body, or forces that work on them: of its centre, and turning.
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

// H a = f by Cholesky's factors; what is held does not accelerate
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

// Accelerations that a touch asks for, over 1 + c dt for the dampers' share of the step to come, and their weights.
struct Asked {
    double normal, weight;
    Vec3 tangent;
    double tangent_weight;
};

// pressures: those touches push whose asked acceleration is not reached by the others
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

// friction: what would hold every touch, cut off at Coulomb's limit.  Each round gives what slides the weight with which its
// force would lie at the limit (least squares with new weights): so its direction follows the motion to come, while one
// taken from the motion before would throw a set of little inertia to and fro.
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
        // the spring keeps no more than what could be asked for at the limit
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
        // the damper acts on the velocity to come, so that it may be as strong as a dead stop needs
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
