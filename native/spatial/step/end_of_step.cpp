// The end of a step: positions, states of the laws, and energies.
#include <algorithm>
#include <cmath>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

// Limit of Newton iterations that project positions onto the held rows; the matrix is that of the end before projection.
constexpr int projection_limit = 4;
// Tolerance of the gap between held points as a share of the model's length: rounding.
constexpr double gap_tolerance = 1e-14;
// Gap [model lengths or rad] after these iterations above which the projection has no solution.  If there is one, the gap converges to
// rounding; for a drive against something that cannot move it is the whole displacement of the drive, however short the step.
constexpr double unsolvable_gap = 1e-6;
// Tolerance of the rates of held rows at the end of a step, relative to the speed.
constexpr double projection_tolerance = 1e-12;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

Energies energies(const Model& model, const State& s) {
    Energies e;
    for (size_t i = 0; i < model.bodies.size(); i++) {
        const Body& b = model.bodies[i];
        const Twist& v = s.velocity[i];
        const Vec3 w = turned(conjugate(s.pose[i].q), v.w);
        const double kinetic = (b.mass * dot(v.v, v.v) + dot(w, b.inertia * w)) / 2;
        e.kinetic += kinetic;
        if (b.obstacle) e.obstacle_kinetic += kinetic;
    }
    size_t first = 0;
    for (size_t j = 0; j < model.hinges.size(); j++) {
        const SpatialHinge& hinge = model.hinges[j];
        e.elastic += elastic_energy(hinge, s.hinge[j]);
        e.dissipated += dissipated(hinge, s.hinge[j]);
        e.damped += damped(hinge, s.hinge[j]);
        e.stop += stop_energy(hinge, &s.turned[first]) + stop_dissipated(hinge, s.hinge[j]);
        first += at(size(hinge));
    }
    for (const Spring& spring : model.springs) {
        const Pose a = model.pose(s.pose, spring.body[0]), b = model.pose(s.pose, spring.body[1]);
        const double stretch = norm(b.at(spring.arm[1]) - a.at(spring.arm[0])) - spring.length;
        e.spring += spring.stiffness * stretch * stretch / 2;
    }
    e.damped += s.spring_damped;
    e.contact = s.contact.dissipated;
    e.friction = s.contact.friction;
    e.external_work = s.external_work;
    e.obstacle_work = s.obstacle_work;
    e.slowed = s.slowed;
    return e;
}

// False if the held rows cannot be satisfied, or a value is not finite.
bool Stepper::commit(State& s, double h) {
    for (size_t i = 0; i < end_.size(); i++) {
        s.travel[i] = (h / 2) * (s.velocity[i] + velocity_[i]);
        end_[i] = moved(s.pose[i], s.travel[i]);
    }
    s.last_step = h;
    commit_contacts(s, h);
    work_on_links(s, h);
    if (!project_positions(s, h)) return false;
    turn_hinges(s);
    work_of_loads(s, h);
    show_forces(s, h);
    for (size_t i = 0; i < end_.size(); i++) {
        s.acceleration[i] = stage_.quasi_static ? Twist{} : (1 / h) * (velocity_[i] - s.velocity[i]);
        s.velocity[i] = stage_.quasi_static ? Twist{} : velocity_[i];
    }
    s.pose = end_;
    s.t += h;
    see_contacts(s, h);
    double sum = s.external_work + s.contact.dissipated + s.contact.friction;
    for (size_t i = 0; i < s.pose.size(); i++) {
        sum += norm(s.pose[i].x) + s.pose[i].q.w + norm(s.velocity[i].v) + norm(s.velocity[i].w);
    }
    return std::isfinite(sum);
}

// work of drives and dampers, from the impulses and mean rates of the step
void Stepper::work_on_links(State& s, double h) {
    for (size_t c = 0; c < connections_.size(); c++) {
        const size_t index = at(connections_[c].index), first = at(start(c));
        if (is(c, Kind::contact)) continue;
        if (is(c, Kind::spring)) {
            const Spring& spring = model_.springs[index];
            const double mean = (rate0_[first] + w_[first]) / 2, weight = spring_weight_[index];
            s.spring_damped += h * spring.damping * ((1 - weight) * rate0_[first] + weight * w_[first]) * mean;
        } else if (model_.joints[index].driven) {
            double work = 0;
            for (int i = 0; i < model_.joints[index].held; i++) {
                const size_t k = first + at(i);
                work -= impulse_[k] * (rate0_[k] + target_[k]) / 2;
            }
            s.work_on(drives_obstacle(index), work - stand_in_energy(index));
        }
    }
}

