// Piecewise linear curves: capacities over rotation, and functions of time.
#pragma once

#include <cstddef>
#include <vector>

#include "hinge/real.hpp"

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

using std::size_t;

// Piecewise linear curve, constant outside its range.  `hint` is the piece found last, which makes the lookup of a slowly
// changing argument O(1).
class Curve {
public:
    Curve() = default;
    Curve(std::vector<Real> x, std::vector<Real> y);
    std::vector<Real>& places() { return x_; }
    std::vector<Real>& values() { return y_; }
    const std::vector<Real>& places() const { return x_; }
    const std::vector<Real>& values() const { return y_; }
    // recomputes the areas after a change of places or values
    void integrate();
    Real at(Real v, int& hint) const;
    // integral from the first point to v; negative before it
    Real integral(Real v, int& hint) const;
    // for functions of time, which may have many points: value and integral with a binary search, and the mean from t to t + h
    Real at_time(double t) const;
    Real integral_to(double t) const;
    Real mean(double t, double h) const;

private:
    size_t piece(Real v, int& hint) const;
    int piece_at(double t) const;
    std::vector<Real> x_, y_, area_;
};

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::hinge
