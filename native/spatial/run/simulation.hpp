// A run of a spatial model: stages, adaptive time steps to the requested output times, and the recorded results.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/advance.hpp"
#include "common/records.hpp"
#include "common/unresolved.hpp"
#include "spatial/run/ahead.hpp"
#include "spatial/run/guide.hpp"
#include "spatial/run/step_length.hpp"
#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

struct Settings {
    double accuracy = 1e-3;      // allowed error of the motion, relative to the largest rotation
    double minimum_step = 1e-9;  // [s]
    double maximum_step = 1e30;  // [s]
    int parts = 1;               // smallest number of steps between two breaks
    double scale_floor = 2e-3;   // [rad] smallest rotation that counts as large
};

// Quantity whose value ends a stage; see crumple._core.spatial.simulation.Until.
enum class Quantity { force, drive_force, work, distance, displacement };

struct Condition {
    Quantity quantity = Quantity::work;
    double value = 0;
    int index = -1, freedom = 0;
    int body[2] = {-1, -1};
    Vec3 arm[2];
    double start = 0;  // value of the quantity at the start of the stage
};

struct Record {
    std::vector<double> time, centre, rotation, velocity, acceleration, travel, step, joint_force, obstacle_force;
    ComponentRecord<double> hinge;
    HingeEnergyRecord<double> hinge_energy;
    EnergyRecord<double> energy;
    Outcome outcome = Outcome::complete;
    std::string reason;
    int ended_by = -1;
    int stuck_body = -1;         // for a run that could not continue: the body with the largest imbalance
    double lost_time = NAN;      // time at which a quasi-static stage lost its equilibrium and did not regain it
    double residual = 0;         // largest |balance - start| over the energy supplied to the structure
    // change of speed that unresolved loads and drives may have caused, relative to the largest speed: while hinges are locked, the
    // error estimate of a step does not show a pulse that vanishes in the mean of the load
    double unseen = 0;
    std::int64_t steps = 0, rejected = 0, forced = 0, solves = 0;
};

// Error allowed in one step, in units of the error measure.
double step_tolerance(double accuracy);
// Kinetic-energy norm of the structure's velocities, or of the difference of the velocities of all bodies between two states.
double kinetic_norm(const Model& model, const State& a, const State* b);
// Share of the total kinetic energy, including that of heavy obstacles, below which energies are rounding.
constexpr double rounding_share = 1e-10;

class Simulation {
public:
    Simulation(Model model, const Settings& settings);
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    const Model& model() const { return model_; }
    // components of all hinges
    size_t components() const { return state_.rotation.size(); }
    Stepper& stepper() { return stepper_; }
    State& state() { return state_; }
    const State& state() const { return state_; }
    // Adds velocities and impulses at the centres of mass; returns the kinetic energy lost in making them compatible with the joints.
    // After the start the added energy counts as external work.
    double set_motion(const Twist* velocity, const Twist* impulse);
    void begin_stage(bool quasi_static, const std::vector<bool>& drives, const std::vector<bool>& obstacles,
                     std::vector<Condition> until);
    // one fixed step of length h
    bool step(double h) {
        make_ready();
        return stepper_.step(state_, h, nullptr);
    }
    // prepares the first step; `run` calls it
    void make_ready();
    // Runs to the last of the times; steps pass over the others, where the state is found by a shorter step (quasi-static stages end a
    // step at each).  `poll` is called with the present time and returns false to cancel
    Record run(const std::vector<double>& times, const std::function<bool(double)>& poll);
    // a record of the present state only
    Record present();
    // stores the steps from now on; null ends it
    void keep(StepRecords* steps) { step_records_ = steps; }
    // stores the accepted steps in a guide from now on; and is guided by those of another run
    void keep_guide() { guide_ = std::make_shared<Guide>(); }
    std::shared_ptr<Guide> guide() const { return guide_; }
    void be_guided_by(std::shared_ptr<const Guide> lead) { lead_ = std::move(lead); }
    // follows the stored steps of another run of this model or of a similar one; false if a step cannot be solved
    bool follow(const StepRecords& steps);
    HingeSummary<double> summary() const;

private:
    struct Critical {
        size_t hinge;
        int component;
        hinge::Stop* stop;
    };
    void set_damping();
    void prepare(double end);
    void bound_steps();
    double longest_part() const;
    bool resting() const;
    double next_break() const;
    StepBound::Step resolved(double h);
    void record_step(double h);
    bool touched_soon(const Critical& stop) const;
    void set_critical_damping(const std::vector<bool>& which);
    bool cancelled(Record& record, const std::function<bool(double)>& poll);
    bool stalled(Record& record);
    void reject(Record& record, Attempted what);
    void accept(Record& record, bool exact);
    bool advance(double target, Record& record, const std::function<bool(double)>& poll);
    StepPlan next_step(double target);
    bool solve(double h);
    bool lands(const StepPlan& plan, Record& record);
    bool overshoots(const StepPlan& plan, double share, int which);
    void take(const StepPlan& plan, double e, Record& record);
    bool failed(double e, bool smallest, Record& record) const;
    bool force(Record& record) const;
    double unbalance(const State& fine) const;
    bool lost(const State& before, Record& record);
    bool springs_back(const State& after) const;
    bool jumps(int which);
    bool strike(Record& record);
    double planned();
    const std::vector<Twist>* suggested(double h);
    const std::vector<Twist>* expected(double h);
    const std::vector<Twist>* expected_by_follower(double h);
    void keep_for_guide(double h);
    bool begins_here(const GuideStep* step) const;
    double lead_by(const GuideStep& step);
    bool like_leader();
    bool changes_as_leader(bool pair);
    bool completes_pair() const;
    double energy_norm(const std::vector<Twist>& velocity) const;
    bool travels_as_leader(bool vibrates);
    bool prepare_filter(double h);
    void filter_change(std::vector<Twist>& change);
    void add_to_guide(bool accurate);
    void differ(const State& coarse, const State& fine, double& place, double& speed);
    double error(const State& coarse, const State& fine);
    double worst_place(const State& a, const State& b, bool obstacles) const;
    double quantity(const Condition& condition, const State& state) const;
    double share_of_step(const State& before, const State& after, int* which) const;
    double given(const Energies& e) const;
    void show_first_moments();
    void store(Record& record, State& state);
    void store_passed(Record& record);
    bool move_within(State& state, double t);
    bool at_output(State& state, double t);
    void watch(Record& record);

