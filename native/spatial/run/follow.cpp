// Passes of a run that follows the steps of another run, see step_record.hpp.
#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

bool Simulation::follow(const StepRecords& steps) {
    Record record;
    make_ready();
    if (!steps.empty()) prepare(steps.back().end);
    for (const StepRecord& step : steps) {
        followed_ = &step;
        stepper_.follow(&step.passes);
        const bool solved = solve(step.length);
        stepper_.follow(nullptr);
        followed_ = nullptr;
        if (!solved) return false;
        std::swap(state_, fine_);
        ahead_.see_step(fine_.velocity, state_.velocity, step.length, stepper_.end_rates());
        state_.t = step.end;
        watch(record);
        set_critical_damping(step.soon);
    }
    return true;
}

}  // namespace crumple::spatial
