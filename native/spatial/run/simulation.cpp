#include "spatial/run/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "common/pause.hpp"

namespace crumple::spatial {

namespace {

// Error that one step may add, measured by the difference between one step and two halves.  The local error goes
// with h^3 and the error of the whole motion with h^2, so below `loosest_share` the share of a step shrinks with
// the square root of the accuracy, as in the planar engine.  With the whole accuracy for a step M3 errs by just that.
constexpr double loosest_share = 1e-3, step_share = 0.4;

// The same out of equilibrium in a quasi-static stage, where without inertia no way is more than a guess.
constexpr double lost_tolerance = 2e-2;

double step_tolerance(double accuracy) { return step_share * accuracy * std::min(1.0, std::sqrt(accuracy / loosest_share)); }

// Turn [rad] by which a locked hinge may creep; the strongest hinge's work over it is no energy worth balancing.
constexpr double negligible_turn = 1e-9;
// Share of the energy of a given motion that rounding leaves where the joints take it all.
constexpr double negligible_share = 1e-9;
// Share of all kinetic energy, that of heavy obstacles included, below which energies are rounding.
constexpr double rounding_share = 1e-10;
// Rate at which locked hinges may creep, over the accuracy [rad/s]: in 0.1 s 1e-3 of the accuracy, in rad.
constexpr double creep_share = 1e-2, widest_creep = 1e-5;
constexpr double safety = 0.9, shrink_limit = 0.2, growth_limit = 4;
constexpr std::int64_t poll_interval = 20'000;  // solves times rows between calls of `poll`: some 10 ms
// Energy of an approach that is not worth an impact, as a share of accuracy times the largest energy.
constexpr double negligible_impact = 1e-3;
// Gap [model lengths, the first times accuracy] below which a contact counts as closed: more than a smallest step goes.
constexpr double closed_gap = 1e-3, least_closed_gap = 1e-8;
// Impacts in a row that only what cannot give way leads to.
constexpr int most_strikes = 1000;
// Steps are not shortened below this many smallest ones to end where a contact closes.
constexpr double shortest_landing = 4;

// of the structure's velocities, or of the difference of all bodies' between two states
double kinetic_norm(const Model& model, const State& a, const State* b) {
    double e = 0;
    for (size_t i = 0; i < model.bodies.size(); i++) {
        const Body& body = model.bodies[i];
        if (!b && body.obstacle) continue;
        const Twist v = b ? a.velocity[i] - b->velocity[i] : a.velocity[i];
        const Vec3 w = turned(conjugate(a.pose[i].q), v.w);
        e += body.mass * dot(v.v, v.v) + dot(w, body.inertia * w);
    }
    return std::sqrt(e);
}

}  // namespace

Simulation::Simulation(Model model, const Settings& settings)
    : model_(std::move(model)), settings_(settings), stepper_(model_), step_tolerance_(step_tolerance(settings.accuracy)) {
    stepper_.set_narrowest_ramp(std::min(creep_share * settings.accuracy, widest_creep));
    state_ = stepper_.start();
    first_ = state_;
    stepper_.set_obstacles(std::vector<bool>(model_.contact.obstacles.size(), true), state_);
    peak_.assign(2 * state_.rotation.size(), 0.0);
}

// What takes long for many hinges, and must end where a run is cancelled.
void Simulation::make_ready() {
    if (ready_) return;
    set_damping();
    ready_ = true;
}

// The inertia that a damper feels is taken at the start.
void Simulation::set_damping() {
    critical_.clear();
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        SpatialHinge& hinge = model_.hinges[j];
        for (int k = 0; k < size(hinge); k++) {
            hinge::Hinge& law = hinge.components[static_cast<size_t>(k)].law;
            if (law.damping > 0) law.damped_inertia = stepper_.effective_inertia(state_, j, k);
            for (hinge::Stop& stop : law.stop) {
                if (std::isnan(stop.damping)) critical_.push_back({j, k, &stop});
            }
        }
    }
    set_critical_damping(std::vector<bool>(critical_.size(), true));
}

// A stop without a damper of its own gets the critical one, c = 2 sqrt(k m), m the inertia felt just before the
// stop is touched (at the start, should that come without notice).
bool Simulation::touched_soon(const Critical& c) const {
    const SpatialHinge& hinge = model_.hinges[c.hinge];
    const double sign = c.stop == &hinge.components[static_cast<size_t>(c.component)].law.stop[0] ? 1 : -1;
    const size_t k = static_cast<size_t>(stepper_.first_component(c.hinge) + c.component);
    const double gap = sign * state_.turned[k] - c.stop->rotation;
    return gap <= 0 && gap + 2 * h_ * std::fabs(state_.rate[k]) > 0;
}

