#include "spatial/step/stepper.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Passes over the frozen quantities of a step: the second evaluates them at the middle of the motion found by the first, which makes
// the step second-order accurate.  More follow only until friction agrees with the normal impulses of the contacts, and in quasi-static
// steps of elastic hinges until places change by at most a share of the motion.
constexpr int passes = 2, most_passes = 20;
constexpr double same_place = 1e-3;
// Least share of the way to the result of a pass that the next one begins at.
constexpr double least_share = 0.05;
// Passes in which contacts take the load in turns, after which their friction may disagree: it would in all that follow.
constexpr int most_turns = 3;
// Share of its capacity by which a hinge resists more in a quasi-static step if it turns as fast as anything does.  It divides a rotation
// between hinges of one capacity, which equilibrium leaves open, and is far below what any law is known to.
constexpr double shared_share = 2e-4;
// Length of a step that is used to evaluate the present state only [s].
constexpr double instant = 1e-12;

size_t at(int i) { return static_cast<size_t>(i); }

// Weight of the end rate with which a damped rate decays by e^-z over a step, z = h c/m.
double end_weight(double z) { return z < 1e-3 ? 0.5 + z / 12 : 1 / (1 - std::exp(-z)) - 1 / z; }

Mat3 world(const Quat& q, const Mat3& m) {
    const Mat3 r = matrix(q);
    return r * m * transposed(r);
}

}  // namespace

Stepper::Stepper(const Model& model) : p_(model), newton_(p_), contact_(p_), end_(p_, contact_), loops_(model), filter_(p_) {
    for (auto* v : {&direction_, &momentum_, &guess_}) v->resize(model.bodies.size());
    // find the redundant held rows, with all hinges free
    const State s = start();
    p_.locate_all(s, s.pose, 0, p_.rows, p_.error.data());
    find_redundant(s.pose);
    redundant_ = p_.system.redundant();
    redundant_rows_.assign(model.joints.size(), 0);
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (p_.is_joint(c)) redundant_rows_[at(p_.connections[c].index)] = p_.system.redundant(c);
    }
}

bool Stepper::step(State& s, double h, const std::vector<Twist>* guess, bool discarded) {
    begin(s, h, guess, discarded);
    bool settled = true;
    for (int pass = guess ? 1 : 0; pass < passes || (!settled && pass < most_passes); pass++) {
        place_middle(s, h);
        aim(s, h);
        freeze(s, h);
        if (!solve()) return false;
        settled = settle();
        follow_pass();
    }
    return end_.commit(s, h, !discarded);
}

// The guess, contacts within reach, true rates at the start, and redundant rows.
void Stepper::begin(State& s, double h, const std::vector<Twist>* guess, bool discarded) {
    p_.length = h;
    guess_ = guess ? *guess : s.velocity;
    p_.speed = 0;
    for (size_t i = 0; i < s.velocity.size(); i++) {
        p_.speed = std::max({p_.speed, norm(s.velocity[i].v), norm(s.velocity[i].w) * p_.model.length, norm(guess_[i].v)});
    }
    double gain = h * norm(p_.model.gravity);
    for (size_t i = 0; i < guess_.size(); i++) gain = std::max(gain, norm(guess_[i].v - s.velocity[i].v));
    gather(s, h, gain);
    contact_.begin(s);
    p_.locate_all(s, s.pose, s.t, p_.rows, p_.error.data());
    p_.rates(p_.rows, s.velocity.data(), p_.rate0.data());
    find_redundant(s.pose);
    turned_back_.assign(p_.frozen.size(), false);
    turns_ = 0;
    change_.clear();
    share_ = 1;
    // a guess is the result of a step that has just been solved
    newton_.begin(guess != nullptr, !discarded);
}

// Finds the contacts within reach of a step.
void Stepper::gather(State& s, double h, double gain) {
    if (!p_.contacts.gather(s.pose, s.velocity, h, gain, s.contact)) return;
    p_.link_all();
    newton_.relinked();
}

