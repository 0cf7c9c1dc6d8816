#include "planar/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "common/pause.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// Rotation [rad] by which a locked hinge may creep; the work of the strongest hinge over it is negligible in the energy balance.
constexpr double negligible_turn = 1e-9;
// Without loads or drives that vary, motion below this share of the slowest relevant speed is rounding: the structure is locked.
constexpr double rounded = 1e-6;
}  // namespace

Simulation::Simulation(Model model, const Settings& settings)
    : model_(std::move(model)), settings_(settings), stepper_(model_), step_tolerance_(step_tolerance(settings.accuracy)) {
    const std::vector<Real> rest(static_cast<size_t>(model_.tree.dofs()), 0.0);
    state_ = stepper_.start(model_.q0.data(), rest.data());
    for (auto* v : {&between_, &turned_, &sped_}) v->resize(rest.size());
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
    for (Hinge& hinge : model_.hinges) {
        if (hinge.damping > 0) hinge.damped_inertia = stepper_.effective_inertia(state_, hinge.dof);
        for (Stop& stop : hinge.stop) {
            if (std::isnan(value(stop.damping))) critical_.push_back({&hinge, &stop});
        }
    }
    set_critical_damping(true);
}

// A stop without a damper in the input gets critical damping, c = 2 sqrt(k m), with the effective inertia m just before contact (m
// at the start of the run if the contact was not foreseen).
void Simulation::set_critical_damping(bool all) {
    const Hinge* last = nullptr;
    Real inertia = 0;
    for (const Critical& c : critical_) {
        const auto dof = static_cast<size_t>(c.hinge->dof);
        const double sign = c.stop == &c.hinge->stop[0] ? 1 : -1;
        const double gap = value(sign * state_.q[dof] - c.stop->rotation), rate = value(state_.w[dof]);
        const bool soon = gap <= 0 && gap + 2 * h_ * std::fabs(rate) > 0;
        if (!all && !soon) continue;
        // both stops of a hinge have the same effective inertia
        if (c.hinge != last) inertia = stepper_.effective_inertia(state_, c.hinge->dof);
        last = c.hinge;
        c.stop->damping = 2 * sqrt(c.stop->stiffness * inertia);
    }
}

Real Simulation::set_motion(const Twist* velocity, const Twist* impulse) {
    Real given = 0;
    std::vector<Twist> target(static_cast<size_t>(model_.tree.bodies()));
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const Body& b = model_.tree[i];
        const auto k = static_cast<size_t>(i);
        target[k] = {velocity[i].w + impulse[i].w / b.inertia, velocity[i].v + (1 / b.mass) * impulse[i].v};
        given += (b.mass * dot(target[k].v, target[k].v) + b.inertia * target[k].w * target[k].w) / 2;
    }
    const std::vector<Twist> none(target.size());
    std::vector<Real> w(static_cast<size_t>(model_.tree.dofs()));
    stepper_.project(state_, target.data(), none.data(), w.data());
    set_rates(w.data());
    return given - energies(model_, state_).kinetic;
}

void Simulation::set_rates(const Real* w) {
    const std::vector<Real> q = state_.q;
    state_ = stepper_.start(q.data(), w);
}

// Step limits of loads and drives that vary with time, and the speeds that count as negligible and as large.
void Simulation::bound_steps(double duration) {
    auto plain = [](const std::vector<Real>& given) {
        std::vector<double> out;
        for (const Real& x : given) out.push_back(value(x));
        return out;
    };
    bound_ = {};
    grouped_.clear();
    for (size_t k = 0; k < model_.loads.size(); k++) {
        const Curve& curve = model_.loads[k].value;
        const int group = bound_.add_load(plain(curve.places()), plain(curve.values()));
        if (group < 0) continue;
        grouped_.resize(std::max(grouped_.size(), static_cast<size_t>(group) + 1));
        grouped_[static_cast<size_t>(group)].push_back(k);
    }
    moved_.assign(grouped_.size(), NAN);
    for (const Drive& d : model_.drives) bound_.add_drive(plain(d.rate.places()), plain(d.rate.values()));
    breaks_ = model_.breaks;
    // prescribed motion that begins with another rate than the structure has is an impact: it gets a step of the smallest length
    if (stepper_.jerked(state_)) {
        breaks_.push_back(state_.t + std::min(settings_.minimum_step, duration / 2));
        std::sort(breaks_.begin(), breaks_.end());
    }
    // speed with the kinetic energy that the strongest hinge dissipates over the smallest rotation that counts as large
    double strongest = 0, mass = 0;
    for (const HingeState& h : state_.hinge) strongest = std::max(strongest, value(h.capacity));
    for (int i = 0; i < model_.tree.bodies(); i++) mass += value(model_.tree[i].mass);
    const double slow = std::sqrt(mass) * settings_.scale_floor * value(model_.length) / std::max(duration, settings_.minimum_step);
    negligible_speed_ = (bound_.empty() ? rounded : 1) * slow;
    large_speed_ = strongest > 0 ? std::sqrt(2 * strongest * settings_.scale_floor) : slow;
}

void Simulation::watch(Record& record) {
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const auto dof = static_cast<size_t>(model_.tree[i].dof);
        scale_ = std::max(scale_, std::fabs(value(state_.q[dof] - model_.q0[dof])));
    }
    speed_ = std::max(speed_, kinetic_norm(model_.tree, state_.velocity, nullptr));
    const Energies e = energies(model_, state_);
    work_max_ = std::max(work_max_, std::fabs(value(e.external_work)));
    const double reference = std::max(start_energy_ + work_max_, negligible_energy_);
    residual_max_ = std::max(residual_max_, std::fabs(value(e.balance()) - start_energy_));
    if (reference > 0) record.residual = residual_max_ / reference;
}

