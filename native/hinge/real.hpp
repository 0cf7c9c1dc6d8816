// Number type of the kernel: a plain double, or, if the same sources are compiled with CRUMPLE_TANGENT, a double with its
// derivatives along a few directions in the parameter space (forward-mode automatic differentiation).
//
// Step lengths, tolerances and everything that only decides between branches stay plain doubles.  A run with derivatives
// therefore takes the same steps as a plain run, and its derivatives are those of this discrete sequence of steps.
#pragma once

#include <algorithm>
#include <cmath>

#ifdef CRUMPLE_TANGENT
#define CRUMPLE_ARITHMETIC tangent
#else
#define CRUMPLE_ARITHMETIC plain
#endif

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

using std::exp;
using std::fabs;
using std::log;
using std::max;
using std::min;
using std::pow;
using std::sin;
using std::cos;
using std::sqrt;

#ifndef CRUMPLE_TANGENT

using Real = double;
constexpr bool with_directions = false;
inline double value(double x) { return x; }
inline void take_directions(double&, double) {}

#else

constexpr int directions = 8;
constexpr bool with_directions = true;

struct Real {
    double v = 0, d[directions] = {};

    Real() = default;
    Real(double value) : v(value) {}  // a constant
    // chain rule: f(x) with f' = slope
    static Real chained(double f, double slope, const Real& x) {
        Real r(f);
        for (int k = 0; k < directions; k++) r.d[k] = slope * x.d[k];
        return r;
    }
    Real operator-() const { return chained(-v, -1, *this); }
    Real& operator+=(const Real& b) {
        v += b.v;
        for (int k = 0; k < directions; k++) d[k] += b.d[k];
        return *this;
    }
    Real& operator-=(const Real& b) {
        v -= b.v;
        for (int k = 0; k < directions; k++) d[k] -= b.d[k];
        return *this;
    }
    Real& operator*=(const Real& b) {
        for (int k = 0; k < directions; k++) d[k] = d[k] * b.v + v * b.d[k];
        v *= b.v;
        return *this;
    }
    Real& operator/=(const Real& b) {
        v /= b.v;
        for (int k = 0; k < directions; k++) d[k] = (d[k] - v * b.d[k]) / b.v;
        return *this;
    }
};

inline double value(const Real& x) { return x.v; }
inline Real operator+(Real a, const Real& b) { return a += b; }
inline Real operator-(Real a, const Real& b) { return a -= b; }
inline Real operator*(Real a, const Real& b) { return a *= b; }
inline Real operator/(Real a, const Real& b) { return a /= b; }
inline bool operator<(const Real& a, const Real& b) { return a.v < b.v; }
inline bool operator>(const Real& a, const Real& b) { return a.v > b.v; }
inline bool operator<=(const Real& a, const Real& b) { return a.v <= b.v; }
inline bool operator>=(const Real& a, const Real& b) { return a.v >= b.v; }
inline bool operator==(const Real& a, const Real& b) { return a.v == b.v; }
inline bool operator!=(const Real& a, const Real& b) { return a.v != b.v; }
inline Real fabs(const Real& x) { return x.v < 0 ? -x : x; }
inline Real min(const Real& a, const Real& b) { return b.v < a.v ? b : a; }
inline Real max(const Real& a, const Real& b) { return a.v < b.v ? b : a; }
inline Real sqrt(const Real& x) { return Real::chained(std::sqrt(x.v), x.v > 0 ? 0.5 / std::sqrt(x.v) : 0, x); }
inline Real sin(const Real& x) { return Real::chained(std::sin(x.v), std::cos(x.v), x); }
inline Real cos(const Real& x) { return Real::chained(std::cos(x.v), -std::sin(x.v), x); }
inline Real exp(const Real& x) { return Real::chained(std::exp(x.v), std::exp(x.v), x); }
inline Real log(const Real& x) { return Real::chained(std::log(x.v), 1 / x.v, x); }
inline Real pow(const Real& x, const Real& p) {
    const double f = std::pow(x.v, p.v);
    Real r = Real::chained(f, f == 0 ? 0 : f * p.v / x.v, x);
    const double by_power = f == 0 ? 0 : f * std::log(x.v);
    for (int k = 0; k < directions; k++) r.d[k] += by_power * p.d[k];
    return r;
}
// copies the derivatives of another number, not its value
inline void take_directions(Real& to, const Real& from) { std::copy(from.d, from.d + directions, to.d); }

#endif

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::hinge
