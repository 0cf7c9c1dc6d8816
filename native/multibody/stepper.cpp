#include "multibody/stepper.hpp"

#include <algorithm>
#include <cmath>

#include "multibody/dense.hpp"

namespace crumple::multibody {

namespace {

// Passes over the frozen quantities: the second takes them at the middle of the motion that the first found,
// which makes the step second order.
constexpr int passes = 2;
// Whole Newton steps before the guaranteed path is taken; they fail only by cycling, which is rare.
constexpr int bold_limit = 16;
// Newton steps per width of the ramps before the step is given up and halved.
constexpr int newton_limit = 60;
// Widening: from the largest rate down by this factor a time.
constexpr double narrowing = 1e-2;
// Relative accuracy of a hinge's impulse; piecewise linear laws reach round-off, HAVSIN ramps converge to this.
constexpr double impulse_tolerance = 1e-9;

double point_rate(const Twist& direction, const Twist& body, Vec2 arm) {
    return direction.w * body.w + dot(direction.v, body.v + turn(body.w, arm));
}

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
    const size_t d = model.drives.size();
    frozen_.resize(model.hinges.size());
    for (const Hinge& hinge : model.hinges) all_set_valued_ = all_set_valued_ && hinge.form == Form::set_valued;
    hint_.assign(2 * model.hinges.size(), 0);
    for (auto* v : {&w_, &next_, &direction_, &rhs_, &impedance_, &dq_, &column_, &overload_, &overload_of_children_}) v->assign(m, 0.0);
    for (auto* v : {&middle_, &end_}) v->resize(n);
    for (auto* v : {&twist_, &end_twist_, &bias_, &work_}) v->resize(n);
    drive_target_.resize(d);
    drive_force_.resize(d);
    drive_rows_.resize(d * m);
    drive_matrix_.resize(d * d);
    model.tree.place(model.q0.data(), middle_.data());
    for (const Drive& drive : model.drives) drive_origin_.push_back(middle_[static_cast<size_t>(drive.body)].at(drive.point));
}

State Stepper::start(const double* q, const double* w) const {
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
        s.hinge[j].capacity = model_.hinges[j].positive.at(0, hint);
    }
    return s;
}

void Stepper::project(const State& at, const Twist* velocity, const Twist* impulse, double* w) {
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const Body& b = model_.tree[i];
        const Vec2 c = at.pose[static_cast<size_t>(i)].turned(b.centre);
        const Vec2 linear = b.mass * velocity[i].v + impulse[i].v;
        work_[static_cast<size_t>(i)] = {b.inertia * velocity[i].w + impulse[i].w + cross(c, linear), linear};
    }
    solver_.factor(at.pose.data(), impedance_.data());
    solver_.solve(work_.data(), rhs_.data(), w);
}

double Stepper::effective_inertia(const State& at, int dof) {
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    std::fill(work_.begin(), work_.end(), Twist{});
    rhs_[static_cast<size_t>(dof)] = 1;
    solver_.factor(at.pose.data(), impedance_.data());
    solver_.solve(work_.data(), rhs_.data(), column_.data());
    return 1 / column_[static_cast<size_t>(dof)];
}

bool Stepper::step(State& s, double h) {
    w_ = s.w;
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        hint_[2 * j] = s.hinge[j].hint[0];
        hint_[2 * j + 1] = s.hinge[j].hint[1];
    }
    for (int pass = 0; pass < passes; pass++) {
        // positions, free-flight velocities, loads and drives at the predicted middle
        predict(s, h);
        // capacities, rate factors and stops
        freeze(s, h);
        // end rates
        if (!newton()) return false;
    }
    commit(s, h);
    return true;
}

