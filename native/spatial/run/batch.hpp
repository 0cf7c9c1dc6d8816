// Many variants of a spatial model, each solved as one run would solve it, on several threads.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

// A stage, the same for every variant of a case except for the motion that it adds.
struct CaseStage {
    double duration = 0;
    bool quasi_static = false;
    std::vector<bool> drives, obstacles;  // those that act
    std::vector<Condition> until;
};

// A model and the stages of its run.
struct Case {
    Model model;
    std::vector<CaseStage> stages;
};

// inertia is a 3 x 3 matrix about the centre, all in world axes at the start
constexpr size_t body_columns = 13;  // centre (3), mass, inertia (9)

// Values that differ from variant to variant, one row each; a null pointer leaves the model's own values.
struct Variations {
    size_t count = 0;
    std::vector<const Case*> cases;          // alike, see `alike`
    const int64_t* case_of = nullptr;        // (count)
    const double* velocity = nullptr;        // (count, stages, bodies, 6): added as a stage begins, at the centres of mass
    const double* impulse = nullptr;         // (count, stages, bodies, 6)
    const double* capacity_scale = nullptr;  // (count, hinges): times the model's
    const double* load_scale = nullptr;      // (count, loads): times the model's
    const double* bodies = nullptr;          // (count, bodies, body_columns)
    const double* gravity = nullptr;         // (count, 3)
};

// Final values of every variant by rows; zeros for a variant that was not solved.
struct EndValues {
    std::vector<double> time;                                     // (count)
    std::vector<double> start;                                    // (count, bodies, 3): centres at the start
    std::vector<double> centre, rotation, velocity;               // (count, bodies, 3), (.., 4), (.., 6)
    ComponentRecord<double> hinge;
    HingeEnergyRecord<double> hinge_energy;
    HingeSummary<double> summary;                                 // (count, hinges)
    EnergyRecord<double> energy;
    std::vector<double> residual, lost;                           // (count); lost: energy that the joints took from given motion
    std::vector<int64_t> outcome, steps;
};

// whether cases have the same bodies, hinges, loads and stages, so that one set of arrays serves all
bool alike(const Case& a, const Case& b);
// rows of zeros, not begun
EndValues sized(const Case& of, size_t count);
// `poll` gets the share done, now and then, on the calling thread, and returns false to cancel.
EndValues solve_many(const Variations& variations, const Settings& settings, int threads, const std::function<bool(double)>& poll);

// The first variant, a leader, and the others, which take its steps (step_record.hpp), each on its own.  A follower whose
// equations cannot be solved has the outcome `step_collapsed`.
EndValues solve_led(const Variations& variations, const Settings& settings, int threads, const std::function<bool(double)>& poll);

}  // namespace crumple::spatial
