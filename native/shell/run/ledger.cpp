// Energies at the time of the positions, forces through cuts, and the data of a restart.
//
// Kinetic energy is m v(-) v(+) / 2 with the velocities half a step before and after.  With the work computed from the
// mean of the forces at the start and end of a step, the energies of the central difference scheme balance to round-off
// except for the change of shape within a step (docs/theory/explicit_stepper.md).
#include <algorithm>

#include "shell/run/simulation.hpp"

namespace crumple::shell {

double Simulation::slot(std::size_t e, int s) const { return state_[blocks_.slot(e, s)]; }

static double of_body(const RigidBody& b, const RigidState& before, const RigidState& after, const double* velocity) {
    return 0.5 * b.mass * dot(before.velocity, read3(velocity)) +
           0.5 * dot(before.angular_momentum, solve(world_inertia(b, before.rotation), after.angular_momentum));
}

double Simulation::kinetic() const {
    double sum = 0.0;
    const double a = 0.5 * kick() * model_->settings.damping;
    for (Index n = 0; n < model_->nodes(); n++) {
        if (kind_[n] != 0) continue;
        const Wrench w = internal_force(n);
        for (int k = 0; k < 6; k++) {
            const std::size_t at = velocity_record * n + std::size_t(k < 3 ? k : k + 1);
            const double im = inverse_mass_[at], v = velocity_[at];
            if (!(im > 0.0)) continue;
            const double f = k < 3 ? w.force[k] : w.moment[k - 3], g = k < 3 ? model_->settings.gravity[k] : 0.0;
            sum += 0.5 * v * ((v * (1.0 - a) + kick() * (im * f + g)) / (1.0 + a)) / im;
        }
    }
    for (const Driven& d : driven_) {
        const Kick k = kick_driven(d);
        for (int i = 0; i < 6; i++) {
            const double mass = i < 3 ? masses_.mass[d.node] : masses_.inertia[d.node];
            sum += 0.5 * mass * velocity_[velocity_record * d.node + std::size_t(i < 3 ? i : i + 1)] * k.velocity[i];
        }
    }
    for (std::size_t i = 0; i < bodies_.size(); i++) {
        RigidState after = body_states_[i];
        const Kick k = kick_body(i, after);
        sum += of_body(bodies_[i], body_states_[i], after, k.velocity);
    }
    if (contact_) sum += contact_->obstacles().kinetic(kick());
    return sum + kinetic_of_welds();
}

// work of loads and reactions over the last step that outside_work_ does not contain yet
double Simulation::work_to_come() const {
    double sum = 0.0;
    for (const Driven& d : driven_) {
        const Kick k = kick_driven(d);
        for (int i = 0; i < 6; i++)
            sum += 0.5 * last_dt_ * velocity_[velocity_record * d.node + std::size_t(i < 3 ? i : i + 1)] * (k.outside[i] + d.outside[i]);
    }
    for (std::size_t i = 0; i < bodies_.size(); i++) {
        RigidState s = body_states_[i];
        const Kick k = kick_body(i, s);
        const RigidState& old = body_states_[i];
        for (int c = 0; c < 6; c++)
            sum += 0.5 * last_dt_ * (c < 3 ? old.velocity[c] : old.omega[c - 3]) * (k.outside[c] + body_drives_[i].outside[c]);
    }
    return sum;
}

double Simulation::gravity_work() const {
    double sum = 0.0;
    const Vec3 g = model_->settings.gravity;
    for (std::size_t n = 0; n < model_->nodes(); n++)
        if (kind_[n] != 1)
            sum += masses_.mass[n] * dot(g, read3(&position_[position_record * n]) - read3(&model_->position[3 * n]));
    for (std::size_t i = 0; i < bodies_.size(); i++) {
        const RigidBody& b = bodies_[i];
        const RigidState& s = body_states_[i];
        sum += b.mass * dot(g, (s.centre + s.rotation * b.mass_arm) - (b.centre0 + b.mass_arm));
    }
    return sum;
}

Energies Simulation::energies() const {
    Energies e;
    e.kinetic = steps_ == 0 ? first_kinetic_ : kinetic();
    double internal = 0.0;
    for (std::size_t i = 0; i < model_->elements(); i++) {
        const double in = slot(i, internal_energy), plastic = slot(i, plastic_energy);
        internal += in;
        e.plastic += plastic;
        e.hourglass += slot(i, hourglass_energy);
        if (slot(i, alive) < 0.5) e.eroded += in - plastic;
    }
    e.elastic = internal - e.plastic;
    e.contact = contact_->work();
    e.damping = body_damping_;
    for (double d : damping_work_) e.damping += d;
    e.external = external_work();
    e.residual = e.kinetic + internal + e.hourglass + e.contact + e.damping - e.external - first_kinetic_;
    return e;
}

Wrench Simulation::cut(std::size_t i, Vec3* centre) const {
    const Cut& c = model_->cuts[i];
    std::vector<std::uint8_t> in(model_->nodes(), 0);
    Vec3 sum;
    for (Index n : c.nodes) {
        in[n] = 1;
        sum = sum + read3(&position_[position_record * n]);
    }
    *centre = (1.0 / double(c.nodes.size())) * sum;
    Wrench w;
    auto kept = blocks_.cut_corners[i].begin();
    for (Index e : c.elements)
        for (int k = 0; k < 4; k++) {
            const Index n = model_->quads[4 * e + std::size_t(k)];
            if (!in[n]) continue;
            const double* corner = &kept_[std::size_t(corner_record) * *kept++];
            const Vec3 f = -1.0 * read3(corner);
            w.force = w.force + f;
            w.moment = w.moment - read3(corner + 4) + cross(read3(&position_[position_record * n]) - *centre, f);
        }
    return w;
}

void Simulation::node_forces(double* out) const {
    for (Index n = 0; n < model_->nodes(); n++) {
        const Wrench w = internal_force(n);
        write3(out + 6 * n, -1.0 * w.force);
        write3(out + 6 * n + 3, -1.0 * w.moment);
    }
}

void Simulation::velocities(double* v, double* w) const {
    for (Index n = 0; n < model_->nodes(); n++) {
        Wrench a;
        if (kind_[n] == 0) a = internal_force(n);
        double* out[] = {v + 3 * n, w + 3 * n};
        for (int k = 0; k < 6; k++) {
            const std::size_t at = velocity_record * n + std::size_t(k < 3 ? k : k + 1);
            const double f = k < 3 ? a.force[k] : a.moment[k - 3], g = k < 3 ? model_->settings.gravity[k] : 0.0;
            const double acceleration = kind_[n] == 0 && inverse_mass_[at] > 0.0 ? inverse_mass_[at] * f + g : 0.0;
            out[k / 3][k % 3] = velocity_[at] + 0.5 * last_dt_ * acceleration;
        }
    }
}

Checkpoint Simulation::save() const {
    Checkpoint c;
    c.numbers = {time_, dt_, last_dt_, outside_work_, body_damping_, first_kinetic_, double(steps_), double(failed_element_), double(end_)};
    c.numbers.insert(c.numbers.end(), damping_work_.begin(), damping_work_.end());
    c.nodes.assign(position_.begin(), position_.end());
    c.nodes.insert(c.nodes.end(), velocity_.begin(), velocity_.end());
    c.elements.assign(state_.begin(), state_.end());
    c.sums.assign(sum_.begin(), sum_.end());
    c.sums.insert(c.sums.end(), kept_.begin(), kept_.end());
    for (const RigidState& s : body_states_) {
        for (Vec3 v : {s.centre, s.velocity, s.angular_momentum, s.omega}) c.bodies.insert(c.bodies.end(), {v.x, v.y, v.z});
        c.bodies.insert(c.bodies.end(), s.rotation.m, s.rotation.m + 9);
    }
    for (const Driven& d : driven_) c.drives.insert(c.drives.end(), d.outside, d.outside + 6);
    for (const BodyDrive& d : body_drives_) c.drives.insert(c.drives.end(), d.outside, d.outside + 6);
    welds_->save(c.bodies);
    c.contact = contact_->save();
    return c;
}

void Simulation::restore(const Checkpoint& c) {
    const Checkpoint own = save();
    auto same = [](const auto& a, const auto& b) { return a.size() == b.size(); };
    if (!same(c.numbers, own.numbers) || !same(c.nodes, own.nodes) || !same(c.elements, own.elements) || !same(c.sums, own.sums) ||
        !same(c.bodies, own.bodies) || !same(c.drives, own.drives))
        throw std::invalid_argument("the checkpoint belongs to another model or instruction set");
    Saved numbers(c.numbers);
    for (double* x : {&time_, &dt_, &last_dt_, &outside_work_, &body_damping_, &first_kinetic_}) *x = numbers.number();
    steps_ = std::int64_t(numbers.index(std::size_t(1) << 53));
    // -1: none
    failed_element_ = numbers.whole(-1, model_->elements() + 1);
    end_ = End(int(numbers.index(std::size_t(End::inverted) + 1)));
    numbers.copy(damping_work_);
    std::copy_n(c.nodes.begin(), position_.size(), position_.begin());
    std::copy_n(c.nodes.begin() + std::ptrdiff_t(position_.size()), velocity_.size(), velocity_.begin());
    std::copy_n(c.elements.begin(), state_.size(), state_.begin());
    std::copy_n(c.sums.begin(), sum_.size(), sum_.begin());
    std::copy_n(c.sums.begin() + std::ptrdiff_t(sum_.size()), kept_.size(), kept_.begin());
    Saved bodies(c.bodies);
    for (RigidState& s : body_states_) {
        for (Vec3* v : {&s.centre, &s.velocity, &s.angular_momentum, &s.omega}) *v = bodies.vector();
        for (double& x : s.rotation.m) x = bodies.number();
    }
    welds_->restore(bodies);
    sort_welds();
    Saved drives(c.drives);
    for (Driven& d : driven_)
        for (double& x : d.outside) x = drives.number();
    for (BodyDrive& d : body_drives_)
        for (double& x : d.outside) x = drives.number();
    contact_->restore(c.contact);
    update_alive();
}

}  // namespace crumple::shell
