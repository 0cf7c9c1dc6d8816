// Solution of many variants of a spatial model on several threads, each exactly as in a single run.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

// A stage, the same for every variant of a case except for its added motion.
struct CaseStage {
    double duration = 0;
    bool quasi_static = false;
    std::vector<bool> drives, obstacles;  // whether each is active
    std::vector<Condition> until;
};

// A model and the stages of its run.
struct Case {
    Model model;
    std::vector<CaseStage> stages;
};

// inertia is a 3 x 3 matrix about the centre, all in world axes at the start
constexpr size_t body_columns = 13;  // centre (3), mass, inertia (9)

// Values that differ between variants, one row per variant; with a null pointer the model's own values apply.
struct Variations {
    size_t count = 0;
    std::vector<const Case*> cases;          // alike, see `alike`
    const int64_t* case_of = nullptr;        // (count): index of the case
    const double* velocity = nullptr;        // (count, stages, bodies, 6): added at the start of a stage, at the centres of mass
    const double* impulse = nullptr;         // (count, stages, bodies, 6)
    const double* capacity_scale = nullptr;  // (count, hinges): factor on the model's capacities
    const double* load_scale = nullptr;      // (count, loads): factor on the model's loads
    const double* bodies = nullptr;          // (count, bodies, body_columns)
    const double* gravity = nullptr;         // (count, 3)
    std::vector<double> times;               // increasing: the states at these times are kept; in quasi-static stages steps end there
};

// States of all variants at the given times, (count times times) rows; zeros at times that a run did not reach.
struct Samples {
    std::vector<double> centre, rotation, velocity;
    ComponentRecord<double> hinge;
    HingeEnergyRecord<double> hinge_energy;
    EnergyRecord<double> energy;
};

// Final values, one row per variant; zeros for a variant that was not solved.
struct EndValues {
    std::vector<double> time;                                     // (count)
    std::vector<double> start;                                    // (count, bodies, 3): centres at the start
    std::vector<double> centre, rotation, velocity;               // (count, bodies, 3), (.., 4), (.., 6)
    ComponentRecord<double> hinge;
    HingeEnergyRecord<double> hinge_energy;
    HingeSummary<double> summary;                                 // (count, hinges)
    EnergyRecord<double> energy;
    std::vector<double> residual, lost;                           // (count); lost: energy lost in making given motion compatible
    std::vector<int64_t> outcome, steps;
    Samples samples;
};

// whether cases have the same bodies, hinges, loads and stages, so that one set of arrays serves all
bool alike(const Case& a, const Case& b);
// end values with rows of zeros for `count` variants, and samples at so many times
EndValues sized(const Case& of, size_t count, size_t times);
// `poll` is called regularly on the calling thread with the completed share and returns false to cancel.
EndValues solve_many(const Variations& variations, const Settings& settings, int threads, const std::function<bool(double)>& poll);

// Solves the first variant, the leader, and then the others, which follow its steps (step_record.hpp), each independently.  A follower
// whose equations cannot be solved has the outcome `step_collapsed`.
EndValues solve_led(const Variations& variations, const Settings& settings, int threads, const std::function<bool(double)>& poll);

// Solves the first variant, and then the others, guided by its steps (guide.hpp), each independently.
EndValues solve_guided(const Variations& variations, const Settings& settings, int threads, const std::function<bool(double)>& poll);

}  // namespace crumple::spatial
