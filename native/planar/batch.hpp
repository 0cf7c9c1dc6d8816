// Many variants of a model, each solved as one run would solve it, on several threads.
#pragma once

#include <functional>
#include <vector>

#include "planar/simulation.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

// Values that differ from variant to variant, one row each; a null pointer leaves the model's own values.
struct Variations {
    size_t count = 0;
    std::vector<const Model*> models;       // of one topology
    const int64_t* model = nullptr;         // (count): which of the models
    const double* velocity = nullptr;       // (count, bodies, 3): at the start, at the centres of mass
    const double* impulse = nullptr;        // (count, bodies, 3)
    const double* capacity_scale = nullptr; // (count, hinges): times the model's
    const double* load_scale = nullptr;     // (count, loads): times the model's
    const double* bodies = nullptr;         // (count, bodies, 4): centre x, y, mass, inertia
    const double* gravity = nullptr;        // (count, 2)
};

// Final values of every variant by rows; zeros for a variant that was not solved.
struct EndValues {
    std::vector<double> time, q, w;     // (count), (count, dofs)
    std::vector<double> pose;           // (count, bodies, 3): angle, x, y of the origin
    std::vector<double> velocity;       // (count, bodies, 3), at the centres of mass
    ComponentRecord<double> hinge;
    HingeEnergyRecord<double> hinge_energy;
    HingeSummary<double> summary;       // (count, hinges)
    EnergyRecord<double> energy;
    std::vector<double> residual, lost; // (count); lost: energy that the joints took from the motion at the start
    std::vector<int64_t> outcome, steps;
};

// `poll` gets the share done, now and then, on the calling thread, and returns false to cancel.
EndValues solve_many(const Variations& variations, double end, const Settings& settings, int threads,
                  const std::function<bool(double)>& poll);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
