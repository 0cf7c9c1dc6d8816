#include "planar/stepper.hpp"

#include "common/pause.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// Rotation [rad] over which the drift of a constraint decays to 1/e: small compared with any rotation of interest.
constexpr double correction_turn = 0.02;
// A hinge of a loop counts as at rest below this share of its start rate: the correction of the loop's gap keeps it turning slowly.
constexpr double at_rest = 1e-3;
// Relative difference of two rates that is attributed to rounding.
constexpr double same_rate = 1e-9;

}  // namespace

Energies energies(const Model& model, const State& s) {
    Energies e;
    for (int i = 0; i < model.tree.bodies(); i++) {
        const Body& b = model.tree[i];
        const Twist& v = s.velocity[static_cast<size_t>(i)];
        e.kinetic += (b.mass * dot(v.v, v.v) + b.inertia * v.w * v.w) / 2;
    }
    for (size_t j = 0; j < model.hinges.size(); j++) {
        const Hinge& hinge = model.hinges[j];
        const HingeState& state = s.hinge[j];
        e.elastic += elastic_energy(hinge, state);
        e.dissipated += state.dissipated;
        e.damped += state.damped;
        e.stop += stop_energy(hinge, s.q[static_cast<size_t>(hinge.dof)]) + state.stop_dissipated;
    }
    e.external_work = s.external_work;
    return e;
}

Stepper::Stepper(const Model& model) : model_(model), solver_(model.tree) {
    const auto n = static_cast<size_t>(model.tree.bodies()), m = static_cast<size_t>(model.tree.dofs());
    frozen_.resize(model.hinges.size());
    for (const Hinge& hinge : model.hinges) {
        all_set_valued_ = all_set_valued_ && hinge.form == Form::set_valued;
        elastic_ = elastic_ || hinge.form == Form::elastic_plastic;
    }
    hint_.assign(2 * model.hinges.size(), 0);
    for (auto* v : {&w_, &next_, &direction_, &rhs_, &impedance_, &dq_, &column_, &overload_, &overload_of_children_}) v->assign(m, 0.0);
    for (auto* v : {&middle_, &end_}) v->resize(n);
    for (auto* v : {&twist_, &end_twist_, &bias_, &work_}) v->resize(n);
    model.tree.place(model.q0.data(), middle_.data());
    for (const Drive& d : model.drives) add_row({d.body, -1, d.point, {}, d.direction, 0});
    for (const Hold& hold : model.holds) add_row({hold.body, -1, hold.point, {}, hold.direction, 0});
    for (const Weld& weld : model.welds) {
        for (const Twist& direction : {Twist{1, {}}, Twist{0, {1, 0}}, Twist{0, {0, 1}}}) {
            add_row({weld.body, weld.other, weld.point, weld.other_point, direction, 0});
        }
    }
    find_loops();
    const size_t d = rows_.size();
    zero_.assign(m, 0.0);
    row_target_.resize(d);
    row_force_.resize(d);
    row_rates_.resize(d * m);
    row_matrix_.resize(d * d);
}

State Stepper::start(const Real* q, const Real* w) const {
    State s;
    const auto m = static_cast<size_t>(model_.tree.dofs()), n = static_cast<size_t>(model_.tree.bodies());
    s.q.assign(q, q + m);
    s.w.assign(w, w + m);
    s.pose.resize(n);
    s.velocity.resize(n);
    s.hinge.resize(model_.hinges.size());
    s.drive_impulse.assign(model_.drives.size(), 0.0);
    model_.tree.place(q, s.pose.data());
    model_.tree.twists(s.pose.data(), w, s.velocity.data());
    model_.tree.to_centres(s.pose.data(), s.velocity.data());
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        int hint = 0;
        s.hinge[j].capacity = model_.hinges[j].scale * model_.hinges[j].positive.at(0, hint);
    }
    return s;
}

void Stepper::project(const State& at, const Twist* velocity, const Twist* impulse, Real* w) {
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const Body& b = model_.tree[i];
        const Vec2 c = at.pose[static_cast<size_t>(i)].turned(b.centre);
        const Vec2 linear = b.mass * velocity[i].v + impulse[i].v;
        work_[static_cast<size_t>(i)] = {b.inertia * velocity[i].w + impulse[i].w + cross(c, linear), linear};
    }
    solver_.place(at.pose.data());
    solver_.solve(impedance_.data(), work_.data(), rhs_.data(), w);
    // drives act from the first step on
    keep_joined(at, w, model_.drives.size());
}