void Stepper::turn_hinges(State& s) {
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        const Joint& joint = model_.joints[at(model_.hinge_joint[j])];
        const size_t k = at(component_[j]);
        const size_t row = at(start(hinge_link_[j]) + joint.held);
        double turn[most_components];
        spatial::commit(model_.hinges[j], frozen_[j], s.hinge[j], s.t, &s.turned[k], &w_[row], turn);
        for (int i = 0; i < joint.laws; i++) {
            s.rotation[k + at(i)] = error_[row + at(i)];
            s.turned[k + at(i)] = joint.laws == 1 ? error_[row + at(i)] : s.turned[k + at(i)] + turn[i];
            // a quasi-static step begins from rest, so its end rate is twice the mean, which is the true one
            s.rate[k + at(i)] = (stage_.quasi_static ? 0.5 : 1) * w_[row + at(i)];
        }
    }
}

// Work of gravity and loads over the true displacement of their points, and the energy lost to drag in quasi-static stages.
void Stepper::work_of_loads(State& s, double h) {
    double on_structure = 0;
    for (size_t i = 0; i < end_.size(); i++) {
        const double work = model_.bodies[i].mass * dot(model_.gravity, end_[i].x - s.pose[i].x);
        s.work_on(model_.bodies[i].obstacle, work);
        if (!model_.bodies[i].obstacle) on_structure += work;
    }
    for (const Load& load : model_.loads) {
        const size_t i = at(load.body);
        const Vec3 way = end_[i].at(load.arm) - s.pose[i].at(load.arm);
        const Vec3 turn = (h / 2) * (s.velocity[i].w + velocity_[i].w);
        const double work = load.value.mean(s.t - s.stage_start, h) * (dot(load.force, way) + dot(load.moment, turn));
        s.work_on(false, work);
        on_structure += work;
    }
    if (!stage_.quasi_static) return;
    s.load_work += on_structure;
    for (size_t i = 0; i < end_.size(); i++) {
        if (!model_.bodies[i].obstacle) s.dragged += inertial_energy(i);
        if (!model_.bodies[i].stand_in) s.slowed += inertial_energy(i);
    }
}

// Projects positions and velocities onto the held rows at the end of the step: the closest ones in the kinetic-energy norm with the
// tangents of the laws kept, so that a locked hinge stays locked.  False if the held rows cannot be satisfied.
bool Stepper::project_positions(State& s, double h) {
    const std::vector<Link>& links = system_.links();
    bool any = false;
    locate_all(s, end_, s.t + h, rows_, error_.data());
    for (size_t c = 0; c < links.size(); c++) any = any || links[c].held > 0 || overlap(c) < 0;
    if (!any) return true;
    set_mobilities(end_);
    auto set_rows = [&] {
        for (size_t c = 0; c < links.size(); c++) {
            const int first = start(c), held = links[c].held, n = links[c].laws;
            for (int i = 0; i < held; i++) system_.row(first + i) = rows_[at(first + i)];
            for (int k = 0; k < n; k++) {
                Row sum;
                for (int j = 0; j < n; j++) {
                    const Row& row = rows_[at(first + held + j)];
                    const double f = tangent_[c].value[k] * tangent_[c].vectors[j * n + k];
                    sum = {sum.t + f * row.t, sum.ma + f * row.ma, sum.mb + f * row.mb};
                }
                system_.row(first + held + k) = sum;
            }
        }
    };
    set_rows();
    system_.factor();
    for (int pass = 0; pass < projection_limit; pass++) {
        double worst = 0;
        for (size_t c = 0; c < links.size(); c++) {
            const size_t first = at(start(c)), held = at(links[c].held);
            const double deep = overlap(c);
            for (size_t i = 0; i < at(links[c].rows()); i++) {
                x_[first + i] = i < held ? error_[first + i] : tangent_[c].value[i - held] * tangent_[c].vectors[i - held] * deep;
                worst = std::max(worst, i < held ? std::fabs(error_[first + i]) : -deep);
            }
        }
        if (worst <= gap_tolerance * model_.length) break;
        system_.solve(x_.data(), 1e-3 * worst);
        std::fill(direction_.begin(), direction_.end(), Twist{});
        system_.push(x_.data(), direction_.data());
        for (size_t i = 0; i < end_.size(); i++) end_[i] = moved(end_[i], direction_[i]);
        locate_all(s, end_, s.t + h, rows_, error_.data());
    }
    if (!meets()) return false;
    if (!stage_.quasi_static) project_rates(s, h);
    return true;
}

