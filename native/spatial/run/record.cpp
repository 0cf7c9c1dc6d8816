// What a run records.
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
    for (size_t i = 0; i < state_.pose.size(); i++) {
        const Quat& q = state_.pose[i].q;
        add(r.centre, state_.pose[i].x);
        r.rotation.push_back(q.w);
        add(r.rotation, q.v);
        add(r.velocity, state_.velocity[i]);
        add(r.acceleration, state_.acceleration[i]);
    }
    size_t first = 0;
    for (size_t j = 0; j < state_.hinge.size(); j++) {
        const SpatialHinge& hinge = model_.hinges[j];
        const SpatialHingeState& s = state_.hinge[j];
        for (int k = 0; k < size(hinge); k++) {
            r.hinge_plastic.push_back(s.component[k].plastic);
            r.hinge_moment.push_back(s.component[k].total_moment);
            r.hinge_capacity.push_back(s.component[k].capacity);
        }
        r.hinge_energy.push_back(dissipated(hinge, s) + damped(hinge, s) + stop_dissipated(hinge, s));
        r.hinge_energy.push_back(elastic_energy(hinge, s));
        r.hinge_energy.push_back(stop_energy(hinge, &state_.turned[first]));
        first += static_cast<size_t>(size(hinge));
    }
    r.hinge_rotation.insert(r.hinge_rotation.end(), state_.rotation.begin(), state_.rotation.end());
    r.hinge_rate.insert(r.hinge_rate.end(), state_.rate.begin(), state_.rate.end());
    for (const Twist& f : state_.joint_force) {
        add(r.joint_force, f.v);
        add(r.joint_force, f.w);
    }
    // mean since it was last stored: an impact's impulse counts as it should; without impacts that of the last step
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
    r.energy.insert(r.energy.end(), {e.kinetic, e.elastic, e.dissipated, e.damped, e.stop, e.spring, e.contact, e.friction,
                                     e.external_work, e.slowed});
}

Record Simulation::present() {
    Record r;
    store(r);
    return r;
}

std::vector<double> Simulation::summary() const {
    std::vector<double> out;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (size_t j = 0; j < state_.hinge.size(); j++) {
        const SpatialHinge& hinge = model_.hinges[j];
        const SpatialHingeState& s = state_.hinge[j];
        double moment = 0;
        for (int k = 0; k < size(hinge); k++) {
            const size_t c = static_cast<size_t>(stepper_.first_component(j) + k);
            if (hinge.components[static_cast<size_t>(k)].freedom >= 3) moment = std::max(moment, peak_[2 * c + 1]);
        }
        out.insert(out.end(), {s.rotation_max, moment, s.opening_time < 0 ? none : s.opening_time, s.rest_time,
                               turning(hinge, s) ? 1.0 : 0.0, dissipated(hinge, s) + damped(hinge, s) + stop_dissipated(hinge, s),
                               s.fracture_time < 0 ? none : s.fracture_time, s.fracture_time < 0 ? none : s.fracture_moment});
    }
    return out;
}

std::vector<double> Simulation::peaks() const { return peak_; }

}  // namespace crumple::spatial