void Stepper::predict(const State& s, double h) {
    const Tree& tree = model_.tree;
    const size_t m = w_.size();
    for (size_t k = 0; k < m; k++) dq_[k] = h * (s.w[k] + w_[k]) / 4;
    tree.place_near(s.pose.data(), s.q.data(), dq_.data(), middle_.data());
    for (size_t k = 0; k < m; k++) dq_[k] *= 2;
    tree.place_near(s.pose.data(), s.q.data(), dq_.data(), end_.data());
    tree.twists(middle_.data(), w_.data(), twist_.data());
    tree.to_centres(middle_.data(), twist_.data());
    tree.twists(end_.data(), w_.data(), end_twist_.data());
    tree.to_centres(end_.data(), end_twist_.data());
    for (int i = 0; i < tree.bodies(); i++) {
        const Body& b = tree[i];
        const auto k = static_cast<size_t>(i);
        // T1 w1 - T_mid w1 is lagged: then M (V1 - V0) is the whole change of momentum
        const Vec2 v = s.velocity[k].v - (end_twist_[k].v - twist_[k].v) + h * model_.gravity;
        const Vec2 linear = b.mass * v;
        bias_[k] = {b.inertia * s.velocity[k].w + cross(middle_[k].turned(b.centre), linear), linear};
    }
    for (const Load& load : model_.loads) {
        int hint = 0;
        const double impulse = h * load.value.at(s.t + h / 2, hint);
        Twist& b = bias_[static_cast<size_t>(load.body)];
        b.v = b.v + impulse * load.direction.v;
        b.w += impulse * (load.direction.w + cross(arm(load.body, load.point, middle_.data()), load.direction.v));
    }
    for (size_t d = 0; d < model_.drives.size(); d++) {
        const Drive& drive = model_.drives[d];
        const Pose& pose = s.pose[static_cast<size_t>(drive.body)];
        const Vec2 moved = pose.at(drive.point) - drive_origin_[d];
        const double now = drive.direction.w * pose.phi + dot(drive.direction.v, moved);
        int hint = 0;
        const double error = drive.motion.value.at(s.t, hint) - now;
        hint = 0;
        drive_target_[d] = drive.motion.rate.at(s.t + h, hint) + error / (2 * h);
    }
}

void Stepper::freeze(const State& s, double h) {
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        const Hinge& hinge = model_.hinges[j];
        const auto dof = static_cast<size_t>(hinge.dof);
        frozen_[j] = multibody::freeze(hinge, s.hinge[j], h, s.q[dof], s.w[dof], w_[dof], &hint_[2 * j]);
    }
}

// A locked hinge is nearly infinitely stiff, so a line search at the true ramps unlocks hinges one at a time.  So
// whole steps are tried first; where they cycle, the ramps are widened and narrowed in steps, each a good start
// for the next, with line search.
bool Stepper::newton() {
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    if (all_set_valued_ ? descend(bold_limit, true) : descend(newton_limit, false)) return true;
    double width = 1;
    for (const double w : w_) width = std::max(width, std::fabs(w));
    if (!std::isfinite(width)) return false;
    for (bool narrowest = false; !narrowest; width *= narrowing) {
        narrowest = true;
        for (size_t j = 0; j < frozen_.size(); j++) {
            const Hinge& hinge = model_.hinges[j];
            const double wanted = std::max(width, ramp_width(hinge));
            double& w = w_[static_cast<size_t>(hinge.dof)];
            // inside the ramp the moment is kept, so the rate shrinks with the width
            if (wanted < frozen_[j].width && std::fabs(w) < frozen_[j].width) w *= wanted / frozen_[j].width;
            frozen_[j].width = wanted;
            if (wanted > ramp_width(hinge)) narrowest = false;
        }
        if (!descend(newton_limit, false)) return false;
    }
    return true;
}

// Takes the whole Newton step, except that a hinge which would reverse is first put to rest, and that of
// neighbouring locked hinges loaded beyond their capacity only the one loaded most is released: the moment
// falls beside it, and releasing all of them would only send most back.
void Stepper::take_whole_step() {
    std::fill(overload_.begin(), overload_.end(), 0.0);
    std::fill(overload_of_children_.begin(), overload_of_children_.end(), 0.0);
    for (size_t j = 0; j < frozen_.size(); j++) {
        const auto dof = static_cast<size_t>(model_.hinges[j].dof);
        const double width = frozen_[j].width;
        const bool locked = std::fabs(w_[dof]) < width;
        if (!locked && next_[dof] * w_[dof] < 0) next_[dof] = 0;
        if (locked && std::fabs(next_[dof]) > width) overload_[dof] = std::fabs(next_[dof]) / width;
    }
    const Tree& tree = model_.tree;
    for (int i = 0; i < tree.bodies(); i++) {
        if (tree[i].parent < 0) continue;
        double& most = overload_of_children_[static_cast<size_t>(tree[tree[i].parent].dof)];
        most = std::max(most, overload_[static_cast<size_t>(tree[i].dof)]);
    }
    for (int i = 0; i < tree.bodies(); i++) {
        const auto dof = static_cast<size_t>(tree[i].dof);
        const double own = overload_[dof];
        if (own == 0) continue;
        const double above = tree[i].parent < 0 ? 0 : overload_[static_cast<size_t>(tree[tree[i].parent].dof)];
        if (own < above || own < overload_of_children_[dof]) next_[dof] *= 0.999 / own;
    }
    w_.swap(next_);
}