// Whether the held rows are satisfied at the positions where they were last located.
bool Stepper::meets() const {
    for (size_t c = 0; c < connections_.size(); c++) {
        for (int i = 0; i < system_.links()[c].held; i++) {
            const size_t k = at(start(c) + i);
            const bool turns = dot(rows_[k].t, rows_[k].t) == 0;
            if (!(std::fabs(error_[k]) <= unsolvable_gap * (turns ? 1 : model_.length))) return false;
        }
    }
    return true;
}

// The impulses of the projection are part of the step: those of drives do work, because their rates are not zero.
void Stepper::project_rates(State& s, double h) {
    const std::vector<Link>& links = system_.links();
    rates(rows_, velocity_.data(), x_.data());
    for (size_t c = 0; c < links.size(); c++) {
        const int first = start(c);
        for (int i = links[c].held; i < links[c].rows(); i++) x_[at(first + i)] = 0;
        if (!is(c, Kind::joint) || !model_.joints[at(connections_[c].index)].driven) continue;
        const size_t index = at(connections_[c].index);
        const Joint& joint = model_.joints[index];
        const Target driven = target(joint, s, s.t + h);
        const Pose a = model_.pose(end_, joint.body[0]);
        for (int i = 0; i < joint.held; i++) {
            target_[at(first + i)] = target_rate(joint, a, geometry_[index], driven, i);
            x_[at(first + i)] -= target_[at(first + i)];
        }
    }
    work_ = x_;
    system_.solve(x_.data(), projection_tolerance * speed_);
    system_.push(x_.data(), velocity_.data());
    push_obstacles(s, h);
    for (size_t c = 0; c < links.size(); c++) {
        const bool driven = is(c, Kind::joint) && model_.joints[at(connections_[c].index)].driven;
        for (int i = 0; i < links[c].held; i++) {
            const size_t k = at(start(c) + i);
            impulse_[k] += x_[k];
            if (driven) s.work_on(drives_obstacle(at(connections_[c].index)), -x_[k] * (target_[k] + work_[k] / 2));
        }
    }
}

bool Stepper::drives_obstacle(size_t joint) const {
    const int body = model_.joints[joint].body[1];
    return body >= 0 && model_.bodies[at(body)].obstacle;
}

// Energy that a body loses to drag in a quasi-static step: the kinetic energy of the step's inertia at its end.
double Stepper::inertial_energy(size_t body) const {
    const Body& b = model_.bodies[body];
    const Vec3 w = velocity_[body].w;
    return inertia() * (b.mass * dot(velocity_[body].v, velocity_[body].v) + dot(w, inertia_[body] * w)) / 2;
}

// Work of a drive in a quasi-static step on the placeholder inertia of an obstacle, which is not counted as energy.
double Stepper::stand_in_energy(size_t joint) const {
    return stage_.quasi_static && drives_obstacle(joint) ? inertial_energy(at(model_.joints[joint].body[1])) : 0;
}

// forces of the joints on their second bodies, mean over the step
void Stepper::show_forces(State& s, double h) {
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!is(c, Kind::joint)) continue;
        const size_t index = at(connections_[c].index);
        const Joint& joint = model_.joints[index];
        double f[6] = {};
        for (int i = 0; i < joint.rows(); i++) f[joint.freedom[i]] = -impulse_[at(start(c) + i)] / h;
        s.joint_force[index] = {{f[3], f[4], f[5]}, {f[0], f[1], f[2]}};
    }
}

}  // namespace crumple::spatial
