// Vectors of three components and 3 by 3 matrices of the shell stepper, in world axes.
#pragma once
#include <cmath>

namespace crumple::shell {

struct Vec3 {
    double x = 0.0, y = 0.0, z = 0.0;
    double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 read3(const double* p) { return {p[0], p[1], p[2]}; }
inline void write3(double* p, Vec3 v) {
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}
inline void add3(double* p, Vec3 v) {
    p[0] += v.x;
    p[1] += v.y;
    p[2] += v.z;
}

// Row-major 3 by 3 matrix.
struct Mat3 {
    double m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
};
inline Vec3 operator*(const Mat3& a, Vec3 v) {
    return {a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[3] * v.x + a.m[4] * v.y + a.m[5] * v.z,
            a.m[6] * v.x + a.m[7] * v.y + a.m[8] * v.z};
}
inline Vec3 transposed_times(const Mat3& a, Vec3 v) {
    return {a.m[0] * v.x + a.m[3] * v.y + a.m[6] * v.z, a.m[1] * v.x + a.m[4] * v.y + a.m[7] * v.z,
            a.m[2] * v.x + a.m[5] * v.y + a.m[8] * v.z};
}
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
    Mat3 c;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) c.m[3 * i + j] = a.m[3 * i] * b.m[j] + a.m[3 * i + 1] * b.m[3 + j] + a.m[3 * i + 2] * b.m[6 + j];
    return c;
}
inline Mat3 transposed(const Mat3& a) {
    Mat3 c;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) c.m[3 * i + j] = a.m[3 * j + i];
    return c;
}
// Solves a x = b by Cramer's rule; a is symmetric positive definite here (an inertia tensor).
inline Vec3 solve(const Mat3& a, Vec3 b) {
    const Vec3 c0{a.m[0], a.m[3], a.m[6]}, c1{a.m[1], a.m[4], a.m[7]}, c2{a.m[2], a.m[5], a.m[8]};
    const double inverse = 1.0 / dot(c0, cross(c1, c2));
    return {inverse * dot(b, cross(c1, c2)), inverse * dot(c0, cross(b, c2)), inverse * dot(c0, cross(c1, b))};
}

}  // namespace crumple::shell
