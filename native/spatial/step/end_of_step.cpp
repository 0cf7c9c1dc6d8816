#include "spatial/step/end_of_step.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Limit of Newton iterations that project positions onto the held rows; the matrix is that of the end before projection.
constexpr int projection_limit = 4;
// Tolerance of the gap between held points as a share of the model's length.  The projection converges quadratically, so that most gaps
// that are above it after one iteration are at rounding after the second.
constexpr double gap_tolerance = 1e-12;
// Gap [model lengths or rad] after these iterations above which the projection has no solution.  If there is one, the gap converges to
// rounding; for a drive against something that cannot move it is the whole displacement of the drive, however short the step.
constexpr double unsolvable_gap = 1e-6;
// Tolerance of the rates of held rows at the end of a step, relative to the speed.
constexpr double projection_tolerance = 1e-12;
// Rates of held rows after the projection, relative to the speed, above which it has no solution if they were smaller before.  At the smallest
// steps of a chain of short elastic bars, rounding can leave nothing of the equations: velocities of 1e34 m/s were found.
constexpr double unsolvable_rate = 1e-6;
constexpr double tiny = 1e-300;  // [m/s]: rates of parts at rest can be among the smallest numbers, which have no digits

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

bool EndOfStep::commit(State& s, double h, bool search) {
    for (size_t i = 0; i < p_.end.size(); i++) {
        s.travel[i] = (h / 2) * (s.velocity[i] + p_.velocity[i]);
        p_.end[i] = moved(s.pose[i], s.travel[i]);
    }
    s.last_step = h;
    contact_.commit(s, h);
    work_on_links(s, h);
    if (!project_positions(s, h)) return false;
    turn_hinges(s);
    work_of_loads(s, h);
    show_forces(s, h);
    if (!s.contact.impact) follow_forces(s, h);
    for (size_t i = 0; i < p_.end.size(); i++) {
        s.acceleration[i] = p_.stage.quasi_static ? Twist{} : (1 / h) * (p_.velocity[i] - s.velocity[i]);
        s.velocity[i] = p_.stage.quasi_static ? Twist{} : p_.velocity[i];
    }
    s.pose = p_.end;
    s.t += h;
    contact_.see(s, h, search);
    double sum = s.external_work + s.contact.dissipated + s.contact.friction;
    for (size_t i = 0; i < s.pose.size(); i++) {
        sum += norm(s.pose[i].x) + s.pose[i].q.w + norm(s.velocity[i].v) + norm(s.velocity[i].w);
    }
    return std::isfinite(sum);
}

// work of drives and dampers, from the impulses and mean rates of the step
void EndOfStep::work_on_links(State& s, double h) {
    for (size_t c = 0; c < p_.connections.size(); c++) {
        const size_t index = at(p_.connections[c].index), first = at(p_.start(c));
        if (p_.is_contact(c)) continue;
        if (p_.is_spring(c)) {
            const Spring& spring = p_.model.springs[index];
            const double mean = (p_.rate0[first] + p_.w[first]) / 2, weight = p_.spring_weight[index];
            s.spring_damped += h * spring.damping * ((1 - weight) * p_.rate0[first] + weight * p_.w[first]) * mean;
        } else if (p_.model.joints[index].driven) {
            double work = 0;
            for (int i = 0; i < p_.model.joints[index].held; i++) {
                const size_t k = first + at(i);
                work -= p_.impulse[k] * (p_.rate0[k] + p_.target[k]) / 2;
            }
            s.work_on(drives_obstacle(index), work - stand_in_energy(index));
        }
    }
}

void EndOfStep::turn_hinges(State& s) {
    for (size_t j = 0; j < p_.model.hinges.size(); j++) {
        const Joint& joint = p_.model.joints[at(p_.model.hinge_joint[j])];
        const size_t k = at(p_.component[j]);
        const size_t row = at(p_.start(p_.hinge_link[j]) + joint.held);
        double turn[most_components];
        spatial::commit(p_.model.hinges[j], p_.frozen[j], s.hinge[j], s.t, &s.turned[k], &p_.w[row], turn);
        for (int i = 0; i < joint.laws; i++) {
            s.rotation[k + at(i)] = p_.error[row + at(i)];
            s.turned[k + at(i)] = joint.laws == 1 ? p_.error[row + at(i)] : s.turned[k + at(i)] + turn[i];
            // a quasi-static step begins from rest, so its end rate is twice the mean, which is the true one
            s.rate[k + at(i)] = (p_.stage.quasi_static ? 0.5 : 1) * p_.w[row + at(i)];
        }
    }
}