// Newton steps, bold (whole steps, no guarantee) or with exact line search on the potential (always downhill).
bool Stepper::descend(int limit, bool bold) {
    for (int iteration = 0; iteration < limit; iteration++) {
        // tangent of every hinge at the present rates
        for (size_t j = 0; j < frozen_.size(); j++) {
            const auto dof = static_cast<size_t>(model_.hinges[j].dof);
            const Response r = respond(model_.hinges[j], frozen_[j], w_[dof]);
            impedance_[dof] = r.slope;
            rhs_[dof] = r.slope * w_[dof] - r.impulse;
        }
        solve_once();
        // what the true responses leave unbalanced there, and the slope of the potential along the step
        double slope = 0;
        bool balanced = true;
        for (size_t j = 0; j < frozen_.size(); j++) {
            const auto dof = static_cast<size_t>(model_.hinges[j].dof);
            const double w = next_[dof], tangent = impedance_[dof] * w - rhs_[dof];
            const double impulse = respond(model_.hinges[j], frozen_[j], w).impulse, left = impulse - tangent;
            const double scale = frozen_[j].h * (frozen_[j].capacity[0] + frozen_[j].capacity[1]) + std::fabs(impulse);
            if (!(std::fabs(left) <= impulse_tolerance * scale)) balanced = false;
            slope += left * (w - w_[dof]);
        }
        if (!std::isfinite(slope)) return false;
        if (balanced) {
            w_.swap(next_);
            return true;
        }
        if (bold) {
            take_whole_step();
        } else if (slope <= 0) {
            w_.swap(next_);
        } else {
            const double a = search(slope);
            for (size_t k = 0; k < w_.size(); k++) w_[k] += a * (next_[k] - w_[k]);
        }
    }
    return false;
}

void Stepper::solve_once() {
    work_ = bias_;
    solver_.factor(middle_.data(), impedance_.data());
    solver_.solve(work_.data(), rhs_.data(), next_.data());
    solves_++;
    if (!model_.drives.empty()) constrain(next_.data());
}

// Adds to w the response to the drive forces that bring every driven point to its target rate.
void Stepper::constrain(double* w) {
    const size_t d = model_.drives.size(), m = w_.size();
    const std::vector<double> zero(m, 0.0);
    auto rates = [&](const double* rate, double* out) {
        model_.tree.twists(middle_.data(), rate, twist_.data());
        for (size_t k = 0; k < d; k++) {
            const Drive& drive = model_.drives[k];
            out[k] = point_rate(drive.direction, twist_[static_cast<size_t>(drive.body)],
                                arm(drive.body, drive.point, middle_.data()));
        }
    };
    for (size_t k = 0; k < d; k++) {
        const Drive& drive = model_.drives[k];
        std::fill(work_.begin(), work_.end(), Twist{});
        const Vec2 a = arm(drive.body, drive.point, middle_.data());
        work_[static_cast<size_t>(drive.body)] = {drive.direction.w + cross(a, drive.direction.v), drive.direction.v};
        solver_.solve(work_.data(), zero.data(), &drive_rows_[k * m]);
        rates(&drive_rows_[k * m], &drive_matrix_[k * d]);
    }
    rates(w, drive_force_.data());
    for (size_t k = 0; k < d; k++) drive_force_[k] = drive_target_[k] - drive_force_[k];
    solve_symmetric(drive_matrix_.data(), drive_force_.data(), static_cast<int>(d));
    for (size_t k = 0; k < d; k++) {
        for (size_t i = 0; i < m; i++) w[i] += drive_force_[k] * drive_rows_[k * m + i];
    }
}

