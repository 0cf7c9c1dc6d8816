// Transition between the stages of a sequence: the state continues in a model with other drives, loads and obstacles.
#include <algorithm>

#include "shell/run/simulation.hpp"

namespace crumple::shell {

void Simulation::go_on_from(const Checkpoint& saved) {
    Checkpoint own = saved;
    own.drives = save().drives;      // the drives of this stage
    restore(own);
    contact_->obstacles().place(motions());
    contact_->search(motions(), alive_, {});
    for (Driven& d : driven_) std::copy_n(kick_driven(d).outside, 6, d.outside);
    for (std::size_t i = 0; i < bodies_.size(); i++) {
        RigidState state = body_states_[i];
        std::copy_n(kick_body(i, state).outside, 6, body_drives_[i].outside);
    }
}

void Simulation::add_motion(const double* velocity, const double* spin) {
    const double before = kinetic();
    auto add = [&](Index n, unsigned held) {
        for (std::size_t k = 0; k < 6; k++) {
            const std::size_t at = velocity_record * n + (k < 3 ? k : k + 1);
            if (inverse_mass_[at] > 0.0 && !(held & (1u << k))) velocity_[at] += k < 3 ? velocity[3 * n + k] : spin[3 * n + k - 3];
        }
    };
    for (Index n = 0; n < model_->nodes(); n++)
        if (kind_[n] == 0 || kind_[n] == tied_node) add(n, 0);
    fit_welds();
    for (const Driven& d : driven_) add(d.node, d.held);
    for (std::size_t b = 0; b < bodies_.size(); b++) push(bodies_[b], body_states_[b], masses_, velocity, spin);
    outside_work_ += kinetic() - before;
}

void Simulation::stop() {
    body_damping_ += kinetic() - contact_->obstacles().kinetic(kick()) + contact_->obstacles().stop();
    std::fill(velocity_.begin(), velocity_.end(), 0.0);
    for (RigidState& s : body_states_) s.velocity = s.angular_momentum = s.omega = Vec3{};
}

}  // namespace crumple::shell
