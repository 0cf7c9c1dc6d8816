// Stages: their start, and the conditions that end them early.
#include <algorithm>
#include <cmath>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

namespace {

// A step is out of equilibrium if drag dissipates more than this share of the work of loads.  In equilibrium it is drag m v over the
// load.
constexpr double lost_share = 1e-3;
// Displacement out of equilibrium [rad, model lengths] that exceeds a snap-through, and the smallest share of drag in the work over it.
constexpr double longest_snap = 0.5, snap_share = 5e-2;
// Number of consecutive steps out of equilibrium that exceeds a snap-through.
constexpr int most_lost = 1000;
// Share of drag in the work above which nothing else resists.
constexpr double unheld_share = 0.999;
// Relative tolerance of a condition that ends a stage.
constexpr double met = 1e-4;

}  // namespace

bool Simulation::stalled(Record& record) {
    record.reason = advance_.stalled(state_.t, stepper_.solves());
    if (record.reason.empty()) return false;
    record.outcome = Outcome::stalled;
    return true;
}

double Simulation::set_motion(const Twist* velocity, const Twist* impulse) {
    if (stepper_.stage().quasi_static) return 0;
    const Energies before = energies(model_, state_);
    State free = state_;
    for (size_t i = 0; i < model_.bodies.size(); i++) {
        const Body& body = model_.bodies[i];
        const Quat& q = state_.pose[i].q;
        const Vec3 spin = turned(q, body.inverse * turned(conjugate(q), impulse[i].w));
        free.velocity[i] = free.velocity[i] + velocity[i] + Twist{spin, (1 / body.mass) * impulse[i].v};
    }
    const Energies given = energies(model_, free);
    given_energy_ = std::max(given_energy_, given.structure_kinetic());
    stepper_.add_motion(state_, velocity, impulse);
    const Energies after = energies(model_, state_);
    if (started_) {
        state_.work_on(false, after.structure_kinetic() - before.structure_kinetic());
        state_.work_on(true, after.obstacle_kinetic - before.obstacle_kinetic);
    }
    return given.kinetic - after.kinetic;
}

void Simulation::begin_stage(bool quasi_static, const std::vector<bool>& drives, const std::vector<bool>& obstacles,
                             std::vector<Condition> until) {
    Stage& stage = stepper_.stage();
    std::vector<DriveStage> next(model_.drives.size());
    for (size_t k = 0; k < next.size(); k++) {
        next[k] = {drives[k], stepper_.displacement(model_.drives[k], k, state_, state_.t)};
    }
    stage = {quasi_static, next};
    state_.stage_start = state_.t;
    stepper_.set_obstacles(obstacles, state_);
    state_.contact.force.assign(obstacles.size(), Vec3{});
    if (quasi_static) {
        if (started_) state_.slowed += energies(model_, state_).kinetic;
        std::fill(state_.velocity.begin(), state_.velocity.end(), Twist{});
    }
    length_.forget();
    overshot_ = NAN;
    lost_ = 0;
    until_ = std::move(until);
    for (Condition& c : until_) {
        if (c.quantity == Quantity::distance) {
            for (int k = 0; k < 2; k++) c.arm[k] = c.arm[k] - model_.pose(first_.pose, c.body[k]).x;
        }
        c.start = 0;
        if (c.quantity != Quantity::force && c.quantity != Quantity::drive_force) c.start = quantity(c, state_);
    }
}

double Simulation::quantity(const Condition& c, const State& s) const {
    double q = 0;
    if (c.quantity == Quantity::force && !s.contact.force.empty()) q = norm(s.contact.force[static_cast<size_t>(c.index)]);
    if (c.quantity == Quantity::work) q = s.external_work;
    if (c.quantity == Quantity::drive_force) q = norm(s.joint_force[static_cast<size_t>(c.index)].v);
    if (c.quantity == Quantity::displacement) q = stepper_.relative(s, c.index, c.freedom);
    if (c.quantity == Quantity::distance) {
        q = norm(model_.pose(s.pose, c.body[1]).at(c.arm[1]) - model_.pose(s.pose, c.body[0]).at(c.arm[0]));
    }
    return q - c.start;
}

// Share of the step after which the first condition is satisfied; above 1 if none is.
double Simulation::share_of_step(const State& before, const State& after, int* which) const {
    double least = 2;
    for (size_t k = 0; k < until_.size(); k++) {
        const Condition& c = until_[k];
        const double sign = c.value < 0 ? -1 : 1, b = sign * quantity(c, after), a = sign * quantity(c, before);
        const double wanted = std::fabs(c.value);
        if (b < wanted * (1 - met)) continue;
        const double share = b > wanted * (1 + met) && b > a ? std::max((wanted - a) / (b - a), 0.0) : 1;
        if (share < least) {
            least = share;
            *which = static_cast<int>(k);
        }
    }
    return least;
}

// Whether a quantity that exceeds its threshold has not come closer to it although the step was shortened: a force on a rigid-plastic
// part jumps.
bool Simulation::jumps(int which) {
    const Condition& c = until_[static_cast<size_t>(which)];
    const double reached = std::fabs(quantity(c, fine_)), before = overshot_;
    overshot_ = reached;
    return before - reached < 0.1 * (before - std::fabs(c.value));
}

// Whether a step of a quasi-static stage releases elastic energy that its loads and drives do not take up: a load was removed at once, or
// something snapped.  The path to the next equilibrium is an estimate then.
bool Simulation::springs_back(const State& after) const {
    if (!stepper_.stage().quasi_static || !stepper_.elastic()) return false;
    const double work = std::max(after.load_work - state_.load_work, after.external_work - state_.external_work);
    const double dragged = after.dragged - state_.dragged;
    return dragged > work && dragged > lost_share * (energies(model_, state_).elastic - energies(model_, after).elastic);
}

// Whether the structure moves far in a quasi-static stage while loads do more work than it absorbs: there is no equilibrium nearby.
// The motion of drives is prescribed, so their work counts as absorbed.
bool Simulation::lost(const State& before, Record& record) {
    if (!stepper_.stage().quasi_static) return false;
    auto drag_share = [&](const State& since) {
        const double work = state_.load_work - since.load_work, all = state_.external_work - since.external_work;
        return work > 0 ? (state_.dragged - since.dragged) / std::max(work, all) : 0;
    };
    if (drag_share(before) < lost_share) {
        lost_ = 0;
        return false;
    }
    if (lost_ == 0) held_ = before;
    lost_++;
    const double share = drag_share(held_);
    const bool far = worst_place(state_, held_, false) >= longest_snap || lost_ >= most_lost;
    if (share < snap_share || !far) return false;
    const bool unheld = share > unheld_share;
    record.outcome = unheld ? Outcome::unheld : Outcome::limit_load;
    record.reason = unheld ? "loads or gravity move it in a quasi-static stage, and nothing resists"
                           : "loads or gravity pass what the structure can carry in a quasi-static stage";
    record.lost_time = held_.t;
    return true;
}

}  // namespace crumple::spatial