void Simulation::store(Record& r) const {
    r.time.push_back(state_.t);
    r.q.insert(r.q.end(), state_.q.begin(), state_.q.end());
    r.w.insert(r.w.end(), state_.w.begin(), state_.w.end());
    for (size_t i = 0; i < state_.pose.size(); i++) {
        const Pose& p = state_.pose[i];
        const Twist& v = state_.velocity[i];
        r.pose.insert(r.pose.end(), {p.phi, p.origin.x, p.origin.y});
        r.velocity.insert(r.velocity.end(), {v.w, v.v.x, v.v.y});
    }
    for (size_t j = 0; j < state_.hinge.size(); j++) {
        const Hinge& hinge = model_.hinges[j];
        const HingeState& s = state_.hinge[j];
        const Real& rotation = state_.q[static_cast<size_t>(hinge.dof)];
        r.hinge.rotation.push_back(rotation);
        r.hinge.rate.push_back(state_.w[static_cast<size_t>(hinge.dof)]);
        r.hinge.plastic.push_back(s.plastic);
        r.hinge.moment.push_back(s.total_moment);
        r.hinge.capacity.push_back(s.capacity);
        r.hinge_energy.dissipated.push_back(s.dissipated + s.damped + s.stop_dissipated);
        r.hinge_energy.elastic.push_back(elastic_energy(hinge, s));
        r.hinge_energy.stop.push_back(stop_energy(hinge, rotation));
    }
    const Energies e = energies(model_, state_);
    r.energy.kinetic.push_back(e.kinetic);
    r.energy.elastic.push_back(e.elastic);
    r.energy.dissipated.push_back(e.dissipated);
    r.energy.damped.push_back(e.damped);
    r.energy.stop.push_back(e.stop);
    r.energy.external_work.push_back(e.external_work);
    for (auto* none : {&r.energy.spring, &r.energy.contact, &r.energy.friction, &r.energy.slowed}) none->push_back(0.0);
    r.drive.insert(r.drive.end(), state_.drive_impulse.begin(), state_.drive_impulse.end());
}

Record Simulation::present() const {
    Record record;
    store(record);
    return record;
}

// Before the first step a rigid hinge has no moment, and no hinge has a sense of rotation.  A short trial step that is discarded
// gives the moments and capacities to report at the start.
void Simulation::show_first_moments() {
    State probe = state_;
    if (state_.t > 0 || !stepper_.step(probe, 100 * settings_.minimum_step)) return;
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        state_.hinge[j].capacity = probe.hinge[j].capacity;
        if (model_.hinges[j].form != Form::elastic_plastic) state_.hinge[j].total_moment = probe.hinge[j].total_moment;
    }
}

Record Simulation::run(const std::vector<double>& times, const std::function<bool(double)>& poll) {
    Record record;
    const std::int64_t solves = stepper_.solves();
    try {
        const Asking asking([&] { return !poll || poll(state_.t); });
        run_to_end(times, poll, record);
    } catch (const Stopped&) {
        record.outcome = Outcome::cancelled;
    }
    record.solves = stepper_.solves() - solves;
    return record;
}

void Simulation::run_to_end(const std::vector<double>& times, const std::function<bool(double)>& poll, Record& record) {
    make_ready();
    const double duration = times.back() - state_.t;
    advance_.begin(state_.t, duration, stepper_.solves());
    // reference rotation before anything has turned: half the rotation in which the strongest hinge would dissipate all kinetic energy
    double strongest = 0;
    for (const HingeState& h : state_.hinge) strongest = std::max(strongest, value(h.capacity));
    negligible_energy_ = negligible_turn * strongest;
    const double expected = strongest > 0 ? value(energies(model_, state_).kinetic) / strongest / 2 : 0;
    scale_ = std::max(scale_, std::clamp(expected, settings_.scale_floor, 0.5));
    speed_ = std::max(speed_, kinetic_norm(model_.tree, state_.velocity, nullptr));
    start_energy_ = value(energies(model_, state_).balance());
    begin_ = state_.t;
    end_ = times.back();
    bound_steps(duration);
    if (h_ <= 0) {
        h_ = std::clamp(duration / 100, settings_.minimum_step, settings_.maximum_step);
        stepper_.set_drift_time(2 * h_);
    }
    show_first_moments();
    for (const double t : times) {
        const bool reached = t <= state_.t || advance(t, record, poll);
        // a run that ends early records its last state as well
        if (reached || record.time.empty() || record.time.back() < state_.t) store(record);
        if (!reached) break;
    }
    if (unseen_ > 0) record.unseen = unseen_ / std::max(speed_, large_speed_);
}

HingeSummary<Real> hinge_summary(const Simulation& simulation) {
    HingeSummary<Real> out;
    const std::vector<HingeState>& states = simulation.state().hinge;
    for (size_t j = 0; j < states.size(); j++) {
        const HingeState& s = states[j];
        out.rotation_max.push_back(s.rotation_max);
        out.moment_max.push_back(s.moment_max);
        out.rest_time.push_back(s.rest_time);
        out.turning.push_back(turning(simulation.model().hinges[j], s) ? 1.0 : 0.0);
        out.energy.push_back(s.dissipated + s.damped + s.stop_dissipated);
        // hinges of the planar kernel do not fracture, and their opening is not monitored
        for (auto* none : {&out.opening_time, &out.fracture_time, &out.fracture_moment}) none->push_back(NAN);
    }
    return out;
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
