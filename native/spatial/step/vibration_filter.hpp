// The part of a change of velocities or places that vibrates slowly enough to count.
#pragma once

#include <vector>

#include "spatial/solve/problem.hpp"

namespace crumple::spatial {

class VibrationFilter {
public:
    explicit VibrationFilter(Problem& problem) : p_(problem) {}

    // Prepares the filter (M + T^2 K)^-1 M at the end of a step of length h that has just been taken: M the inertias, K the stiffness of
    // the laws there, T = 1/(2 pi frequency) [s].  A vibration of the frequency f keeps the share 1/(1 + (f/frequency)^2); hinges that
    // flow have no stiffness, locked ones stay locked, and held rows are kept.
    void prepare(double frequency, double h);
    // filters velocities or small displacements of the bodies; `tolerance` of the held rows
    void apply(std::vector<Twist>& change, double tolerance);
    // what a change of places, small rotations and displacements, changes in a component of a hinge
    double along(size_t hinge, int component, const std::vector<Twist>& change) const;

private:
    void set_tangent(size_t link, double scale);

    Problem& p_;
};

}  // namespace crumple::spatial