// Predicts the middle of the step, with the motion of bodies and loads, and the velocities without impulses of joints.  The gaps of held
// rows at the middle are of second order, which is enough for a step of second order.  Redundant rows need no more: they were chosen
// where the state satisfies all rows, not at the middle, where those of a mechanism like Bricard's are independent and would lock it.
void Stepper::place_middle(const State& s, double h) {
    predict(s, h);
    p_.set_mobilities(p_.middle);
    set_free(s);
    p_.locate_all(s, p_.middle, s.t + p_.balanced_at() * h, p_.rows, p_.error.data());
    p_.system.assemble(p_.rows);
}

// predicts the poses at the middle and the end, and the impulses of gravity and loads
void Stepper::predict(const State& s, double h) {
    for (size_t i = 0; i < p_.model.bodies.size(); i++) {
        const Twist mean = 0.5 * (s.velocity[i] + guess_[i]);
        p_.middle[i] = moved(s.pose[i], (p_.balanced_at() * h) * mean);
        p_.end[i] = moved(s.pose[i], h * mean);
    }
    for (size_t i = 0; i < p_.model.bodies.size(); i++) momentum_[i] = {{}, h * p_.model.bodies[i].mass * p_.model.gravity};
    for (const Load& load : p_.model.loads) {
        const double factor = h * p_.factor_of(load, s, h);
        const Vec3 arm = turned(p_.middle[at(load.body)].q, load.arm);
        Twist& m = momentum_[at(load.body)];
        m = m + factor * Twist{load.moment + cross(arm, load.force), load.force};
    }
}

// V*: accounts for the change of angular momentum between start and end, (I_1 w_1) - (I_0 w_0), with the inertia of the midpoint.  In
// a quasi-static step V* follows from the impulses alone, because drag has no momentum.
void Stepper::set_free(const State& s) {
    for (size_t i = 0; i < p_.free.size(); i++) {
        if (p_.stage.quasi_static) {
            p_.free[i] = p_.system.mobility(i, momentum_[i]);
            continue;
        }
        const Body& body = p_.model.bodies[i];
        const Vec3 before = world(s.pose[i].q, body.inertia) * s.velocity[i].w;
        const Vec3 after = world(p_.end[i].q, body.inertia) * guess_[i].w - p_.inertia[i] * guess_[i].w;
        p_.free[i] = p_.system.mobility(i, {before - after + momentum_[i].w, body.mass * s.velocity[i].v + momentum_[i].v});
    }
}

// sets the bias c of all rows and the target rates of the held rows at the end of the step
void Stepper::aim(const State& s, double h) {
    p_.rates(p_.rows, s.velocity.data(), p_.bias.data());
    for (size_t k = 0; k < p_.bias.size(); k++) p_.bias[k] -= p_.rate0[k];
    std::fill(p_.target.begin(), p_.target.end(), 0.0);
    contact_.allow_closing(h);
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!p_.is_joint(c)) continue;
        const size_t index = at(p_.connections[c].index);
        const Joint& joint = p_.model.joints[index];
        if (!joint.driven) continue;
        Target end = p_.target_of(joint, s, s.t + h);
        if (p_.stage.quasi_static) {
            // from rest: twice the mean rate
            const Target begin = p_.target_of(joint, s, s.t);
            for (int k = 0; k < 6; k++) end.rate[k] = 2 * (end.place[k] - begin.place[k]) / h;
        }
        const Pose a = p_.model.pose(p_.middle, joint.body[0]);
        for (int i = 0; i < joint.held; i++) p_.target[at(p_.start(c) + i)] = target_rate(joint, a, p_.geometry[index], end, i);
    }
}

