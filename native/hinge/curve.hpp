// Piecewise linear curves: capacities over rotation, and functions of time.
#pragma once

#include <cstddef>
#include <vector>

#include "hinge/real.hpp"

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

using std::size_t;

// Piecewise linear curve, constant outside its ends.  The hint makes a lookup that moves slowly O(1).
class Curve {
public:
    Curve() = default;
    Curve(std::vector<Real> x, std::vector<Real> y);
    std::vector<Real>& places() { return x_; }
    std::vector<Real>& values() { return y_; }
    const std::vector<Real>& places() const { return x_; }
    const std::vector<Real>& values() const { return y_; }
    // the areas again, after a change of places or values
    void integrate();
    Real at(Real v, int& hint) const;
    // integral from the first point to v; negative before it
    Real integral(Real v, int& hint) const;
    // the same at any time, found by bisection, and the mean from t to t + h: of functions of time, which may have many points
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