// After an accepted step of length h: dampers of stops that may be touched in the next one, and what followers need.
void Simulation::record_step(double h) {
    std::vector<bool> soon;
    for (const Critical& c : critical_) soon.push_back(touched_soon(c));
    set_critical_damping(soon);
    if (step_records_) step_records_->push_back({h, state_.t, passes_, soon});
}

void Simulation::set_critical_damping(const std::vector<bool>& which) {
    const Critical* last = nullptr;
    double inertia = 0;
    for (size_t i = 0; i < critical_.size(); i++) {
        const Critical& c = critical_[i];
        if (!which[i]) continue;
        // both stops of a component feel the same
        if (!last || last->hinge != c.hinge || last->component != c.component) {
            inertia = stepper_.effective_inertia(state_, c.hinge, c.component);
        }
        last = &c;
        c.stop->damping = 2 * std::sqrt(c.stop->stiffness * inertia);
    }
}

double Simulation::worst_place(const State& a, const State& b, bool obstacles) const {
    double worst = 0;
    for (size_t i = 0; i < a.pose.size(); i++) {
        if (!obstacles && model_.bodies[i].obstacle) continue;
        worst = std::max({worst, norm(a.pose[i].x - b.pose[i].x) / model_.length, angle_between(a.pose[i].q, b.pose[i].q)});
    }
    size_t k = 0;
    for (const SpatialHinge& hinge : model_.hinges) {
        for (const Component& c : hinge.components) {
            const double e = std::fabs(a.rotation[k] - b.rotation[k]);
            worst = std::max(worst, c.freedom < 3 ? e / model_.length : e);
            k++;
        }
    }
    return worst;
}

double Simulation::error(const State& coarse, const State& fine) const {
    double worst = worst_place(coarse, fine, true);
    for (size_t j = 0; j < fine.hinge.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            worst = std::max(worst, fine.hinge[j].component[k].overrun - state_.hinge[j].component[k].overrun);
        }
    }
    double e = worst / scale_;
    const double speed = std::max(speed_, negligible_speed_);
    if (speed > 0) e = std::max(e, kinetic_norm(model_, coarse, &fine) / speed);
    e /= lost_ > 0 ? std::max(step_tolerance_, lost_tolerance) : step_tolerance_;
    if (stepper_.stage().quasi_static) return e;
    // a step that leaves more energy unbalanced than the accuracy allows has missed something
    const Energies after = energies(model_, fine);
    const double reference = std::max(given(after), negligible_energy_ + lift_ * scale_ + rounding_share * after.kinetic);
    return reference > 0 ? std::max(e, std::fabs(after.balance() - balance_) / reference / settings_.accuracy) : e;
}

// one step and two halves; the halves know from the whole how the velocities change
bool Simulation::solve(double h) {
    coarse_ = state_;
    passes_.clear();
    stepper_.keep(step_records_ ? &passes_ : nullptr);
    if (!stepper_.step(coarse_, h, nullptr)) return false;
    const std::vector<Twist>& end = stepper_.end_velocity();
    guess_.resize(end.size());
    const bool from_rest = stepper_.stage().quasi_static;
    for (size_t i = 0; i < end.size(); i++) guess_[i] = from_rest ? end[i] : 0.5 * (state_.velocity[i] + end[i]);
    fine_ = state_;
    const std::vector<Twist> last = end;
    if (!stepper_.step(fine_, h / 2, &guess_)) return false;
    closing_ = fine_.contact.closing;
    if (closing_ > 0) return true;
    if (!stepper_.step(fine_, h / 2, &last)) return false;
    if (fine_.contact.closing > 0) closing_ = h / 2 + fine_.contact.closing;
    return true;
}

// The step of an impact: so short that nothing but velocities changes.
bool Simulation::strike(Record& record) {
    if (!stepper_.step(state_, settings_.minimum_step, nullptr)) {
        record.outcome = Outcome::step_collapsed;
        record.reason = "the equations of an impact did not converge";
        return false;
    }
    record.steps++;
    watch(record);
    if (++strikes_ <= most_strikes) return true;
    record.outcome = Outcome::step_collapsed;
    record.reason = "impacts follow on each other without end: an obstacle or a driven part presses on what cannot give way";
    return false;
}

