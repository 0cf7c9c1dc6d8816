#include "spatial/step/stepper.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Passes over the frozen quantities of a step: the second evaluates them at the middle of the motion found by the first, which makes
// the step second-order accurate.  More follow only until friction agrees with the normal impulses of the contacts.
constexpr int passes = 2, most_passes = 20;
// Limit of the linear solves of a step relative to the Newton iterations allowed for one width of the ramps: enough for all widths in
// two passes, and some more.
constexpr int most_solves = 20;

// Rate, relative to the speed, that is never reached in an impact; larger values cost digits.
constexpr double unreached = 1e3;

size_t at(int i) { return static_cast<size_t>(i); }

// Weight of the end rate with which a damped rate decays by e^-z over a step, z = h c/m.
double end_weight(double z) { return z < 1e-3 ? 0.5 + z / 12 : 1 / (1 - std::exp(-z)) - 1 / z; }

Mat3 world(const Quat& q, const Mat3& m) {
    const Mat3 r = matrix(q);
    return r * m * transposed(r);
}

}  // namespace

Stepper::Stepper(const Model& model) : model_(model), contacts_(model.contact), loops_(model), hinge_link_(model.hinges.size()) {
    for (size_t j = 0; j < model.joints.size(); j++) {
        const Joint& joint = model.joints[j];
        if (joint.rows() == 0) continue;
        if (joint.hinge >= 0) hinge_link_[at(joint.hinge)] = connections_.size();
        connections_.push_back({Kind::joint, static_cast<int>(j)});
    }
    for (size_t k = 0; k < model.springs.size(); k++) {
        connections_.push_back({Kind::spring, static_cast<int>(k)});
    }
    link_all();
    int components = 0;
    for (const SpatialHinge& hinge : model.hinges) {
        component_.push_back(components);
        components += size(hinge);
        all_set_valued_ = all_set_valued_ && hinge.components.front().law.form == Form::set_valued;
    }
    component_.push_back(components);
    has_paths_ = all_set_valued_ && !model.hinges.empty();
    for (const SpatialHinge& hinge : model.hinges) has_paths_ = has_paths_ && hinge.surface.coupling != Coupling::tension_flange;
    const size_t bodies = model.bodies.size();
    frozen_.resize(model.hinges.size());
    for (auto* v : {&spring_force_, &spring_tangent_, &spring_weight_}) v->assign(model.springs.size(), 0.0);
    geometry_.resize(model.joints.size());
    for (auto* v : {&middle_, &end_}) v->resize(bodies);
    for (auto* v : {&free_, &velocity_, &next_, &direction_, &momentum_, &guess_}) v->resize(bodies);
    worst_near_.assign(bodies, 0.0);
    stage_.drives.resize(model.drives.size());
    // find the redundant held rows, with all hinges free
    inertia_.resize(bodies);
    const State s = start();
    locate_all(s, s.pose, 0, rows_, error_.data());
    find_redundant(s.pose);
    redundant_ = system_.redundant();
    redundant_rows_.assign(model.joints.size(), 0);
    for (size_t c = 0; c < connections_.size(); c++) {
        if (is(c, Kind::joint)) redundant_rows_[at(connections_[c].index)] = system_.redundant(c);
    }
}

// sets the links of joints, springs and present contacts, and resizes the arrays of their rows
void Stepper::link_all() {
    while (!connections_.empty() && is(connections_.size() - 1, Kind::contact)) connections_.pop_back();
    std::vector<Link> links;
    for (const Connection& c : connections_) {
        const size_t index = at(c.index);
        if (c.kind == Kind::spring) {
            links.push_back({{model_.springs[index].body[0], model_.springs[index].body[1]}, 0, 1});
        } else {
            const Joint& joint = model_.joints[index];
            links.push_back({{joint.body[0], joint.body[1]}, joint.held, joint.laws});
        }
    }
    for (size_t i = 0; i < contacts_.size(); i++) {
        links.push_back({{contacts_.bodies(i)[0], contacts_.bodies(i)[1]}, 0, static_cast<int>(contacts_.rows())});
        connections_.push_back({Kind::contact, static_cast<int>(i)});
    }
    system_.analyse(model_.bodies.size(), links);
    const size_t n = at(system_.rows());
    tangent_.resize(links.size());
    rows_.resize(n);
    for (auto* v : {&error_, &rate0_, &bias_, &target_, &w_, &w_next_, &impulse_, &x_, &work_}) v->assign(n, 0.0);
    overload_.assign(links.size(), 0.0);
    on_path_.assign(links.size(), 0);
    solved_ = false;
}

