// Evaluations before a run: motion compatible with the joints, effective inertias at hinges, response to loads, displacements.
#include <algorithm>
#include <cmath>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

void Stepper::add_motion(State& s, const Twist* velocity, const Twist* impulse) {
    locate_all(s, s.pose, s.t, rows_, error_.data());
    set_mobilities(s.pose);
    for (size_t i = 0; i < s.velocity.size(); i++) s.velocity[i] = s.velocity[i] + velocity[i] + system_.mobility(i, impulse[i]);
    rates(rows_, s.velocity.data(), x_.data());
    for (size_t c = 0; c < connections_.size(); c++) {
        const Link& link = system_.links()[c];
        const int first = start(c);
        for (int i = link.held; i < link.rows(); i++) x_[at(first + i)] = 0;
        const size_t index = at(connections_[c].index);
        if (!is(c, Kind::joint) || !model_.joints[index].driven) continue;
        const Target driven = target(model_.joints[index], s, s.t);
        const Pose a = model_.pose(s.pose, model_.joints[index].body[0]);
        for (int i = 0; i < link.held; i++) x_[at(first + i)] -= target_rate(model_.joints[index], a, geometry_[index], driven, i);
    }
    find_redundant(s.pose);
    hold_rows();
    system_.factor();
    system_.solve(x_.data(), 0);
    system_.push(x_.data(), s.velocity.data());
}

double Stepper::effective_inertia(const State& s, size_t hinge, int component) {
    locate_all(s, s.pose, s.t, rows_, error_.data());
    set_mobilities(s.pose);
    const size_t link = hinge_link_[hinge];
    const Link& l = system_.links()[link];
    const Row& row = rows_[at(start(link) + l.held + component)];
    std::fill(direction_.begin(), direction_.end(), Twist{});
    if (l.body[0] >= 0) direction_[at(l.body[0])] = system_.mobility(at(l.body[0]), {-row.ma, -row.t});
    if (l.body[1] >= 0) direction_[at(l.body[1])] = system_.mobility(at(l.body[1]), {row.mb, row.t});
    find_redundant(s.pose);
    hold_rows();
    system_.factor();
    system_.rates(direction_.data(), x_.data());
    system_.solve(x_.data(), 0);
    system_.push(x_.data(), direction_.data());
    const Twist a = model_.twist(direction_, l.body[0]), b = model_.twist(direction_, l.body[1]);
    return 1 / rate(row, a, b);
}

double Stepper::moved_by(const State& s, const std::vector<size_t>& loads) {
    locate_all(s, s.pose, s.t, rows_, error_.data());
    set_mobilities(s.pose);
    std::fill(momentum_.begin(), momentum_.end(), Twist{});
    for (const size_t k : loads) {
        const Load& load = model_.loads[k];
        const Vec3 arm = turned(s.pose[at(load.body)].q, load.arm);
        Twist& m = momentum_[at(load.body)];
        m = m + Twist{load.moment + cross(arm, load.force), load.force};
    }
    for (size_t i = 0; i < momentum_.size(); i++) direction_[i] = system_.mobility(i, momentum_[i]);
    hold_rows();
    system_.factor();
    system_.rates(direction_.data(), x_.data());
    system_.solve(x_.data(), 0);
    system_.push(x_.data(), direction_.data());
    double power = 0;
    for (size_t i = 0; i < momentum_.size(); i++) {
        power += dot(momentum_[i].w, direction_[i].w) + dot(momentum_[i].v, direction_[i].v);
    }
    return std::sqrt(std::max(power, 0.0));
}

double Stepper::relative(const State& s, int joint, int freedom) const {
    const Joint& j = model_.joints[at(joint)];
    const Pose a = model_.pose(s.pose, j.body[0]), b = model_.pose(s.pose, j.body[1]);
    const Quat first = a.q * j.axes, second = b.q * j.axes;
    if (freedom < 3) return turned(conjugate(first), b.at(j.arm[1]) - a.at(j.arm[0]))[freedom];
    return rotation_vector(conjugate(first) * second)[freedom - 3];
}

}  // namespace crumple::spatial