// Freezes capacities, rate factors and stops at the rates of the guess.
void Stepper::freeze(const State& s, double h) {
    p_.w.swap(p_.w_next);
    p_.rates(p_.rows, guess_.data(), p_.w.data());
    for (size_t k = 0; k < p_.w.size(); k++) p_.w[k] += p_.bias[k];
    for (size_t c = 0; c < p_.connections.size(); c++) {
        const size_t index = at(p_.connections[c].index), first = at(p_.start(c));
        if (p_.is_contact(c)) {
            // stiff relative to the true inertia
            p_.contacts.freeze(index, p_.inertia_share() * p_.mobility(c, p_.rows[first]), h);
            continue;
        }
        if (p_.is_spring(c)) {
            freeze_spring(s, h, c);
            continue;
        }
        const int hinge = p_.hinge_index(c);
        if (hinge < 0) continue;
        const size_t held = at(p_.system.links()[c].held), k = at(p_.component[at(hinge)]);
        // the axial force and the share of the torque at the middle of the step
        SpatialHingeState state = s.hinge[at(hinge)];
        state.tension += p_.followed(h / 2) * (state.tension_aim - state.tension);
        state.torque_left += p_.followed(h / 2) * (state.torque_aim - state.torque_left);
        p_.frozen[at(hinge)] = spatial::freeze(p_.model.hinges[at(hinge)], state, {h, p_.elastic_weight(h)}, &s.turned[k], &p_.rate0[first + held], &p_.w[first + held]);
        spatial::widen(p_.model.hinges[at(hinge)], p_.frozen[at(hinge)], p_.least_width(p_.model.hinges[at(hinge)]));
        // one reversal is enough: a hinge that reverses in one pass and slides on in the next would alternate forever
        if (turned_back_[at(hinge)]) p_.frozen[at(hinge)].lead = 0;
    }
    if (p_.stage.quasi_static && !p_.stage.lost) divide_shared_rotations(s);
}

// Hinges of one law in series, or that carry one axial force: equilibrium leaves open which of them flows.  Where nothing is driven, loads
// may pass what the structure carries, and no viscosity may hold it then.
void Stepper::divide_shared_rotations(const State& s) {
    double fastest = 0;
    bool driven = false;
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!p_.is_joint(c)) continue;
        const Joint& joint = p_.model.joints[at(p_.connections[c].index)];
        for (int i = 0; joint.driven && i < joint.held; i++) driven = driven || p_.target[at(p_.start(c) + i)] != 0;
    }
    for (size_t i = 0; driven && i < guess_.size(); i++) {
        fastest = std::max({fastest, norm(guess_[i].v) / p_.model.length, norm(guess_[i].w)});
    }
    for (size_t j = 0; j < p_.frozen.size(); j++) divide_shared(p_.model.hinges[j], s.hinge[j], p_.frozen[j], shared_share, fastest);
}

void Stepper::freeze_spring(const State& s, double h, size_t link) {
    const size_t index = at(p_.connections[link].index), first = at(p_.start(link));
    const Spring& spring = p_.model.springs[index];
    Row row;
    double length = 0;
    p_.locate_spring(spring, s.pose, row, &length);
    const double weight = spring.damping > 0 ? end_weight(h * spring.damping * p_.mobility(link, p_.rows[first])) : 1;
    p_.spring_weight[index] = weight;
    p_.spring_force[index] = h * (spring.stiffness * (length - spring.length + h * p_.rate0[first] / 4) +
                                   spring.damping * (1 - weight) * p_.rate0[first]);
    p_.spring_tangent[index] = h * (spring.stiffness * h / 4 + spring.damping * weight);
}

bool Stepper::solve() {
    newton_.keep_locked();
    return records_.following() ? records_.solve(p_, newton_) : newton_.solve();
}

// After a pass: whether contacts, hinges and places need no further one.
bool Stepper::settle() {
    if (newton_.took_turns()) turns_++;
    const bool rubs = !contact_.settle(turns_ >= most_turns);
    const bool turned = turned_back();
    return records_.settled(p_, !turned && !rubs && (!p_.balances() || keeps_place()));
}

// Whether a pass leaves the places at which its forces balance where the pass before had them.  What presses a member bends it further
// with its deflection: near its buckling load two passes leave most of that to the next step, and steps shrink without end.
bool Stepper::keeps_place() const {
    double change = 0, motion = 0;
    for (size_t i = 0; i < guess_.size(); i++) {
        const Twist &to = p_.velocity[i], d = to - guess_[i];
        change = std::max({change, norm(d.v), norm(d.w) * p_.model.length});
        motion = std::max({motion, norm(to.v), norm(to.w) * p_.model.length});
    }
    return change <= same_place * motion;
}