State Stepper::start() {
    State s;
    for (const Body& body : model_.bodies) s.pose.push_back({body.centre, {}});
    s.velocity.resize(s.pose.size());
    s.acceleration.resize(s.pose.size());
    s.travel.resize(s.pose.size());
    s.hinge.resize(model_.hinges.size());
    s.rotation.assign(at(component_.back()), 0.0);
    s.turned = s.rotation;
    s.rate.assign(at(component_.back()), 0.0);
    s.joint_force.resize(model_.joints.size());
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            int hint = 0;
            const hinge::Hinge& law = model_.hinges[j].components[at(k)].law;
            s.hinge[j].component[k].capacity = law.scale * law.positive.at(0, hint);
        }
    }
    return s;
}

int Stepper::held_rows() const {
    int held = 0;
    for (const Link& link : system_.links()) held += link.held;
    return held;
}

const SpatialHinge* Stepper::hinge_of(size_t link) const {
    if (!is(link, Kind::joint)) return nullptr;
    const int hinge = hinge_index(link);
    return hinge < 0 ? nullptr : &model_.hinges[at(hinge)];
}

double Stepper::displacement(const Drive& drive, size_t index, const State& s, double t) const {
    const DriveStage& stage = stage_.drives[index];
    if (!stage.acts) return stage.origin;
    return stage.origin + drive.rate.integral_to(t - s.stage_start);
}

Target Stepper::target(const Joint& joint, const State& s, double t) const {
    Target out;
    for (int k = 0; k < 6; k++) {
        if (joint.drive[k] < 0) continue;
        const size_t index = at(joint.drive[k]);
        const Drive& drive = model_.drives[index];
        out.place[k] = displacement(drive, index, s, t);
        out.rate[k] = stage_.drives[index].acts ? drive.rate.at_time(t - s.stage_start) : 0;
    }
    return out;
}

void Stepper::locate_spring(const Spring& spring, const std::vector<Pose>& poses, Row& row, double* length) const {
    const Pose a = model_.pose(poses, spring.body[0]), b = model_.pose(poses, spring.body[1]);
    const Vec3 pa = a.at(spring.arm[0]), pb = b.at(spring.arm[1]), d = pb - pa;
    *length = norm(d);
    const Vec3 t = (*length > 0 ? 1 / *length : 0) * d;
    row = {t, cross(pa - a.x, t), cross(pb - b.x, t)};
}

// rows of all links at the given poses, with the drives of the state's stage at time t
void Stepper::locate_all(const State& s, const std::vector<Pose>& poses, double t, std::vector<Row>& rows, double* error) {
    for (size_t c = 0; c < connections_.size(); c++) {
        const size_t index = at(connections_[c].index), first = at(start(c));
        if (is(c, Kind::spring)) {
            locate_spring(model_.springs[index], poses, rows[first], &error[first]);
            continue;
        }
        if (is(c, Kind::contact)) {
            contacts_.locate(index, poses, &rows[first], &error[first]);
            continue;
        }
        const Joint& joint = model_.joints[index];
        const Pose a = model_.pose(poses, joint.body[0]), b = model_.pose(poses, joint.body[1]);
        double before[most_rows] = {};
        for (int i = 0; i < joint.laws; i++) before[joint.held + i] = s.rotation[at(component_[at(joint.hinge)] + i)];
        Target driven;
        if (joint.driven) driven = target(joint, s, t);
        JointGeometry& g = geometry_[index];
        locate(joint, a, b, joint.driven ? &driven : nullptr, before, g);
        for (int i = 0; i < joint.rows(); i++) {
            rows[first + at(i)] = g.row[i];
            error[first + at(i)] = g.error[i];
        }
    }
}

void Stepper::rates(const std::vector<Row>& rows, const Twist* v, double* out) const {
    const std::vector<Link>& links = system_.links();
    for (size_t c = 0; c < links.size(); c++) {
        const Link& link = links[c];
        const Twist a = link.body[0] < 0 ? Twist{} : v[link.body[0]], b = link.body[1] < 0 ? Twist{} : v[link.body[1]];
        const int first = start(c);
        for (int i = 0; i < link.rows(); i++) out[first + i] = rate(rows[at(first + i)], a, b);
    }
}

void Stepper::set_mobilities(const std::vector<Pose>& poses) {
    const double scale = inertia();
    for (size_t i = 0; i < model_.bodies.size(); i++) {
        const Body& body = model_.bodies[i];
        Mat3 inverse = world(poses[i].q, body.inverse);
        for (Vec3& row : inverse.r) row = (1 / scale) * row;
        system_.set_body(i, 1 / (scale * body.mass), inverse);
        inertia_[i] = world(poses[i].q, body.inertia);
    }
}

