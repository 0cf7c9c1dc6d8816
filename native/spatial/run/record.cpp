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

void Simulation::store(Record& r) {
    r.time.push_back(state_.t);
    r.step.push_back(state_.last_step);
    for (size_t i = 0; i < state_.pose.size(); i++) {
        const Quat& q = state_.pose[i].q;
        add(r.centre, state_.pose[i].x);
        r.rotation.push_back(q.w);
        add(r.rotation, q.v);
        add(r.velocity, state_.velocity[i]);
        add(r.acceleration, state_.acceleration[i]);
        add(r.travel, state_.travel[i]);
    }
    size_t first = 0;
    for (size_t j = 0; j < state_.hinge.size(); j++) {
        const SpatialHinge& hinge = model_.hinges[j];
        const SpatialHingeState& s = state_.hinge[j];
        for (int k = 0; k < size(hinge); k++) {
            r.hinge.plastic.push_back(s.component[k].plastic);
            r.hinge.moment.push_back(s.component[k].total_moment);
            r.hinge.capacity.push_back(s.component[k].capacity);
        }
        r.hinge_energy.dissipated.push_back(dissipated(hinge, s) + damped(hinge, s) + stop_dissipated(hinge, s));
        r.hinge_energy.elastic.push_back(elastic_energy(hinge, s));
        r.hinge_energy.stop.push_back(stop_energy(hinge, &state_.turned[first]));
        first += static_cast<size_t>(size(hinge));
    }
    r.hinge.rotation.insert(r.hinge.rotation.end(), state_.rotation.begin(), state_.rotation.end());
    r.hinge.rate.insert(r.hinge.rate.end(), state_.rate.begin(), state_.rate.end());
    for (const Twist& f : state_.joint_force) {
        add(r.joint_force, f.v);
        add(r.joint_force, f.w);
    }
    // mean force since the last stored row, which contains the impulses of impacts; in quasi-static stages that of the last step
    stored_impulse_.resize(model_.contact.obstacles.size());
    state_.contact.impulse.resize(stored_impulse_.size());
    state_.contact.force.resize(stored_impulse_.size());
    for (size_t o = 0; o < stored_impulse_.size(); o++) {
        const Vec3 gained = state_.contact.impulse[o] - stored_impulse_[o];
        const double time = state_.t - stored_time_;
        const bool mean = !stepper_.stage().quasi_static && stored_time_ >= 0 && time > 0;
        add(r.obstacle_force, mean ? (1 / time) * gained : state_.contact.force[o]);
        stored_impulse_[o] = state_.contact.impulse[o];
    }
    stored_time_ = state_.t;
    const Energies e = energies(model_, state_);
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

Record Simulation::present() {
    Record r;
    store(r);
    return r;
}

HingeSummary<double> Simulation::summary() const {
    HingeSummary<double> out;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (size_t j = 0; j < state_.hinge.size(); j++) {
        const SpatialHinge& hinge = model_.hinges[j];
        const SpatialHingeState& s = state_.hinge[j];
        double moment = 0;
        for (int k = 0; k < size(hinge); k++) {
            const size_t c = static_cast<size_t>(stepper_.first_component(j) + k);
            if (hinge.components[static_cast<size_t>(k)].freedom >= 3) moment = std::max(moment, peak_[2 * c + 1]);
        }
        const bool whole = s.fracture_time < 0;
        out.rotation_max.push_back(s.rotation_max);
        out.moment_max.push_back(moment);
        out.opening_time.push_back(s.opening_time < 0 ? none : s.opening_time);
        out.rest_time.push_back(s.rest_time);
        out.turning.push_back(turning(hinge, s) ? 1.0 : 0.0);
        out.energy.push_back(dissipated(hinge, s) + damped(hinge, s) + stop_dissipated(hinge, s));
        out.fracture_time.push_back(whole ? none : s.fracture_time);
        out.fracture_moment.push_back(whole ? none : s.fracture_moment);
    }
    return out;
}

std::vector<double> Simulation::peaks() const { return peak_; }

}  // namespace crumple::spatial