// The guess of the next pass: the result of this one.  Where passes in search of a place overshoot, it is a share s of the way there.  What
// a member carries along its axis pulls it back across it by more than its yielded hinges yield, so that the change r of every pass is
// larger than that of the one before and opposite; along it, s = s_0 r_0 (r_0 - r)/|r_0 - r|^2 ends this in a pass (Aitken's relaxation).
void Stepper::follow_pass() {
    if (!p_.balances()) {
        guess_ = p_.velocity;
        return;
    }
    const double length = p_.model.length;
    auto dot_of = [&](const Twist& a, const Twist& b) { return dot(a.v, b.v) + length * length * dot(a.w, b.w); };
    double along = 0, apart = 0;
    for (size_t i = 0; i < change_.size(); i++) {
        const Twist less = change_[i] - (p_.velocity[i] - guess_[i]);
        along += dot_of(change_[i], less);
        apart += dot_of(less, less);
    }
    share_ = along > 0 ? std::clamp(share_ * along / apart, least_share, 1.0) : 1;
    change_.resize(guess_.size());
    for (size_t i = 0; i < guess_.size(); i++) {
        change_[i] = p_.velocity[i] - guess_[i];
        guess_[i] = guess_[i] + share_ * change_[i];
    }
}

// Whether a coupled hinge came to rest or reversed in a step that assumed continued sliding: its rates then have another weight, see
// `FrozenSpatialHinge::lead`.
bool Stepper::turned_back() {
    bool any = false;
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!p_.hinge_of(c)) continue;
        const FrozenSpatialHinge& f = p_.frozen[at(p_.hinge_index(c))];
        if (f.lead == 0) continue;
        double along = 0;
        for (int k = 0; k < size(*p_.hinge_of(c)); k++) along += f.w0[k] * p_.w[at(p_.start(c) + p_.system.links()[c].held + k)];
        if (along > 0) continue;
        turned_back_[at(p_.hinge_index(c))] = true;
        any = true;
    }
    return any;
}

// finds the redundant held rows at the positions where they have just been located
void Stepper::find_redundant(const std::vector<Pose>& poses) {
    loops_.find(p_.geometry, poses);
    for (size_t c = 0; c < p_.connections.size(); c++) {
        for (int i = 0; i < p_.system.links()[c].held; i++) {
            p_.system.set_redundant(p_.start(c) + i, loops_.redundant(at(p_.connections[c].index), i));
        }
    }
}

State Stepper::start() {
    State s;
    for (const Body& body : p_.model.bodies) s.pose.push_back({body.centre, {}});
    s.velocity.resize(s.pose.size());
    s.acceleration.resize(s.pose.size());
    s.travel.resize(s.pose.size());
    s.hinge.resize(p_.model.hinges.size());
    s.rotation.assign(at(p_.component.back()), 0.0);
    s.turned = s.rotation;
    s.rate.assign(at(p_.component.back()), 0.0);
    s.joint_force.resize(p_.model.joints.size());
    for (size_t j = 0; j < p_.model.hinges.size(); j++) {
        for (int k = 0; k < size(p_.model.hinges[j]); k++) {
            int hint = 0;
            const hinge::Hinge& law = p_.model.hinges[j].components[at(k)].law;
            s.hinge[j].component[k].capacity = law.scale * law.positive.at(0, hint);
        }
    }
    return s;
}

int Stepper::held_rows() const {
    int held = 0;
    for (const Link& link : p_.system.links()) held += link.held;
    return held;
}

void Stepper::look_for_impact(State& s) {
    gather(s, instant, 0);
    p_.locate_all(s, s.pose, s.t, p_.rows, p_.error.data());
    p_.set_mobilities(s.pose);
    const size_t first = p_.contact_rows();
    for (size_t i = 0; i < p_.contacts.size(); i++) {
        p_.contacts.freeze(i, p_.mobility(p_.connections.size() - p_.contacts.size() + i, p_.rows[first + p_.contacts.rows() * i]), 0);
    }
    contact_.see(s, 0, true);
}

}  // namespace crumple::spatial
