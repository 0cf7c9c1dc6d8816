// Nodes with loads or prescribed velocities, and rigid sets; there are few of them, so they are handled one by one.
#include <algorithm>

#include "shell/run/simulation.hpp"

namespace crumple::shell {

Wrench Simulation::internal_force(Index n) const {
    Wrench w;
    for (std::uint32_t j = blocks_.first[n]; j < blocks_.first[n + 1]; j++) {
        const double* sum = &sum_[std::size_t(corner_record) * blocks_.sum_of[j]];
        w.force = w.force - read3(sum);
        w.moment = w.moment - read3(sum + 4);
    }
    if (contact_ && contact_->any()) w.force = w.force + read3(contact_->force() + 4 * n);
    return w;
}

Vec3 Simulation::load(const std::vector<std::size_t>& loads, bool moment, double t) const {
    double sum[3] = {0.0, 0.0, 0.0};
    for (std::size_t i : loads) {
        const Load& l = model_->loads[i];
        if ((l.dof >= 3) == moment) sum[l.dof % 3] += l.value.at(t);
    }
    return {sum[0], sum[1], sum[2]};
}

// New velocities of a driven node, and the external force (load and reaction) that causes them.
Simulation::Kick Simulation::kick_driven(const Driven& d) const {
    Kick out{};
    const Wrench inside = internal_force(d.node);
    const Vec3 force = load(d.loads, false, time_), moment = load(d.loads, true, time_);
    double wanted[6] = {0, 0, 0, 0, 0, 0};
    for (std::size_t i : d.motions) wanted[model_->motions[i].dof] = model_->motions[i].velocity.at(time_ + 0.5 * dt_);
    const double a = 0.5 * kick() * model_->settings.damping;
    for (int k = 0; k < 6; k++) {
        const std::size_t at = velocity_record * d.node + std::size_t(k < 3 ? k : k + 1);
        const double im = inverse_mass_[at], old = velocity_[at];
        const double in = k < 3 ? inside.force[k] : inside.moment[k - 3], on = k < 3 ? force[k] : moment[k - 3];
        const double g = k < 3 ? model_->settings.gravity[k] : 0.0;
        out.outside[k] = on;
        if (d.held & (1u << k)) {
            out.velocity[k] = wanted[k];
            const double mass = k < 3 ? masses_.mass[d.node] : masses_.inertia[d.node];
            out.outside[k] = mass * ((wanted[k] - old) / kick() - g) - in;
        } else if (im > 0.0) {
            out.velocity[k] = (old * (1.0 - a) + kick() * (im * (in + on) + g)) / (1.0 + a);
        }
    }
    return out;
}

void Simulation::move_driven() {
    for (Driven& d : driven_) {
        const Kick k = kick_driven(d);
        for (std::size_t i = 0; i < 6; i++) {
            double& v = velocity_[velocity_record * d.node + (i < 3 ? i : i + 1)];
            // work over the last step, by the mean of the forces at its start and end
            outside_work_ += 0.5 * last_dt_ * v * (k.outside[i] + d.outside[i]);
            const double im = inverse_mass_[velocity_record * d.node + (i < 3 ? i : i + 1)], mean = 0.5 * (v + k.velocity[i]);
            if (!(d.held & (1u << i)) && im > 0.0) body_damping_ += model_->settings.damping * kick() * mean * mean / im;
            v = k.velocity[i];
            d.outside[i] = k.outside[i];
        }
        double* x = &position_[position_record * d.node];
        write3(x, read3(x) + dt_ * read3(&velocity_[velocity_record * d.node]));
    }
}

// Updates the velocities in a copy of a rigid set's state; held components take their prescribed values.
Simulation::Kick Simulation::kick_body(std::size_t i, RigidState& s) const {
    const RigidBody& b = bodies_[i];
    const BodyDrive& drive = body_drives_[i];
    Vec3 force, moment, out_force, out_moment;
    for (std::size_t k = 0; k < b.nodes.size(); k++) {
        const Wrench w = internal_force(b.nodes[k]);
        force = force + w.force;
        moment = moment + w.moment + cross(s.rotation * b.arm[k], w.force);
    }
    for (std::size_t l : drive.loads) {
        const Load& a = model_->loads[l];
        const Vec3 one{a.dof % 3 == 0 ? 1.0 : 0.0, a.dof % 3 == 1 ? 1.0 : 0.0, a.dof % 3 == 2 ? 1.0 : 0.0}, f = a.value.at(time_) * one;
        out_moment = out_moment + (a.dof >= 3 ? f : cross(read3(&position_[position_record * a.node]) - s.centre, f));
        if (a.dof < 3) out_force = out_force + f;
    }
    // moment of the weight about the centre, if that is not the centre of mass
    moment = moment + b.mass * cross(s.rotation * b.mass_arm, model_->settings.gravity);
    Kick out{};
    double wanted[6] = {0, 0, 0, 0, 0, 0};
    for (std::size_t m : drive.motions) wanted[model_->motions[m].dof] = model_->motions[m].velocity.at(time_ + 0.5 * dt_);
    const double a = 0.5 * kick() * model_->settings.damping, h = kick();
    double v[3], L[3];
    for (int k = 0; k < 3; k++) {
        const double g = model_->settings.gravity[k];
        v[k] = (s.velocity[k] * (1.0 - a) + h * ((force[k] + out_force[k]) / b.mass + g)) / (1.0 + a);
        L[k] = (s.angular_momentum[k] * (1.0 - a) + h * (moment[k] + out_moment[k])) / (1.0 + a);
        out.outside[k] = out_force[k];
        out.outside[k + 3] = out_moment[k];
        if (b.held & (1u << k)) {
            v[k] = wanted[k];
            out.outside[k] = b.mass * ((v[k] - s.velocity[k]) / h - g) - force[k];
        }
    }
    s.velocity = {v[0], v[1], v[2]};
    const Vec3 before = s.angular_momentum;
    s.angular_momentum = {L[0], L[1], L[2]};
    const Vec3 w = omega_of(b, s.rotation, s.angular_momentum, {wanted[3], wanted[4], wanted[5]}), held = world_inertia(b, s.rotation) * w;
    for (int k = 0; k < 3; k++) {
        if (b.held & (8u << k)) out.outside[k + 3] = (held[k] - before[k]) / h - moment[k];
        out.velocity[k] = v[k];
        out.velocity[k + 3] = w[k];
    }
    return out;
}

double Simulation::way_of_others() const {
    double farthest = 0.0;
    if (!contact_->seen()) return farthest;
    auto look = [&](Index n) {
        const Vec3 way = read3(&position_[position_record * n]) - read3(contact_->seen() + position_record * n);
        farthest = std::max(farthest, dot(way, way));
    };
    for (const Driven& d : driven_) look(d.node);
    for (Index n : welds_->nodes())
        if (kind_[n] == tied_node) look(n);
    for (const RigidBody& body : bodies_)
        for (Index n : body.nodes) look(n);
    return farthest;
}

void Simulation::move_bodies() {
    const double damping = model_->settings.damping;
    for (std::size_t i = 0; i < bodies_.size(); i++) {
        RigidState& s = body_states_[i];
        BodyDrive& drive = body_drives_[i];
        const RigidState old = s;
        const Kick k = kick_body(i, s);
        for (int c = 0; c < 6; c++) {
            outside_work_ += 0.5 * last_dt_ * (c < 3 ? old.velocity[c] : old.omega[c - 3]) * (k.outside[c] + drive.outside[c]);
            drive.outside[c] = k.outside[c];
        }
        if (damping > 0.0) {
            // held and driven components are not damped: their velocity is prescribed
            const Vec3 v = 0.5 * (old.velocity + s.velocity), L = 0.5 * (old.angular_momentum + s.angular_momentum);
            const Vec3 w = 0.5 * (old.omega + read3(k.velocity + 3));
            for (int c = 0; c < 3; c++) {
                if (!(bodies_[i].held & (1u << c))) body_damping_ += damping * kick() * bodies_[i].mass * v[c] * v[c];
                if (!(bodies_[i].held & (8u << c))) body_damping_ += damping * kick() * L[c] * w[c];
            }
        }
        const Vec3 wanted{k.velocity[3], k.velocity[4], k.velocity[5]};
        drift(bodies_[i], s, dt_, wanted);
        // members: positions from the rotation, velocities from the positions, so that the elements have exact rigid motion
        for (std::size_t n = 0; n < bodies_[i].nodes.size(); n++) {
            const Index node = bodies_[i].nodes[n];
            double* x = &position_[position_record * node];
            const Vec3 now = s.centre + s.rotation * bodies_[i].arm[n];
            write3(&velocity_[velocity_record * node], (1.0 / dt_) * (now - read3(x)));
            write3(&velocity_[velocity_record * node + 4], s.omega);
            write3(x, now);
        }
    }
}

}  // namespace crumple::shell