// Whether a step of error e (infinite: not solved) cannot be replaced by a shorter one.
bool Simulation::failed(double e, bool smallest, Record& record) const {
    if (std::isnan(e)) {
        record.outcome = Outcome::not_finite;
        record.reason = "the place of a body is not a number";
        return true;
    }
    if (std::isfinite(e) || !smallest) return false;
    record.outcome = Outcome::step_collapsed;
    record.reason = "the equations of a step did not converge at the smallest step";
    if (!model_.drives.empty()) record.reason += "; where what is driven meets what cannot give way they have no solution";
    return true;
}

// Asks `poll` now and then.
bool Simulation::cancelled(Record& record, const std::function<bool(double)>& poll) {
    const std::int64_t done = stepper_.solves() * std::max(1, stepper_.rows());
    if (done <= poll_at_ || !poll) return false;
    poll_at_ = done + poll_interval;
    if (poll(state_.t)) return false;
    record.outcome = Outcome::cancelled;
    return true;
}

bool Simulation::advance(double target, Record& record, const std::function<bool(double)>& poll) {
    while (state_.t < target) {
        if (cancelled(record, poll) || stalled(record)) return false;
        if (state_.contact.impact) {
            if (!strike(record)) return false;
            continue;
        }
        const double stop = std::min(target, next_break()), left = stop - state_.t;
        const double longest = std::min(h_, longest_part()), ahead = landing_ > 0 ? std::min(landing_, longest) : longest;
        const double wanted = ahead >= left * (1 - 1e-9) ? left : (ahead > left / 2 && landing_ == 0 ? left / 2 : ahead);
        const StepBound::Step seen = resolved(wanted);
        const double h = seen.h;
        const bool last = h == left, cut = last || h < wanted || longest < h_ || landing_ > 0;
        const bool solved = solve(h);
        if (solved && closing_ > 0 && h > shortest_landing * settings_.minimum_step) {
            record.rejected++;
            landing_ = std::max(closing_, settings_.minimum_step);
            continue;
        }
        const double e = solved ? error(coarse_, fine_) : INFINITY;
        const bool smallest = h <= settings_.minimum_step * 1.001;
        if (failed(e, smallest, record)) return false;
        const double factor = e > 0 ? safety * std::pow(e, -1.0 / 3) : growth_limit;
        const double next = std::clamp(h * std::clamp(factor, shrink_limit, growth_limit), settings_.minimum_step,
                                       settings_.maximum_step);
        if (e > 1 && !smallest) {
            record.rejected++;
            h_ = std::max(std::min(next, 0.7 * h), settings_.minimum_step);
            landing_ = 0;
            continue;
        }
        int which = -1;
        const double share = share_of_step(state_, fine_, &which);
        if (share < 1 && !smallest && !jumps(which)) {
            h_ = std::max(share * h, settings_.minimum_step);
            landing_ = 0;
            continue;
        }
        if (e > 1) record.forced++;
        if (last) fine_.t = stop;
        const bool rested = resting();
        std::swap(state_, fine_);
        h_ = cut && e <= 1 ? std::max(h_, next) : next;
        std::fill(moved_.begin(), moved_.end(), NAN);
        landing_ = 0;
        if (seen.unresolved > 0 && (rested || resting())) {
            unseen_ = std::max(unseen_, seen.unresolved * settings_.accuracy * std::max(speed_, large_speed_));
        }
        record.steps++;
        overshot_ = NAN;
        watch(record);
        strikes_ = 0;
        if (lost(fine_, record)) return false;
        if (share <= 1) {
            record.ended_by = which;
            return false;
        }
        record_step(h);
    }
    return true;
}

void Simulation::watch(Record& record) {
    scale_ = std::max(scale_, worst_place(state_, first_, false));
    speed_ = std::max(speed_, kinetic_norm(model_, state_, nullptr));
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            const size_t c = static_cast<size_t>(stepper_.first_component(j) + k);
            peak_[2 * c] = std::max(peak_[2 * c], std::fabs(state_.rotation[c]));
            peak_[2 * c + 1] = std::max(peak_[2 * c + 1], std::fabs(state_.hinge[j].component[k].total_moment));
        }
    }
    const Energies e = energies(model_, state_);
    largest_energy_ = std::max(largest_energy_, e.structure_kinetic());
    stepper_.contacts().set_limits(std::max(closed_gap * settings_.accuracy, least_closed_gap) * model_.length,
                                   negligible_impact * settings_.accuracy * largest_energy_);
    work_max_ = std::max(work_max_, std::fabs(e.external_work - e.obstacle_work));
    given_max_ = std::max(given_max_, std::fabs(e.given() - start_.given()));
    const double reference = std::max(given(e), negligible_energy_ + rounding_share * e.kinetic);
    balance_ = e.balance();
    residual_max_ = std::max(residual_max_, std::fabs(balance_ - start_.balance()));
    if (reference > 0) record.residual = residual_max_ / reference;
}