// Forces that change what a hinge carries, the tension and what shear forces leave of the torque, followed without vibration that is not
// resolved: with those of single steps, torques and shear forces would keep each other in vibration.
void EndOfStep::follow_forces(State& s, double h) {
    for (size_t j = 0; j < p_.model.hinges.size(); j++) {
        const Vec3 force = s.joint_force[at(p_.model.hinge_joint[j])].v;
        SpatialHingeState& hinge = s.hinge[j];
        // on the second body
        hinge.tension_aim = -force.x;
        hinge.tension += p_.followed(h) * (hinge.tension_aim - hinge.tension);
        hinge.most_pressed = std::max(hinge.most_pressed, -hinge.tension);
        hinge.most_pulled = std::max(hinge.most_pulled, hinge.tension);
        hinge.torque_aim = left_by_shear(p_.model.hinges[j], force.y, force.z);
        hinge.torque_left += p_.followed(h) * (hinge.torque_aim - hinge.torque_left);
    }
}

// Work of gravity and loads over the true displacement of their points, and the energy lost to drag in quasi-static stages.
void EndOfStep::work_of_loads(State& s, double h) {
    double on_structure = 0;
    for (size_t i = 0; i < p_.end.size(); i++) {
        const double work = p_.model.bodies[i].mass * dot(p_.model.gravity, p_.end[i].x - s.pose[i].x);
        s.work_on(p_.model.bodies[i].obstacle, work);
        if (!p_.model.bodies[i].obstacle) on_structure += work;
    }
    for (const Load& load : p_.model.loads) {
        const size_t i = at(load.body);
        const Vec3 way = p_.end[i].at(load.arm) - s.pose[i].at(load.arm);
        const Vec3 turn = (h / 2) * (s.velocity[i].w + p_.velocity[i].w);
        const double work = p_.factor_of(load, s, h) * (dot(load.force, way) + dot(load.moment, turn));
        s.work_on(false, work);
        on_structure += work;
    }
    if (!p_.stage.quasi_static) return;
    s.load_work += on_structure;
    for (size_t i = 0; i < p_.end.size(); i++) {
        if (!p_.model.bodies[i].obstacle) s.dragged += inertial_energy(i);
        if (!p_.model.bodies[i].stand_in) s.slowed += inertial_energy(i);
    }
}

// Projects positions and velocities onto the held rows at the end of the step: the closest ones in the kinetic-energy norm with the
// tangents of the laws kept, so that a locked hinge stays locked.  False if the held rows cannot be satisfied.
bool EndOfStep::project_positions(State& s, double h) {
    const std::vector<Link>& links = p_.system.links();
    bool any = false;
    p_.locate_all(s, p_.end, s.t + h, p_.rows, p_.error.data());
    for (size_t c = 0; c < links.size(); c++) any = any || links[c].held > 0 || contact_.overlap(c) < 0;
    if (!any) return true;
    p_.set_mobilities(p_.end);
    p_.assemble();
    p_.system.factor();
    for (int pass = 0; pass < projection_limit; pass++) {
        double worst = 0;
        for (size_t c = 0; c < links.size(); c++) {
            const size_t first = at(p_.start(c)), held = at(links[c].held);
            const double deep = contact_.overlap(c);
            for (size_t i = 0; i < at(links[c].rows()); i++) {
                p_.x[first + i] = i < held ? p_.error[first + i] : i == held ? deep : 0;
                worst = std::max(worst, i < held ? std::fabs(p_.error[first + i]) : -deep);
            }
        }
        if (worst <= gap_tolerance * p_.model.length) break;
        std::fill(direction_.begin(), direction_.end(), Twist{});
        p_.system.solve(p_.x.data(), 1e-3 * worst, direction_.data());
        for (size_t i = 0; i < p_.end.size(); i++) p_.end[i] = moved(p_.end[i], direction_[i]);
        p_.locate_all(s, p_.end, s.t + h, p_.rows, p_.error.data());
    }
    if (!meets()) return false;
    return p_.stage.quasi_static || project_rates(s, h);
}

// Whether the held rows are satisfied at the positions where they were last located.
bool EndOfStep::meets() const {
    for (size_t c = 0; c < p_.connections.size(); c++) {
        for (int i = 0; i < p_.system.links()[c].held; i++) {
            const size_t k = at(p_.start(c) + i);
            const bool turns = dot(p_.rows[k].t, p_.rows[k].t) == 0;
            if (!(std::fabs(p_.error[k]) <= unsolvable_gap * (turns ? 1 : p_.model.length))) return false;
        }
    }
    return true;
}