// Root of the potential's slope along next - w, in (0, 1): exact for piecewise linear responses, because the
// bracket shrinks to one piece before it is interpolated.
double Stepper::search(double slope_end) {
    double curvature = 0, linear_end = 0;
    for (size_t k = 0; k < w_.size(); k++) direction_[k] = next_[k] - w_[k];
    model_.tree.twists(middle_.data(), direction_.data(), twist_.data());
    model_.tree.to_centres(middle_.data(), twist_.data());
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const Twist& v = twist_[static_cast<size_t>(i)];
        curvature += model_.tree[i].mass * dot(v.v, v.v) + model_.tree[i].inertia * v.w * v.w;
    }
    breakpoints_.clear();
    for (size_t j = 0; j < frozen_.size(); j++) {
        const auto dof = static_cast<size_t>(model_.hinges[j].dof);
        const double d = direction_[dof];
        linear_end += (rhs_[dof] - impedance_[dof] * next_[dof]) * d;
        double rates[8];
        const int n = kinks(model_.hinges[j], frozen_[j], rates);
        for (int k = 0; k < n; k++) {
            const double a = (rates[k] - w_[dof]) / d;
            if (a > 0 && a < 1) breakpoints_.push_back(a);
        }
    }
    auto slope = [&](double a) {
        double f = linear_end - (1 - a) * curvature;
        for (size_t j = 0; j < frozen_.size(); j++) {
            const auto dof = static_cast<size_t>(model_.hinges[j].dof);
            const double w = w_[dof] + a * direction_[dof];
            f += respond(model_.hinges[j], frozen_[j], w).impulse * direction_[dof];
        }
        return f;
    };
    std::sort(breakpoints_.begin(), breakpoints_.end());
    double lo = 0, hi = 1, f_lo = slope(0), f_hi = slope_end;
    size_t first = 0, last = breakpoints_.size();
    while (first < last) {
        const size_t middle = (first + last) / 2;
        const double a = breakpoints_[middle], f = slope(a);
        if (f > 0) {
            hi = a;
            f_hi = f;
            last = middle;
        } else {
            lo = a;
            f_lo = f;
            first = middle + 1;
        }
    }
    // within one piece: secant, safeguarded by bisection where the piece is curved
    for (int k = 0; k < 40 && hi - lo > 1e-15 * hi; k++) {
        const double a = k % 3 == 2 ? (lo + hi) / 2 : lo - f_lo * (hi - lo) / (f_hi - f_lo);
        if (!(a > lo && a < hi)) break;
        const double f = slope(a);
        if (std::fabs(f) <= 1e-12 * std::fabs(slope_end)) return a;
        (f > 0 ? hi : lo) = a;
        (f > 0 ? f_hi : f_lo) = f;
    }
    return f_lo < -f_hi && f_hi < -f_lo ? hi : (-f_lo < f_hi && lo > 0 ? lo : hi);
}

void Stepper::commit(State& s, double h) {
    const Tree& tree = model_.tree;
    for (size_t k = 0; k < w_.size(); k++) dq_[k] = h * (s.w[k] + w_[k]) / 2;
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        const Hinge& hinge = model_.hinges[j];
        const auto dof = static_cast<size_t>(hinge.dof);
        dq_[dof] = multibody::commit(hinge, frozen_[j], s.hinge[j], s.t, s.q[dof], w_[dof]);
        s.hinge[j].hint[0] = hint_[2 * j];
        s.hinge[j].hint[1] = hint_[2 * j + 1];
    }
    // work of gravity is exact; loads and drives act over the mean of the start and end rates of their points
    auto mean_rate = [&](int body, Vec2 point, const Twist& direction) {
        const auto i = static_cast<size_t>(body);
        const Body& b = tree[body];
        const Vec2 before = s.pose[i].turned(point - b.centre), after = end_[i].turned(point - b.centre);
        return (point_rate(direction, s.velocity[i], before) + point_rate(direction, end_twist_[i], after)) / 2;
    };
    for (size_t k = 0; k < w_.size(); k++) s.q[k] += dq_[k];
    s.w = w_;
    tree.place(s.q.data(), end_.data());
    tree.twists(end_.data(), w_.data(), end_twist_.data());
    tree.to_centres(end_.data(), end_twist_.data());
    for (int i = 0; i < tree.bodies(); i++) {
        const auto k = static_cast<size_t>(i);
        s.external_work += tree[i].mass * dot(model_.gravity, end_[k].at(tree[i].centre) - s.pose[k].at(tree[i].centre));
    }
    for (const Load& load : model_.loads) {
        int hint = 0;
        s.external_work += h * load.value.at(s.t + h / 2, hint) * mean_rate(load.body, load.point, load.direction);
    }
    for (size_t d = 0; d < model_.drives.size(); d++) {
        const Drive& drive = model_.drives[d];
        s.external_work += drive_force_[d] * mean_rate(drive.body, drive.point, drive.direction);
        s.drive_impulse[d] = drive_force_[d] / h;
    }
    s.pose.swap(end_);
    s.velocity.swap(end_twist_);
    s.t += h;
}

}  // namespace crumple::multibody