// Energy that the structure was given until now: its own at the start, the largest work on it, and the largest that
// obstacles have given on.  What a heavy obstacle keeps to itself is none of it.
double Simulation::given(const Energies& e) const {
    return start_.balance() - start_.obstacle_kinetic + std::max(work_max_, std::fabs(e.external_work - e.obstacle_work)) +
           std::max(given_max_, std::fabs(e.given() - start_.given()));
}

// Before the first step a rigid hinge has no moment and no hinge a sense in which it turns; what it will carry at once
// is seen by a step that is thrown away.
void Simulation::show_first_moments() {
    State probe = state_;
    if (state_.t > 0 || !stepper_.step(probe, 100 * settings_.minimum_step, nullptr)) return;
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            hinge::HingeState &seen = probe.hinge[j].component[k], &own = state_.hinge[j].component[k];
            own.capacity = seen.capacity;
            if (model_.hinges[j].components.front().law.form != Form::elastic_plastic) own.total_moment = seen.total_moment;
        }
    }
    state_.acceleration = probe.acceleration;
    state_.travel = probe.travel;
    state_.last_step = probe.last_step;
    state_.joint_force = probe.joint_force;
    state_.contact.force = probe.contact.force;
}

// what counts as large, and as rounding, in a run to the given time
void Simulation::prepare(double end) {
    const double duration = end - state_.t;
    duration_ = duration;
    mark_ = state_.t;
    // the rotation that the strongest hinge would need for all energy: what counts as large before anything has turned
    double strongest = 0;
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            if (model_.hinges[j].components[static_cast<size_t>(k)].freedom < 3) continue;
            strongest = std::max(strongest, state_.hinge[j].component[k].capacity);
        }
    }
    lift_ = 0;
    for (const Body& body : model_.bodies) lift_ += body.mass * norm(model_.gravity) * model_.length;
    negligible_energy_ = negligible_turn * (strongest + lift_) + negligible_share * given_energy_;
    const Energies e = energies(model_, state_);
    const double expected = strongest > 0 ? e.kinetic / strongest / 2 : 0;
    scale_ = std::max(scale_, std::clamp(expected, settings_.scale_floor, 0.5));
    speed_ = std::max(speed_, kinetic_norm(model_, state_, nullptr));
    double mass = 0;
    for (const Body& body : model_.bodies) mass += body.mass;
    negligible_speed_ = std::sqrt(mass) * settings_.scale_floor * model_.length / std::max(duration, settings_.minimum_step);
    // the speed at which the strongest hinge would turn by what counts as large before it stops
    large_speed_ = strongest > 0 ? std::sqrt(2 * strongest * settings_.scale_floor) : negligible_speed_;
    end_ = end - state_.stage_start;
    bound_steps();
    if (!started_) start_ = e;
    started_ = true;
    balance_ = e.balance();
    if (h_ <= 0) h_ = std::clamp(duration / 100, settings_.minimum_step, settings_.maximum_step);
    largest_energy_ = std::max(largest_energy_, e.structure_kinetic());
    stepper_.contacts().set_limits(std::max(closed_gap * settings_.accuracy, least_closed_gap) * model_.length,
                                   negligible_impact * settings_.accuracy * largest_energy_);
    stepper_.look_for_impact(state_);
    show_first_moments();
}

Record Simulation::run(const std::vector<double>& times, const std::function<bool(double)>& poll) {
    Record record;
    const std::int64_t solves = stepper_.solves();
    try {
        const Asking asking([&] { return !poll || poll(state_.t); });
        make_ready();
        prepare(times.back());
        for (const double t : times) {
            const bool reached = t <= state_.t || advance(t, record, poll);
            // a run that ends before its time tells where it came to
            if (reached || record.time.empty() || record.time.back() < state_.t) store(record);
            if (!reached) break;
        }
    } catch (const Stopped&) {
        record.outcome = Outcome::cancelled;
    }
    if (unseen_ > 0) record.unseen = unseen_ / std::max(speed_, large_speed_);
    record.solves = stepper_.solves() - solves;
    if (record.outcome == Outcome::step_collapsed || record.outcome == Outcome::stalled) record.stuck_body = stepper_.stuck_body();
    return record;
}

}  // namespace crumple::spatial
