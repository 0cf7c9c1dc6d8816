// Recording of a run.
#include <limits>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

namespace {

void add(std::vector<double>& out, Vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }

void add(std::vector<double>& out, const Twist& t) {
    add(out, t.w);
    add(out, t.v);
}

}  // namespace

void Simulation::store(Record& r, State& state) {
    r.time.push_back(state.t);
    r.step.push_back(state.last_step);
    for (size_t i = 0; i < state.pose.size(); i++) {
        const Quat& q = state.pose[i].q;
        add(r.centre, state.pose[i].x);
        r.rotation.push_back(q.w);
        add(r.rotation, q.v);
        add(r.velocity, state.velocity[i]);
        add(r.acceleration, state.acceleration[i]);
        add(r.travel, state.travel[i]);
    }
    size_t first = 0;
    for (size_t j = 0; j < state.hinge.size(); j++) {
        const SpatialHinge& hinge = model_.hinges[j];
        const SpatialHingeState& s = state.hinge[j];
        for (int k = 0; k < size(hinge); k++) {
            r.hinge.plastic.push_back(s.component[k].plastic);
            r.hinge.moment.push_back(s.component[k].total_moment);
            r.hinge.capacity.push_back(s.component[k].capacity);
        }
        r.hinge_energy.dissipated.push_back(dissipated(hinge, s) + damped(hinge, s) + stop_dissipated(hinge, s));
        r.hinge_energy.elastic.push_back(elastic_energy(hinge, s));
        r.hinge_energy.stop.push_back(stop_energy(hinge, &state.turned[first]));
        first += static_cast<size_t>(size(hinge));
    }
    r.hinge.rotation.insert(r.hinge.rotation.end(), state.rotation.begin(), state.rotation.end());
    r.hinge.rate.insert(r.hinge.rate.end(), state.rate.begin(), state.rate.end());
    for (const Twist& f : state.joint_force) {
        add(r.joint_force, f.v);
        add(r.joint_force, f.w);
    }
    // mean force since the last stored row, which contains the impulses of impacts; in quasi-static stages that of the last step
    stored_impulse_.resize(model_.contact.obstacles.size());
    state.contact.impulse.resize(stored_impulse_.size());
    state.contact.force.resize(stored_impulse_.size());
    for (size_t o = 0; o < stored_impulse_.size(); o++) {
        const Vec3 gained = state.contact.impulse[o] - stored_impulse_[o];
        const double time = state.t - stored_time_;
        const bool mean = !stepper_.stage().quasi_static && stored_time_ >= 0 && time > 0;
        add(r.obstacle_force, mean ? (1 / time) * gained : state.contact.force[o]);
        stored_impulse_[o] = state.contact.impulse[o];
    }
    stored_time_ = state.t;
    const Energies e = energies(model_, state);
    r.energy.kinetic.push_back(e.kinetic);
    r.energy.elastic.push_back(e.elastic);
    r.energy.dissipated.push_back(e.dissipated);
    r.energy.damped.push_back(e.damped);
    r.energy.stop.push_back(e.stop);
    r.energy.spring.push_back(e.spring);
    r.energy.contact.push_back(e.contact);
    r.energy.friction.push_back(e.friction);
    r.energy.external_work.push_back(e.external_work);
    r.energy.slowed.push_back(e.slowed);
}

// Advances a state to a time within the step that follows it.  That step has been solved, so a single pass is enough.
bool Simulation::move_within(State& state, double t) {
    const State& next = state.t < half_.t ? half_ : state_;
    const double h = t - state.t, share = h / (next.t - state.t);
    if (h < settings_.minimum_step) return false;
    std::vector<Twist> end(state.velocity.size());
    for (size_t i = 0; i < end.size(); i++) end[i] = state.velocity[i] + share * (next.velocity[i] - state.velocity[i]);
    const std::vector<SpatialHingeState> start = state.hinge;
    const bool solved = stepper_.step(state, h, &end, true);
    state.t = t;
    // a peak of moment within a step over a vibration is not one of the step: what it would dissipate never is
    for (size_t j = 0; j < state.hinge.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            const double from = start[j].component[k].dissipated, to = next.hinge[j].component[k].dissipated;
            double& present = state.hinge[j].component[k].dissipated;
            present = std::clamp(present, std::min(from, to), std::max(from, to));
        }
    }
    return solved;
}

// The state at an output time.  Forces and accelerations are means over a step: the last one takes at most a quarter of the time since the
// output before.
bool Simulation::at_output(State& state, double t) {
    const double since = next_output_ > 0 ? outputs_[next_output_ - 1] : stored_time_, near = t - (t - since) / 4;
    if (near - state.t > settings_.minimum_step && !move_within(state, near)) return false;
    return move_within(state, t);
}

// Stores the rows of the output times that the last step has passed; `fine_` is the state before it.  From a time on that cannot be solved
// again, rows have the state of the end of the step: that of its start could lie before the row above.
void Simulation::store_passed(Record& record) {
    stepper_.keep(nullptr);
    bool solvable = true;
    for (; next_output_ < outputs_.size() && outputs_[next_output_] <= state_.t; next_output_++) {
        const double t = outputs_[next_output_];
        const State& before = t <= half_.t ? fine_ : half_;
        State at = before;
        const bool apart = t - before.t > settings_.minimum_step, solved = solvable && at_output(at, t);
        solvable = solvable && (solved || !apart);
        if (t == state_.t) {
            State end = state_;
            if (solved) end.take_means(at);
            store(record, end);
            continue;
        }
        if (!solved) {
            at = apart ? state_ : before;
            at.t = t;
        }
        store(record, at);
    }
}

Record Simulation::present() {
    Record r;
    store(r, state_);
    return r;
}

HingeSummary<double> Simulation::summary() const {
    HingeSummary<double> out;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (size_t j = 0; j < state_.hinge.size(); j++) {
        const SpatialHinge& hinge = model_.hinges[j];
        const SpatialHingeState& s = state_.hinge[j];
        const bool whole = s.fracture_time < 0;
        out.rotation_max.push_back(s.rotation_max);
        out.moment_max.push_back(moment_max_[j]);
        out.opening_time.push_back(s.opening_time < 0 ? none : s.opening_time);
        out.rest_time.push_back(s.rest_time);
        out.turning.push_back(turning(hinge, s) ? 1.0 : 0.0);
        out.energy.push_back(dissipated(hinge, s) + damped(hinge, s) + stop_dissipated(hinge, s));
        out.fracture_time.push_back(whole ? none : s.fracture_time);
        out.fracture_moment.push_back(whole ? none : s.fracture_moment);
    }
    return out;
}

}  // namespace crumple::spatial