// Projects w onto the rates that keep the rows from `first` on: that move no held point and open no weld.
void Stepper::keep_joined(const State& at, Real* w, size_t first) {
    if (rows_.size() == first) return;
    middle_ = at.pose;
    std::fill(row_target_.begin(), row_target_.end(), 0.0);
    constrain(w, first);
}

void Stepper::filter(const State& at, Real* rates, Real* turns) {
    constexpr double pi = 3.14159265358979323846;
    // rigid springs, for any frequency
    constexpr double largest_scale = 1e12;
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    for (size_t j = 0; j < frozen_.size(); j++) {
        // elastic laws have the tangent h^2 K/4 for the end rates of a step
        const double scale = std::min(2 / (2 * pi * model_.resolved_frequency * frozen_[j].h), largest_scale);
        const auto dof = static_cast<size_t>(model_.hinges[j].dof);
        impedance_[dof] = scale * scale * law_response(model_.hinges[j], frozen_[j], at.w[dof]).slope;
    }
    solver_.place(at.pose.data());
    slow(at, rates, false);
    slow(at, turns, true);
}

// `again`: with the factorisation of the last one
void Stepper::slow(const State& at, Real* change, bool again) {
    momentum(at, change);
    if (again) {
        solver_.solve_again(work_.data(), zero_.data(), change);
    } else {
        solver_.solve(impedance_.data(), work_.data(), zero_.data(), change);
    }
    keep_joined(at, change, 0);
}

// impulses about the body origins, in `work_`, that give the bodies the velocities of joint rates
void Stepper::momentum(const State& at, const Real* rates) {
    model_.tree.twists(at.pose.data(), rates, work_.data());
    model_.tree.to_centres(at.pose.data(), work_.data());
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const Body& b = model_.tree[i];
        Twist& v = work_[static_cast<size_t>(i)];
        const Vec2 linear = b.mass * v.v;
        v = {b.inertia * v.w + cross(at.pose[static_cast<size_t>(i)].turned(b.centre), linear), linear};
    }
}

double Stepper::speed_of(const State& at, const Real* rates) {
    model_.tree.twists(at.pose.data(), rates, work_.data());
    model_.tree.to_centres(at.pose.data(), work_.data());
    return kinetic_norm(model_.tree, work_, nullptr);
}

Real Stepper::effective_inertia(const State& at, int dof) {
    pause();
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    std::fill(work_.begin(), work_.end(), Twist{});
    rhs_[static_cast<size_t>(dof)] = 1;
    solver_.place(at.pose.data());
    solver_.solve(impedance_.data(), work_.data(), rhs_.data(), column_.data());
    keep_joined(at, column_.data(), model_.drives.size());
    return 1 / column_[static_cast<size_t>(dof)];
}

double Stepper::moved_by(const State& at, const std::vector<size_t>& loads) {
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    std::fill(work_.begin(), work_.end(), Twist{});
    for (const size_t k : loads) {
        const Load& load = model_.loads[k];
        Twist& b = work_[static_cast<size_t>(load.body)];
        b.v = b.v + load.scale * load.direction.v;
        b.w += load.scale * (load.direction.w + cross(arm(load.body, load.point, at.pose.data()), load.direction.v));
    }
    solver_.place(at.pose.data());
    solver_.solve(impedance_.data(), work_.data(), rhs_.data(), column_.data());
    keep_joined(at, column_.data(), model_.drives.size());
    model_.tree.twists(at.pose.data(), column_.data(), twist_.data());
    double power = 0;
    for (const size_t k : loads) {
        const Load& load = model_.loads[k];
        const Vec2 lever = arm(load.body, load.point, at.pose.data());
        power += value(load.scale * point_rate(load.direction, twist_[static_cast<size_t>(load.body)], lever));
    }
    return std::sqrt(std::max(power, 0.0));
}

bool Stepper::jerked(const State& at) const {
    std::vector<Twist> twist(at.pose.size());
    model_.tree.twists(at.pose.data(), at.w.data(), twist.data());
    for (size_t k = 0; k < model_.drives.size(); k++) {
        const Real rate = row_rate(rows_[k], at.pose.data(), twist.data()), begins = model_.drives[k].rate.at_time(at.t);
        if (fabs(rate - begins) > same_rate * max(fabs(rate), fabs(begins))) return true;
    }
    return false;
}