// predicts the poses at the middle and the end, and the impulses of gravity and loads
void Stepper::predict(const State& s, double h, const std::vector<Twist>& end) {
    for (size_t i = 0; i < model_.bodies.size(); i++) {
        const Twist mean = 0.5 * (s.velocity[i] + end[i]);
        middle_[i] = moved(s.pose[i], (h / 2) * mean);
        end_[i] = moved(s.pose[i], h * mean);
    }
    for (size_t i = 0; i < model_.bodies.size(); i++) momentum_[i] = {{}, h * model_.bodies[i].mass * model_.gravity};
    for (const Load& load : model_.loads) {
        const double factor = h * load.value.mean(s.t - s.stage_start, h);
        const Vec3 arm = turned(middle_[at(load.body)].q, load.arm);
        Twist& m = momentum_[at(load.body)];
        m = m + factor * Twist{load.moment + cross(arm, load.force), load.force};
    }
}

// V*: accounts for the change of angular momentum between start and end, (I_1 w_1) - (I_0 w_0), with the inertia of the midpoint.  In
// a quasi-static step V* follows from the impulses alone, because drag has no momentum.
void Stepper::set_free(const State& s) {
    for (size_t i = 0; i < free_.size(); i++) {
        if (stage_.quasi_static) {
            free_[i] = system_.mobility(i, momentum_[i]);
            continue;
        }
        const Body& body = model_.bodies[i];
        const Vec3 before = world(s.pose[i].q, body.inertia) * s.velocity[i].w;
        const Vec3 after = world(end_[i].q, body.inertia) * guess_[i].w - inertia_[i] * guess_[i].w;
        free_[i] = system_.mobility(i, {before - after + momentum_[i].w, body.mass * s.velocity[i].v + momentum_[i].v});
    }
}

// finds the redundant held rows at the positions where they have just been located
void Stepper::find_redundant(const std::vector<Pose>& poses) {
    loops_.find(geometry_, poses);
    for (size_t c = 0; c < connections_.size(); c++) {
        for (int i = 0; i < system_.links()[c].held; i++) {
            system_.set_redundant(start(c) + i, loops_.redundant(at(connections_[c].index), i));
        }
    }
}

// sets up the system with held rows only, without laws
void Stepper::hold_rows() {
    for (size_t c = 0; c < connections_.size(); c++) {
        const Link& link = system_.links()[c];
        for (int i = 0; i < link.rows(); i++) system_.row(start(c) + i) = i < link.held ? rows_[at(start(c) + i)] : Row{};
    }
}

// Projects the predicted middle onto the held rows.  Needed if redundant constraints leave mobility only at consistent
// positions: Bricard's mechanism is locked at any other.
void Stepper::project_middle(const State& s, double t) {
    locate_all(s, middle_, t, rows_, error_.data());
    set_mobilities(middle_);
    hold_rows();
    system_.factor();
    for (int pass = 0; pass < 2; pass++) {
        for (size_t c = 0; c < connections_.size(); c++) {
            const Link& link = system_.links()[c];
            for (int i = 0; i < link.rows(); i++) x_[at(start(c) + i)] = i < link.held ? error_[at(start(c) + i)] : 0;
        }
        system_.solve(x_.data(), 1e-12 * model_.length);
        std::fill(direction_.begin(), direction_.end(), Twist{});
        system_.push(x_.data(), direction_.data());
        for (size_t i = 0; i < middle_.size(); i++) middle_[i] = moved(middle_[i], direction_[i]);
        locate_all(s, middle_, t, rows_, error_.data());
    }
}

// sets the bias c of all rows and the target rates of the held rows at the end of the step
void Stepper::aim(const State& s, double h) {
    rates(rows_, s.velocity.data(), bias_.data());
    for (size_t k = 0; k < bias_.size(); k++) bias_[k] -= rate0_[k];
    std::fill(target_.begin(), target_.end(), 0.0);
    allow_closing(h);
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!is(c, Kind::joint)) continue;
        const size_t index = at(connections_[c].index);
        const Joint& joint = model_.joints[index];
        if (!joint.driven) continue;
        Target end = target(joint, s, s.t + h);
        if (stage_.quasi_static) {
            // from rest: twice the mean rate
            const Target begin = target(joint, s, s.t);
            for (int k = 0; k < 6; k++) end.rate[k] = 2 * (end.place[k] - begin.place[k]) / h;
        }
        const Pose a = model_.pose(middle_, joint.body[0]);
        for (int i = 0; i < joint.held; i++) target_[at(start(c) + i)] = target_rate(joint, a, geometry_[index], end, i);
    }
}

