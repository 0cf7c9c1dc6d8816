// Vectors, matrices and unit quaternions in space.
#pragma once

#include <cmath>

namespace crumple::spatial {

struct Vec3 {
    double x = 0, y = 0, z = 0;
    double operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 axis(int k) { return {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}; }

// Matrix by its rows.
struct Mat3 {
    Vec3 r[3];
};

inline Vec3 operator*(const Mat3& m, Vec3 v) { return {dot(m.r[0], v), dot(m.r[1], v), dot(m.r[2], v)}; }
inline Vec3 column(const Mat3& m, int k) { return {m.r[0][k], m.r[1][k], m.r[2][k]}; }
inline Mat3 transposed(const Mat3& m) { return {{column(m, 0), column(m, 1), column(m, 2)}}; }
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
    const Mat3 t = transposed(b);
    return {{t * a.r[0], t * a.r[1], t * a.r[2]}};
}

inline Mat3 inverse(const Mat3& m) {
    const Vec3 a = cross(m.r[1], m.r[2]), b = cross(m.r[2], m.r[0]), c = cross(m.r[0], m.r[1]);
    const double d = 1 / dot(m.r[0], a);
    return transposed({{d * a, d * b, d * c}});
}

// Unit quaternion: scalar w, vector v.
struct Quat {
    double w = 1;
    Vec3 v;
};

inline Quat operator*(const Quat& a, const Quat& b) {
    return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}
inline Quat conjugate(const Quat& q) { return {q.w, -q.v}; }
inline Quat normalised(const Quat& q) {
    const double s = 1 / std::sqrt(q.w * q.w + dot(q.v, q.v));
    return {s * q.w, s * q.v};
}

// rotation matrix; its columns are the rotated axes
inline Mat3 matrix(const Quat& q) {
    const double w = q.w, x = q.v.x, y = q.v.y, z = q.v.z;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
             {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

inline Vec3 turned(const Quat& q, Vec3 a) {
    const Vec3 t = 2.0 * cross(q.v, a);
    return a + q.w * t + cross(q.v, t);
}

// rotation by a rotation vector [rad]
inline Quat rotation(Vec3 r) {
    const double angle = norm(r), half = angle / 2;
    // for small angles the series of sin(x)/x, exact to rounding
    const double s = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(half) / angle;
    return {std::cos(half), s * r};
}

// rotation vector of a rotation, with length up to pi
inline Vec3 rotation_vector(const Quat& q) {
    const double s = norm(q.v), sign = q.w < 0 ? -1 : 1;
    const double factor = s < 1e-8 ? 2 : 2 * std::atan2(s, std::fabs(q.w)) / s;
    return sign * factor * q.v;
}

inline double angle_between(const Quat& a, const Quat& b) { return norm(rotation_vector(conjugate(a) * b)); }

// quaternion of a matrix with orthonormal, right-handed columns (Shepperd's method: largest component first)
inline Quat quaternion(const Mat3& m) {
    const double a = m.r[0].x, b = m.r[1].y, c = m.r[2].z;
    Quat q;
    if (a + b + c > 0) {
        q = {1 + a + b + c, {m.r[2].y - m.r[1].z, m.r[0].z - m.r[2].x, m.r[1].x - m.r[0].y}};
    } else if (a >= b && a >= c) {
        q = {m.r[2].y - m.r[1].z, {1 + a - b - c, m.r[0].y + m.r[1].x, m.r[0].z + m.r[2].x}};
    } else if (b >= c) {
        q = {m.r[0].z - m.r[2].x, {m.r[0].y + m.r[1].x, 1 + b - a - c, m.r[1].z + m.r[2].y}};
    } else {
        q = {m.r[1].x - m.r[0].y, {m.r[0].z + m.r[2].x, m.r[1].z + m.r[2].y, 1 + c - a - b}};
    }
    return normalised(q);
}

// Position of a body: its centre of mass, and its rotation relative to the start.
struct Pose {
    Vec3 x;
    Quat q;
    Vec3 at(Vec3 arm) const { return x + turned(q, arm); }
};

// Angular velocity and velocity of a body at its centre, or a moment and a force there, in world axes.
struct Twist {
    Vec3 w, v;
};

inline Twist operator+(const Twist& a, const Twist& b) { return {a.w + b.w, a.v + b.v}; }
inline Twist operator-(const Twist& a, const Twist& b) { return {a.w - b.w, a.v - b.v}; }
inline Twist operator*(double s, const Twist& a) { return {s * a.w, s * a.v}; }

inline Pose moved(const Pose& p, const Twist& step) { return {p.x + step.v, normalised(rotation(step.w) * p.q)}; }

}  // namespace crumple::spatial
