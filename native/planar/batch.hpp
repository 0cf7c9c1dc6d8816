// Solution of many variants of a model on several threads, each exactly as in a single run.
#pragma once

#include <functional>
#include <vector>

#include "planar/simulation.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

// Values that differ between variants, one row per variant; with a null pointer the model's own values apply.
struct Variations {
    size_t count = 0;
    std::vector<const Model*> models;       // all of the same topology
    const int64_t* model = nullptr;         // (count): index of the model
    const double* velocity = nullptr;       // (count, bodies, 3): at the start, at the centres of mass
    const double* impulse = nullptr;        // (count, bodies, 3)
    const double* capacity_scale = nullptr; // (count, hinges): factor on the model's capacities
    const double* load_scale = nullptr;     // (count, loads): factor on the model's loads
    const double* bodies = nullptr;         // (count, bodies, 4): centre x, y, mass, inertia
    const double* gravity = nullptr;        // (count, 2)
    std::vector<double> times;              // increasing: steps end at these and the states there are kept; none: the end alone
};

// States of all variants at the given times, (count times times) rows; zeros at times that a run did not reach.
struct Samples {
    std::vector<double> q, w, pose, velocity;
    ComponentRecord<double> hinge;
    HingeEnergyRecord<double> hinge_energy;
    EnergyRecord<double> energy;
};

// Final values, one row per variant; zeros for a variant that was not solved.
struct EndValues {
    std::vector<double> time, q, w;     // (count), (count, dofs)
    std::vector<double> pose;           // (count, bodies, 3): angle, x, y of the origin
    std::vector<double> velocity;       // (count, bodies, 3), at the centres of mass
    ComponentRecord<double> hinge;
    HingeEnergyRecord<double> hinge_energy;
    HingeSummary<double> summary;       // (count, hinges)
    EnergyRecord<double> energy;
    std::vector<double> residual, lost; // (count); lost: energy lost when the initial motion was made compatible with the joints
    std::vector<int64_t> outcome, steps;
    Samples samples;
};

// `poll` is called regularly on the calling thread with the completed share and returns false to cancel.
EndValues solve_many(const Variations& variations, double end, const Settings& settings, int threads,
                  const std::function<bool(double)>& poll);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