bool Stepper::step(State& s, double h, const Real* guess, int passes) {
    w_.assign(guess, guess + w_.size());
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        hint_[2 * j] = s.hinge[j].hint[0];
        hint_[2 * j + 1] = s.hinge[j].hint[1];
    }
    for (int pass = 0; pass < passes; pass++) {
        // predict the middle of the step: positions, velocities without joint impulses, loads and drives
        predict(s, h);
        // freeze capacities, rate factors and stops
        freeze(s, h);
        // solve for the joint rates at the end
        if (!newton()) return false;
        if (with_directions) differentiate();
    }
    commit(s, h);
    return true;
}

void Stepper::predict(const State& s, double h) {
    const Tree& tree = model_.tree;
    for (size_t k = 0; k < w_.size(); k++) dq_[k] = h * (s.w[k] + w_[k]) / 4;
    tree.place_ahead(s.pose.data(), s.q.data(), dq_.data(), middle_.data(), end_.data());
    tree.twists(middle_.data(), w_.data(), twist_.data());
    tree.twists(end_.data(), w_.data(), end_twist_.data());
    for (int i = 0; i < tree.bodies(); i++) {
        const Body& b = tree[i];
        const auto k = static_cast<size_t>(i);
        const Vec2 arm = middle_[k].turned(b.centre), end_arm = end_[k].turned(b.centre);
        // T1 w1 - T_mid w1 is taken from the previous pass, so that M (V1 - V0) is the complete change of momentum
        const Vec2 ahead = end_twist_[k].v + turn(end_twist_[k].w, end_arm) - twist_[k].v - turn(twist_[k].w, arm);
        const Vec2 linear = b.mass * (s.velocity[k].v - ahead + h * model_.gravity);
        bias_[k] = {b.inertia * s.velocity[k].w + cross(arm, linear), linear};
    }
    solver_.place(middle_.data());
    for (const Load& load : model_.loads) {
        const Real impulse = h * load.scale * load.value.mean(s.t, h);
        Twist& b = bias_[static_cast<size_t>(load.body)];
        b.v = b.v + impulse * load.direction.v;
        b.w += impulse * (load.direction.w + cross(arm(load.body, load.point, middle_.data()), load.direction.v));
    }
    aim_rows(s, h);
}

// Target rates of the constrained directions, evaluated at the positions of the midpoint.  At the end positions, which the last
// pass predicts, they must equal the rate of the drive (zero for holds and welds).  Drift of holds and welds is corrected in
// proportion to the largest joint rate at the end, so that a structure that is at rest or comes to rest within the step does not
// move; drift of drives is corrected at a rate of its own.
void Stepper::aim_rows(const State& s, double h) {
    if (rows_.empty()) return;
    Real turning = 0;
    for (const Real& w : w_) turning = max(turning, fabs(w));
    const Real joint_correction = min(turning / correction_turn, 1 / (2 * h));
    const double drive_correction = 1 / std::max(2 * h, drift_time_);
    for (size_t k = 0; k < rows_.size(); k++) {
        row_target_[k] = row_rate(rows_[k], middle_.data(), twist_.data()) - row_rate(rows_[k], end_.data(), end_twist_.data());
        Real place = 0, rate = 0, correction = joint_correction;
        if (k < model_.drives.size()) {
            const Drive& drive = model_.drives[k];
            place = drive.start + drive.rate.integral_to(s.t);
            rate = drive.rate.at_time(s.t + h);
            correction = drive_correction;
        }
        const Real drift = relative(rows_[k], s.pose.data()) - rows_[k].origin - place;
        row_target_[k] += rate - drift * correction;
    }
}

void Stepper::add_row(const Row& row) {
    rows_.push_back(row);
    rows_.back().origin = relative(row, middle_.data());
}

Real Stepper::relative(const Row& row, const Pose* pose) const {
    const Pose ground, &a = pose[row.body], &b = row.other < 0 ? ground : pose[row.other];
    return row.direction.w * (a.phi - b.phi) + dot(row.direction.v, a.at(row.point) - b.at(row.other_point));
}

// Relative rate of the two points of a row in its constrained direction.
Real Stepper::row_rate(const Row& row, const Pose* pose, const Twist* twist) const {
    const Real rate = point_rate(row.direction, twist[row.body], arm(row.body, row.point, pose));
    if (row.other < 0) return rate;
    return rate - point_rate(row.direction, twist[row.other], arm(row.other, row.other_point, pose));
}

