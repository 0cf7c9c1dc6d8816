#include "spatial/model/joint.hpp"

namespace crumple::spatial {

namespace {

constexpr double two_pi = 6.28318530717958647693;

// half of a rotation by less than 180 degrees
Quat half(const Quat& q) { return normalised({q.w + 1, q.v}); }

Vec3 vector(const double* a) { return {a[0], a[1], a[2]}; }

// takes the motion of a cam from a row and its drift
void follow(const Cam& cam, const Quat& relative, const Mat3& middle, int row, JointGeometry& out) {
    const int k = cam.about - 3;
    const double angle = 2 * std::atan2(relative.v[k], relative.w);
    const Vec3 turns = cam.slope.at_time(angle) * middle.r[k];
    out.row[row].ma = out.row[row].ma - turns;
    out.row[row].mb = out.row[row].mb - turns;
    out.error[row] -= cam.slope.integral_to(angle);
}

}  // namespace

void locate(const Joint& joint, const Pose& a, const Pose& b, const Target* target, const double* before, JointGeometry& out) {
    Quat first = a.q * joint.axes;
    const Quat second = b.q * joint.axes;
    if (target) first = first * rotation(vector(target->place + 3));
    Quat relative = conjugate(first) * second;
    if (relative.w < 0) relative = {-relative.w, -relative.v};
    const Mat3 middle = transposed(matrix(first * half(relative)));
    const Mat3 own = joint.slotted ? transposed(matrix(a.q * joint.axes)) : middle;
    const Vec3 pa = a.at(joint.arm[0]), pb = b.at(joint.arm[1]), apart = pb - pa;
    out.point = joint.slotted ? pb : 0.5 * (pa + pb);
    const Vec3 ra = out.point - a.x, rb = out.point - b.x;
    // the components of several rotations; of one it is an angle without limits
    const Vec3 turn = joint.laws > 1 ? rotation_vector(relative) : Vec3{};
    for (int k = 0; k < 3; k++) out.axes[k] = own.r[k];
    Vec3 crossed[3] = {middle.r[0], middle.r[1], middle.r[2]};
    double crossing = 0;
    if (joint.cross) {
        // rotation about axis k is held: axis k + 1 is fixed to the first body, axis k + 2 to the second
        const int k = joint.freedom[joint.held - 1] - 3;
        const Vec3 i = turned(first, axis((k + 1) % 3)), j = turned(second, axis((k + 2) % 3));
        crossed[(k + 1) % 3] = i;
        crossed[(k + 2) % 3] = j;
        crossed[k] = cross(j, i);
        crossing = dot(i, j);
    }
    for (int r = 0; r < joint.rows(); r++) {
        const int freedom = joint.freedom[r], k = freedom % 3;
        const bool held = r < joint.held;
        if (freedom < 3) {
            out.row[r] = {own.r[k], cross(ra, own.r[k]), cross(rb, own.r[k])};
            out.error[r] = dot(own.r[k], apart) - (target && held ? target->place[k] : 0);
            if (held && freedom == joint.cam.freedom) follow(joint.cam, relative, middle, r, out);
            continue;
        }
        const Vec3 d = crossed[k];
        out.row[r] = {{}, d, d};
        if (held) {
            out.error[r] = joint.cross ? crossing : 2 * relative.v[k];
        } else if (joint.laws == 1) {
            const double angle = 2 * std::atan2(relative.v[k], relative.w);
            out.error[r] = before ? angle + two_pi * std::round((before[r] - angle) / two_pi) : angle;
        } else {
            out.error[r] = turn[k];
        }
    }
}

double target_rate(const Joint& joint, const Pose& a, const JointGeometry& g, const Target& target, int row) {
    const int freedom = joint.freedom[row];
    if (freedom < 3) return target.rate[freedom];
    const Vec3 turn = vector(target.place + 3), speed = vector(target.rate + 3);
    // angular velocity from the rate of the rotation vector
    const double angle = norm(turn);
    const double c1 = angle < 1e-4 ? 0.5 : (1 - std::cos(angle)) / (angle * angle);
    const double c2 = angle < 1e-4 ? 1.0 / 6 : (angle - std::sin(angle)) / (angle * angle * angle);
    const Vec3 across = cross(turn, speed);
    return dot(g.row[row].mb, turned(a.q * joint.axes, speed + c1 * across + c2 * cross(turn, across)));
}

}  // namespace crumple::spatial
