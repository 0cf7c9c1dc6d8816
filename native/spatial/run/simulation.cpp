#include "spatial/run/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "common/pause.hpp"

namespace crumple::spatial {

namespace {

// Rotation [rad] by which a locked hinge may creep; the work of the strongest hinge over it is negligible in the energy balance.
constexpr double negligible_turn = 1e-9;
// Share of the energy of a given motion that remains by rounding if the joints suppress the whole motion.
constexpr double negligible_share = 1e-9;
// Rate at which locked hinges may creep relative to the accuracy [rad/s]: in 0.1 s by 1e-3 of the accuracy, in rad; and its limit.
constexpr double creep_share = 1e-2, widest_creep = 1e-5;
// Energy of an approach below which it is not treated as an impact, as a share of accuracy times the largest energy.
constexpr double negligible_impact = 1e-3;
// Gap [model lengths, the first times accuracy] below which a contact counts as closed: more than the motion in a smallest step.
constexpr double closed_gap = 1e-3, least_closed_gap = 1e-8;
// Change of the friction limits between passes that ends them, relative to the accuracy; and its bounds.
constexpr double settled_share = 2e-2, least_settled = 1e-6, most_settled = 1e-5;
}  // namespace

Simulation::Simulation(Model model, const Settings& settings)
    : model_(std::move(model)), settings_(settings), stepper_(model_), length_(settings.minimum_step, settings.maximum_step),
      step_tolerance_(step_tolerance(settings.accuracy)) {
    stepper_.set_narrowest_ramp(std::min(creep_share * settings.accuracy, widest_creep));
    stepper_.contacts().set_settled(std::clamp(settled_share * settings.accuracy, least_settled, most_settled));
    state_ = stepper_.start();
    first_ = state_;
    stepper_.set_obstacles(std::vector<bool>(model_.contact.obstacles.size(), true), state_);
    moment_max_.assign(model_.hinges.size(), 0.0);
}

// Preparation that takes long with many hinges and must therefore be cancellable.
void Simulation::make_ready() {
    if (ready_) return;
    set_damping();
    ready_ = true;
}

// The effective inertia of every damper is evaluated at the start.
void Simulation::set_damping() {
    critical_.clear();
    stepper_.free_hinges(state_);
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        SpatialHinge& hinge = model_.hinges[j];
        for (int k = 0; k < size(hinge); k++) {
            hinge::Hinge& law = hinge.components[static_cast<size_t>(k)].law;
            if (law.damping > 0) law.damped_inertia = stepper_.effective_inertia(j, k);
            for (hinge::Stop& stop : law.stop) {
                if (std::isnan(stop.damping)) critical_.push_back({j, k, &stop});
            }
        }
    }
    set_critical_damping(std::vector<bool>(critical_.size(), true));
}

// Whether a stop may be touched in the next step.  A stop without a damper in the input gets critical damping, c = 2 sqrt(k m), with the
// effective inertia m just before contact (m at the start of the run if the contact was not foreseen).
bool Simulation::touched_soon(const Critical& c) const {
    const SpatialHinge& hinge = model_.hinges[c.hinge];
    const double sign = c.stop == &hinge.components[static_cast<size_t>(c.component)].law.stop[0] ? 1 : -1;
    const size_t k = static_cast<size_t>(stepper_.first_component(c.hinge) + c.component);
    const double gap = sign * state_.turned[k] - c.stop->rotation;
    return gap <= 0 && gap + 2 * length_.allowed() * std::fabs(state_.rate[k]) > 0;
}

// After an accepted step of length h: sets the dampers of stops that may be touched in the next one, and records the step for followers.
void Simulation::record_step(double h) {
    std::vector<bool> soon;
    for (const Critical& c : critical_) soon.push_back(touched_soon(c));
    set_critical_damping(soon);
    if (step_records_) step_records_->push_back({h, state_.t, predicted_, change_, passes_, soon});
}

void Simulation::set_critical_damping(const std::vector<bool>& which) {
    if (std::find(which.begin(), which.end(), true) == which.end()) return;
    stepper_.free_hinges(state_);
    const Critical* last = nullptr;
    double inertia = 0;
    for (size_t i = 0; i < critical_.size(); i++) {
        const Critical& c = critical_[i];
        if (!which[i]) continue;
        // both stops of a component have the same effective inertia
        if (!last || last->hinge != c.hinge || last->component != c.component) {
            inertia = stepper_.effective_inertia(c.hinge, c.component);
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

void Simulation::watch(Record& record) {
    scale_ = std::max(scale_, worst_place(state_, first_, false));
    speed_ = std::max(speed_, kinetic_norm(model_, state_, nullptr));
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        moment_max_[j] = std::max(moment_max_[j], length_of_moment(model_.hinges[j], state_.hinge[j]));
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

// Energy supplied to the structure until now: its own at the start, the largest work on it, and the largest energy that obstacles have
// transferred to it.  Energy that a heavy obstacle keeps is not part of it.
double Simulation::given(const Energies& e) const {
    return start_.balance() - start_.obstacle_kinetic + std::max(work_max_, std::fabs(e.external_work - e.obstacle_work)) +
           std::max(given_max_, std::fabs(e.given() - start_.given()));
}

// Before the first step a rigid hinge has no moment, and no hinge has a sense of rotation.  A short trial step that is discarded
// gives the values to report at the start.
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
    state_.travel = probe.travel;
    state_.last_step = probe.last_step;
    // forces of an impact at the start would be its impulses over the length of the trial step
    if (state_.contact.impact) return;
    state_.acceleration = probe.acceleration;
    state_.joint_force = probe.joint_force;
    state_.contact.force = probe.contact.force;
}

// reference values of a run to the given time: above which motion counts as large, below which it is rounding
void Simulation::prepare(double end) {
    const double duration = end - state_.t;
    ahead_.forget();
    advance_.begin(state_.t, duration, stepper_.solves());
    // reference rotation before anything has turned: half the rotation in which the strongest hinge would dissipate all kinetic energy
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
    // speed with the kinetic energy that the strongest hinge dissipates over the smallest rotation that counts as large
    large_speed_ = strongest > 0 ? std::sqrt(2 * strongest * settings_.scale_floor) : negligible_speed_;
    end_ = end - state_.stage_start;
    bound_steps();
    if (!started_) start_ = e;
    started_ = true;
    balance_ = e.balance();
    length_.begin(duration);
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
        // in a quasi-static stage a step ends at every output
        const bool passed = !stepper_.stage().quasi_static;
        outputs_ = passed ? times : std::vector<double>{};
        for (next_output_ = 0; next_output_ < outputs_.size() && outputs_[next_output_] <= state_.t; next_output_++) store(record, state_);
        for (size_t k = passed ? times.size() - 1 : 0; k < times.size(); k++) {
            const bool reached = times[k] <= state_.t || advance(times[k], record, poll);
            // a run that ends early records its last state as well
            if ((reached && !passed) || record.time.empty() || record.time.back() < state_.t) store(record, state_);
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