    Model model_;
    Settings settings_;
    Stepper stepper_;
    StepBound bound_;                           // step limit by loads and drives
    std::vector<std::vector<size_t>> grouped_;  // loads grouped by their function of time
    std::vector<double> moved_;                 // response to a unit impulse of each group [kinetic norm]; NaN: not evaluated yet
    std::optional<Stepper> weigher_;            // evaluates `moved_` without changing the data that `stepper_` keeps between steps
    double end_ = 0;                            // end of the run, from the start of the stage [s]
    double unseen_ = 0;                        // see `Record::unseen` [kinetic norm]
    double large_speed_ = 0;                    // kinetic norm that counts as large before anything moves
    State state_, coarse_, fine_, first_;
    State difference_;                // of the velocities of one step and two half steps
    std::vector<Twist> moved_by_;     // and of their places
    State half_;                      // after the first half of the step just solved, if outputs lie within it
    std::vector<double> outputs_;     // output times of the present run, and the index of the next one
    size_t next_output_ = 0;
    std::vector<Twist> guess_;
    Ahead ahead_;
    std::vector<Critical> critical_;  // stops that get critical damping
    std::vector<Condition> until_;
    std::vector<double> moment_max_;  // largest length of each hinge's moment vector [N m]
    StepLength length_;
    double step_tolerance_;           // allowed value of the error measure
    double scale_ = 0, speed_ = 0;
    bool started_ = false;
    Energies start_;                  // at the start of the first run
    double work_max_ = 0,             // largest external work on the structure, either sign
           given_max_ = 0,            // largest energy that obstacles transferred, either sign
           residual_max_ = 0, balance_ = 0, given_energy_ = 0, negligible_energy_ = 0;
    double lift_ = 0;                 // work of lifting all weights by the model's length [J]
    double negligible_speed_ = 0;     // kinetic norm that moves bodies over the run by less than what counts as large
    double closing_ = 0;              // time within the step just solved at which an open contact closed; 0 if none did
    double largest_energy_ = 0;       // largest kinetic energy of the structure
    double overshot_ = 0;             // value of the condition that last shortened a step; NaN: none
    int strikes_ = 0;                 // number of consecutive impacts
    Advance advance_;
    int lost_ = 0;                    // consecutive steps of a quasi-static stage out of equilibrium, after this state:
    State held_;
    std::vector<Vec3> stored_impulse_;  // impulse on every obstacle at the last stored row, and the time of that row
    double stored_time_ = -1;
    StepRecords* step_records_ = nullptr;
    Predicted predicted_ = Predicted::pass;    // of the last step, and the change of the velocities, if steps are stored
    std::vector<Twist> change_;
    const StepRecord* followed_ = nullptr;
    std::shared_ptr<Guide> guide_;          // of the own steps
    GuideStep tried_;                       // the step just solved
    std::shared_ptr<const Guide> lead_;     // of another run; the index of its next step, and that which guides the present one
    size_t next_lead_ = 0;
    const GuideStep* leading_ = nullptr;
    OneByOne one_by_one_;                   // of the leader's pairs
    const GuideStep* second_part_ = nullptr;  // of the pair whose first part is being taken alone
    bool on_second_part_ = false;           // whether the present step is one
    bool in_one_ = false;                   // the step was not repeated in halves, see `like_leader`
    bool refused_ = false;                  // a step from this state was rejected
    std::vector<Pass> passes_;        // passes of the last solved step if steps are stored
    std::int64_t poll_at_ = 0;        // amount of work at which `poll` is called next
    bool ready_ = false;
};

}  // namespace crumple::spatial
