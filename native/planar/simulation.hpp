// A run: adaptive time steps to the requested output times, and the recorded results.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/advance.hpp"
#include "common/records.hpp"
#include "common/unresolved.hpp"
#include "planar/stepper.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

struct Settings {
    double accuracy = 1e-3;      // allowed error of the motion, relative to the largest rotation
    double minimum_step = 1e-9;  // [s]
    double maximum_step = 1e30;  // [s]
    int parts = 1;               // smallest number of steps between two breaks
    double scale_floor = 2e-3;   // [rad] smallest rotation that counts as large
};

struct Record {
    std::vector<double> time;
    std::vector<Real> q, w;               // (n, dofs)
    std::vector<Real> pose, velocity;     // (n, bodies, 3): angle, x, y of the origin; of the centre of mass
    ComponentRecord<Real> hinge;          // one component per hinge
    HingeEnergyRecord<Real> hinge_energy;
    EnergyRecord<Real> energy;            // zero for springs, contact, friction and quasi-static stages
    std::vector<Real> drive;              // (n, drives) [N or N m]
    Outcome outcome = Outcome::complete;
    std::string reason;
    double residual = 0;                   // largest |balance - start| over (start + largest external work)
    // change of speed that unresolved loads and drives may have caused, relative to the largest speed: while hinges are locked, the
    // error estimate of a step does not show a pulse that vanishes in the mean of the load
    double unseen = 0;
    std::int64_t steps = 0, rejected = 0, forced = 0, solves = 0;
};

// Error allowed in one step, in units of the error measure.
double step_tolerance(double accuracy);

class Simulation {
public:
    explicit Simulation(Model model, const Settings& settings);
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    const Model& model() const { return model_; }
    Stepper& stepper() { return stepper_; }
    State& state() { return state_; }
    const State& state() const { return state_; }
    // Sets the joint rates at time 0 from velocities and impulses at the centres of mass; returns the kinetic energy lost in the
    // projection onto the joints' motion.
    Real set_motion(const Twist* velocity, const Twist* impulse);
    void set_rates(const Real* w);
    // prepares the first step; `run` calls it
    void make_ready();
    // runs to the last of the times; `poll` is called with the present time and returns false to cancel
    Record run(const std::vector<double>& times, const std::function<bool(double)>& poll);
    // a record of the present state only
    Record present() const;

private:
    struct Critical {
        const Hinge* hinge;
        Stop* stop;
    };
    void set_damping();
    void run_to_end(const std::vector<double>& times, const std::function<bool(double)>& poll, Record& record);
    void set_critical_damping(bool all);
    void bound_steps(double duration);
    double longest_part() const;
    bool resting() const;
    double next_break() const;
    StepBound::Step resolved(double h);
    bool stalled(Record& record);
    bool unbalanced(Record& record) const;
    bool advance(double target, Record& record, const std::function<bool(double)>& poll);
    bool step_twice(double h, bool again);
    double error(const State& coarse, const State& fine);
    double moved_apart(const State& coarse, const State& fine, double& speed);
    double unbalance(const State& fine) const;
    void show_first_moments();
    void store(Record& record) const;
    void watch(Record& record);

    Model model_;
    Settings settings_;
    Stepper stepper_;
    State state_, coarse_, fine_;
    std::vector<Critical> critical_;  // stops that get critical damping
    std::vector<Real> between_;     // joint rates at the middle of the step
    std::vector<Real> turned_, sped_;  // differences of joint coordinates and rates between a step and its halves
    StepBound bound_;                          // step limit by loads and drives
    std::vector<std::vector<size_t>> grouped_;  // loads grouped by their function of time
    std::vector<double> moved_;                // response to a unit impulse of each group [kinetic norm]; NaN: not evaluated yet
    std::vector<double> breaks_;               // those of the model, and the end of the first step if a drive begins with an impact
    double begin_ = 0, end_ = 0;               // start and end of the run [s]
    double unseen_ = 0;                        // see `Record::unseen` [kinetic norm]
    double large_speed_ = 0;                   // kinetic norm that counts as large before anything moves
    double negligible_speed_ = 0;              // kinetic norm that moves bodies over the run by less than what counts as large
    double step_tolerance_;  // allowed value of the error measure
    double h_ = 0, scale_ = 0, speed_ = 0, start_energy_ = 0, work_max_ = 0, residual_max_ = 0, negligible_energy_ = 0;
    Advance advance_;
    std::int64_t poll_at_ = 0;  // amount of work at which `poll` is called next
    bool ready_ = false;
};

// summary of all hinges at the present state
HingeSummary<Real> hinge_summary(const Simulation& simulation);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