// The impulses of the projection are part of the step: those of drives do work, because their rates are not zero.  False if the held rows
// cannot be satisfied.
bool EndOfStep::project_rates(State& s, double h) {
    const std::vector<Link>& links = p_.system.links();
    p_.rates(p_.rows, p_.velocity.data(), p_.x.data());
    for (size_t c = 0; c < links.size(); c++) {
        const int first = p_.start(c);
        for (int i = links[c].held; i < links[c].rows(); i++) p_.x[at(first + i)] = 0;
        if (!p_.is_joint(c) || !p_.model.joints[at(p_.connections[c].index)].driven) continue;
        const size_t index = at(p_.connections[c].index);
        const Joint& joint = p_.model.joints[index];
        const Target driven = p_.target_of(joint, s, s.t + h);
        const Pose a = p_.model.pose(p_.end, joint.body[0]);
        for (int i = 0; i < joint.held; i++) {
            p_.target[at(first + i)] = target_rate(joint, a, p_.geometry[index], driven, i);
            p_.x[at(first + i)] -= p_.target[at(first + i)];
        }
    }
    work_ = p_.x;
    left_.resize(work_.size());
    const double allowed = std::max(largest_held(work_), unsolvable_rate * largest_speed()) + tiny;
    p_.system.solve(p_.x.data(), projection_tolerance * p_.speed, p_.velocity.data());
    p_.rates(p_.rows, p_.velocity.data(), left_.data());
    for (size_t k = 0; k < left_.size(); k++) left_[k] -= p_.target[k];
    if (!(largest_held(left_) <= allowed)) return false;
    contact_.push_obstacles(s, h);
    for (size_t c = 0; c < links.size(); c++) {
        const bool driven = p_.is_joint(c) && p_.model.joints[at(p_.connections[c].index)].driven;
        for (int i = 0; i < links[c].held; i++) {
            const size_t k = at(p_.start(c) + i);
            p_.impulse[k] += p_.x[k];
            if (driven) s.work_on(drives_obstacle(at(p_.connections[c].index)), -p_.x[k] * (p_.target[k] + work_[k] / 2));
        }
    }
    return true;
}

// largest of these rates of held rows
double EndOfStep::largest_held(const std::vector<double>& rate) const {
    double largest = 0;
    for (size_t c = 0; c < p_.connections.size(); c++) {
        for (int i = 0; i < p_.system.links()[c].held; i++) largest = std::max(largest, std::fabs(rate[at(p_.start(c) + i)]));
    }
    return largest;
}

// largest speed at the start or the end of the step [m/s]
double EndOfStep::largest_speed() const {
    double speed = p_.speed;
    for (const Twist& v : p_.velocity) speed = std::max({speed, norm(v.v), norm(v.w) * p_.model.length});
    return speed;
}

bool EndOfStep::drives_obstacle(size_t joint) const {
    const int body = p_.model.joints[joint].body[1];
    return body >= 0 && p_.model.bodies[at(body)].obstacle;
}

// Energy that a body loses to drag in a quasi-static step: the kinetic energy of the step's inertia at its end.
double EndOfStep::inertial_energy(size_t body) const {
    const Body& b = p_.model.bodies[body];
    const Vec3 w = p_.velocity[body].w;
    return p_.inertia_share() * (b.mass * dot(p_.velocity[body].v, p_.velocity[body].v) + dot(w, p_.inertia[body] * w)) / 2;
}

// Work of a drive in a quasi-static step on the placeholder inertia of an obstacle, which is not counted as energy.
double EndOfStep::stand_in_energy(size_t joint) const {
    return p_.stage.quasi_static && drives_obstacle(joint) ? inertial_energy(at(p_.model.joints[joint].body[1])) : 0;
}

// forces of the joints on their second bodies, mean over the step
void EndOfStep::show_forces(State& s, double h) {
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!p_.is_joint(c)) continue;
        const size_t index = at(p_.connections[c].index);
        const Joint& joint = p_.model.joints[index];
        double f[6] = {};
        for (int i = 0; i < joint.rows(); i++) f[joint.freedom[i]] = -p_.impulse[at(p_.start(c) + i)] / h;
        s.joint_force[index] = {{f[3], f[4], f[5]}, {f[0], f[1], f[2]}};
    }
}

}  // namespace crumple::spatial
