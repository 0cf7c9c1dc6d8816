// Evaluations before a run: motion compatible with the joints, effective inertias at hinges, response to loads, displacements.
#include <algorithm>
#include <cmath>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

// Tolerance of the rates of held rows under a unit impulse, relative to the largest of them when all bodies are free.
constexpr double inertia_tolerance = 1e-12;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

void Stepper::add_motion(State& s, const Twist* velocity, const Twist* impulse) {
    p_.locate_all(s, s.pose, s.t, p_.rows, p_.error.data());
    p_.set_mobilities(s.pose);
    for (size_t i = 0; i < s.velocity.size(); i++) s.velocity[i] = s.velocity[i] + velocity[i] + p_.system.mobility(i, impulse[i]);
    p_.rates(p_.rows, s.velocity.data(), p_.x.data());
    for (size_t c = 0; c < p_.connections.size(); c++) {
        const Link& link = p_.system.links()[c];
        const int first = p_.start(c);
        for (int i = link.held; i < link.rows(); i++) p_.x[at(first + i)] = 0;
        const size_t index = at(p_.connections[c].index);
        if (!p_.is_joint(c) || !p_.model.joints[index].driven) continue;
        const Target driven = p_.target_of(p_.model.joints[index], s, s.t);
        const Pose a = p_.model.pose(s.pose, p_.model.joints[index].body[0]);
        for (int i = 0; i < link.held; i++) p_.x[at(first + i)] -= target_rate(p_.model.joints[index], a, p_.geometry[index], driven, i);
    }
    find_redundant(s.pose);
    p_.hold_rows();
    p_.system.solve(p_.x.data(), 0, s.velocity.data());
}

void Stepper::free_hinges(const State& s) {
    p_.locate_all(s, s.pose, s.t, p_.rows, p_.error.data());
    p_.set_mobilities(s.pose);
    find_redundant(s.pose);
    p_.hold_rows();
}

double Stepper::effective_inertia(size_t hinge, int component) {
    const size_t link = p_.hinge_link[hinge];
    const Link& l = p_.system.links()[link];
    const Row& row = p_.rows[at(p_.start(link) + l.held + component)];
    std::fill(direction_.begin(), direction_.end(), Twist{});
    if (l.body[0] >= 0) direction_[at(l.body[0])] = p_.system.mobility(at(l.body[0]), {-row.ma, -row.t});
    if (l.body[1] >= 0) direction_[at(l.body[1])] = p_.system.mobility(at(l.body[1]), {row.mb, row.t});
    p_.system.rates(direction_.data(), p_.x.data());
    double largest = 0;
    for (const double x : p_.x) largest = std::max(largest, std::fabs(x));
    p_.system.solve(p_.x.data(), inertia_tolerance * largest, direction_.data());
    const Twist a = p_.model.twist(direction_, l.body[0]), b = p_.model.twist(direction_, l.body[1]);
    return 1 / rate(row, a, b);
}

double Stepper::moved_by(const State& s, const std::vector<size_t>& loads) {
    p_.locate_all(s, s.pose, s.t, p_.rows, p_.error.data());
    p_.set_mobilities(s.pose);
    std::fill(momentum_.begin(), momentum_.end(), Twist{});
    for (const size_t k : loads) {
        const Load& load = p_.model.loads[k];
        const Vec3 arm = turned(s.pose[at(load.body)].q, load.arm);
        Twist& m = momentum_[at(load.body)];
        m = m + Twist{load.moment + cross(arm, load.force), load.force};
    }
    for (size_t i = 0; i < momentum_.size(); i++) direction_[i] = p_.system.mobility(i, momentum_[i]);
    p_.hold_rows();
    p_.system.rates(direction_.data(), p_.x.data());
    p_.system.solve(p_.x.data(), 0, direction_.data());
    double power = 0;
    for (size_t i = 0; i < momentum_.size(); i++) {
        power += dot(momentum_[i].w, direction_[i].w) + dot(momentum_[i].v, direction_[i].v);
    }
    return std::sqrt(std::max(power, 0.0));
}

double Stepper::relative(const State& s, int joint, int freedom) const {
    const Joint& j = p_.model.joints[at(joint)];
    const Pose a = p_.model.pose(s.pose, j.body[0]), b = p_.model.pose(s.pose, j.body[1]);
    const Quat first = a.q * j.axes, second = b.q * j.axes;
    if (freedom < 3) return turned(conjugate(first), b.at(j.arm[1]) - a.at(j.arm[0]))[freedom];
    return rotation_vector(conjugate(first) * second)[freedom - 3];
}

}  // namespace crumple::spatial