void Stepper::freeze(const State& s, double h) {
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        const Hinge& hinge = model_.hinges[j];
        const auto dof = static_cast<size_t>(hinge.dof);
        frozen_[j] = hinge::freeze(hinge, s.hinge[j], {h}, s.q[dof], s.w[dof], w_[dof], &hint_[2 * j]);
    }
}

// Time within the step at which the hinges of loops come to rest.  Their rates are proportional to each other, so they stop
// together, after the time in which their capacities do the work of their impulses.  The step length if one of them still turns at
// the end, or if prescribed motion may have brought them to rest.
Real Stepper::common_halt(double h) const {
    Real work = 0, power = 0;
    for (size_t j = 0; j < frozen_.size(); j++) {
        if (!looped_[j]) continue;
        const FrozenHinge& f = frozen_[j];
        const Real w1 = w_[static_cast<size_t>(model_.hinges[j].dof)];
        if (!model_.drives.empty() || fabs(w1) > max(f.width, at_rest * fabs(f.w0))) return h;
        work += law_response(model_.hinges[j], f, w1).impulse * f.w0;
        power += f.capacity[f.w0 > 0 ? 0 : 1] * fabs(f.w0);
    }
    return power > 0 ? min(max(work / power, 0.0), h) : h;
}

// Marks the hinges on the path through the tree between the two bodies of each weld.
void Stepper::find_loops() {
    looped_.assign(model_.hinges.size(), false);
    const Tree& tree = model_.tree;
    for (const Weld& weld : model_.welds) {
        std::vector<int> passed(static_cast<size_t>(tree.bodies()), 0);
        for (int start : {weld.body, weld.other}) {
            for (int i = start; i >= 0; i = tree[i].parent) passed[static_cast<size_t>(i)]++;
        }
        for (size_t j = 0; j < model_.hinges.size(); j++) {
            for (int i = 0; i < tree.bodies(); i++) {
                if (tree[i].dof == model_.hinges[j].dof && passed[static_cast<size_t>(i)] == 1) looped_[j] = true;
            }
        }
    }
}

void Stepper::commit(State& s, double h) {
    const Tree& tree = model_.tree;
    const Real common = common_halt(h);
    for (size_t k = 0; k < w_.size(); k++) dq_[k] = h * (s.w[k] + w_[k]) / 2;
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        const Hinge& hinge = model_.hinges[j];
        const auto dof = static_cast<size_t>(hinge.dof);
        const Real* halt = model_.drives.empty() && !looped_[j] ? nullptr : &common;
        dq_[dof] = hinge::commit(hinge, frozen_[j], s.hinge[j], s.t, s.q[dof], w_[dof], halt);
        s.hinge[j].hint[0] = hint_[2 * j];
        s.hinge[j].hint[1] = hint_[2 * j + 1];
    }
    // the work of gravity is exact; the work of loads and drives uses the mean of the start and end rates of their points
    auto mean_rate = [&](int body, Vec2 point, const Twist& direction) {
        const auto i = static_cast<size_t>(body);
        const Body& b = tree[body];
        const Vec2 before = s.pose[i].turned(point - b.centre), after = end_[i].turned(point - b.centre);
        return (point_rate(direction, s.velocity[i], before) + point_rate(direction, end_twist_[i], after)) / 2;
    };
    for (size_t k = 0; k < w_.size(); k++) s.q[k] += dq_[k];
    s.w = w_;
    tree.place_after(s.pose.data(), s.q.data(), end_.data());
    tree.twists(end_.data(), w_.data(), end_twist_.data());
    tree.to_centres(end_.data(), end_twist_.data());
    for (int i = 0; i < tree.bodies(); i++) {
        const auto k = static_cast<size_t>(i);
        s.external_work += tree[i].mass * dot(model_.gravity, end_[k].at(tree[i].centre) - s.pose[k].at(tree[i].centre));
    }
    for (const Load& load : model_.loads) {
        s.external_work += h * load.scale * load.value.mean(s.t, h) * mean_rate(load.body, load.point, load.direction);
    }
    for (size_t d = 0; d < model_.drives.size(); d++) {
        const Drive& drive = model_.drives[d];
        s.external_work += row_force_[d] * mean_rate(drive.body, drive.point, drive.direction);
        s.drive_impulse[d] = row_force_[d] / h;
    }
    s.pose.swap(end_);
    s.velocity.swap(end_twist_);
    s.t += h;
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