// mobility: rate along a row for a unit impulse along it, with both bodies free
double Stepper::mobility(size_t link, const Row& row) const {
    double sum = 0;
    for (int side = 0; side < 2; side++) {
        const int body = system_.links()[link].body[side];
        if (body < 0) continue;
        const Vec3 m = side == 0 ? row.ma : row.mb;
        const Twist u = system_.mobility(at(body), {m, row.t});
        sum += dot(row.t, u.v) + dot(m, u.w);
    }
    return sum;
}

void Stepper::freeze(const State& s, double h) {
    for (size_t c = 0; c < connections_.size(); c++) {
        const size_t index = at(connections_[c].index), first = at(start(c));
        if (is(c, Kind::contact)) {
            // stiff relative to the true inertia
            contacts_.freeze(index, inertia() * mobility(c, rows_[first]), h);
            continue;
        }
        if (is(c, Kind::spring)) {
            const Spring& spring = model_.springs[index];
            Row row;
            double length = 0;
            locate_spring(spring, s.pose, row, &length);
            const double weight = spring.damping > 0 ? end_weight(h * spring.damping * mobility(c, rows_[first])) : 1;
            spring_weight_[index] = weight;
            spring_force_[index] = h * (spring.stiffness * (length - spring.length + h * rate0_[first] / 4) +
                                        spring.damping * (1 - weight) * rate0_[first]);
            spring_tangent_[index] = h * (spring.stiffness * h / 4 + spring.damping * weight);
            continue;
        }
        const int hinge = hinge_index(c);
        if (hinge < 0) continue;
        const size_t held = at(system_.links()[c].held), k = at(component_[at(hinge)]);
        frozen_[at(hinge)] = spatial::freeze(model_.hinges[at(hinge)], s.hinge[at(hinge)], h, &s.turned[k], &rate0_[first + held],
                                           &w_[first + held]);
        spatial::widen(model_.hinges[at(hinge)], frozen_[at(hinge)], least_width(model_.hinges[at(hinge)]));
        // one reversal is enough: a hinge that reverses in one pass and slides on in the next would alternate forever
        if (turned_back_[at(hinge)]) frozen_[at(hinge)].lead = 0;
    }
}

bool Stepper::step(State& s, double h, const std::vector<Twist>* guess) {
    length_ = h;
    last_solve_ = solves_ + most_solves * newton_steps();
    guess_ = guess ? *guess : s.velocity;
    speed_ = 0;
    for (size_t i = 0; i < s.velocity.size(); i++) {
        speed_ = std::max({speed_, norm(s.velocity[i].v), norm(s.velocity[i].w) * model_.length, norm(guess_[i].v)});
    }
    double gain = h * norm(model_.gravity);
    for (size_t i = 0; i < guess_.size(); i++) gain = std::max(gain, norm(guess_[i].v - s.velocity[i].v));
    if (contacts_.gather(s.pose, s.velocity, h, gain, s.contact)) link_all();
    unbounded_ = s.contact.impact ? -unreached * speed_ : 0;
    allowed_.assign(contacts_.size(), 0.0);
    // true rates at the start
    locate_all(s, s.pose, s.t, rows_, error_.data());
    rates(rows_, s.velocity.data(), rate0_.data());
    find_redundant(s.pose);
    turned_back_.assign(frozen_.size(), false);
    if (!guess) {
        kept_mu_ = 0;
        full_steps_ = true;
    }
    // a guess is the result of a step that has just been solved
    solved_ = solved_ && guess;
    bool settled = true;
    for (int pass = guess ? 1 : 0; pass < passes || (!settled && pass < most_passes); pass++) {
        // predict the middle of the step: positions and loads
        predict(s, h, guess_);
        if (redundant_ > 0 || system_.redundant() > 0) project_middle(s, s.t + h / 2);
        set_mobilities(middle_);
        set_free(s);
        // locate the rows there, and set their target rates
        locate_all(s, middle_, s.t + h / 2, rows_, error_.data());
        aim(s, h);
        w_.swap(w_next_);
        rates(rows_, guess_.data(), w_.data());
        for (size_t k = 0; k < w_.size(); k++) w_[k] += bias_[k];
        // freeze capacities, rate factors and stops
        freeze(s, h);
        // solve for the end velocities
        keep_locked();
        solved_ = followed_ ? follow_pass() : newton();
        if (!solved_) return false;
        settled = settle();
        settled = !turned_back() && settled;
        if (kept_) keep_pass(settled);
        if (followed_) settled = (*followed_)[next_pass_++].settled;
        guess_ = velocity_;
    }
    return commit(s, h);
}

}  // namespace crumple::spatial
