#include "spatial/solve/problem.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Share of critical damping that steps beside contacts give a vibration of the resolved frequency, and the largest change of the weight: it
// leaves 0.92 of a vibration that is far too fast for the step.
constexpr double damping_beside_contact = 2e-3, most_beside_contact = 0.02;
constexpr double pi = 3.14159265358979323846;

size_t at(int i) { return static_cast<size_t>(i); }

Mat3 world(const Quat& q, const Mat3& m) {
    const Mat3 r = matrix(q);
    return r * m * transposed(r);
}

}  // namespace

Problem::Problem(const Model& of) : model(of), contacts(of.contact), hinge_link(of.hinges.size()) {
    for (size_t j = 0; j < model.joints.size(); j++) {
        const Joint& joint = model.joints[j];
        if (joint.rows() == 0) continue;
        if (joint.hinge >= 0) hinge_link[at(joint.hinge)] = connections.size();
        connections.push_back({Kind::joint, static_cast<int>(j)});
    }
    for (size_t k = 0; k < model.springs.size(); k++) connections.push_back({Kind::spring, static_cast<int>(k)});
    link_all();
    int components = 0;
    for (const SpatialHinge& hinge : model.hinges) {
        component.push_back(components);
        components += size(hinge);
        const Form form = hinge.components.front().law.form;
        all_set_valued = all_set_valued && form == Form::set_valued;
        elastic = elastic || form == Form::elastic_plastic;
    }
    component.push_back(components);
    const size_t bodies = model.bodies.size();
    frozen.resize(model.hinges.size());
    for (auto* v : {&spring_force, &spring_tangent, &spring_weight}) v->assign(model.springs.size(), 0.0);
    geometry.resize(model.joints.size());
    for (auto* v : {&middle, &end}) v->resize(bodies);
    for (auto* v : {&free, &velocity}) v->resize(bodies);
    stage.drives.resize(model.drives.size());
    inertia.resize(bodies);
}

void Problem::link_all() {
    while (!connections.empty() && is_contact(connections.size() - 1)) connections.pop_back();
    std::vector<Link> links;
    for (const Connection& c : connections) {
        const size_t index = at(c.index);
        if (c.kind == Kind::spring) {
            links.push_back({{model.springs[index].body[0], model.springs[index].body[1]}, 0, 1});
        } else {
            const Joint& joint = model.joints[index];
            links.push_back({{joint.body[0], joint.body[1]}, joint.held, joint.laws});
        }
    }
    for (size_t i = 0; i < contacts.size(); i++) {
        links.push_back({{contacts.bodies(i)[0], contacts.bodies(i)[1]}, 0, static_cast<int>(contacts.rows())});
        connections.push_back({Kind::contact, static_cast<int>(i)});
    }
    system.analyse(model.bodies.size(), links);
    const size_t n = at(system.rows());
    tangent.resize(links.size());
    rows.resize(n);
    for (auto* v : {&error, &rate0, &bias, &target, &w, &w_next, &impulse, &x}) v->assign(n, 0.0);
}

const SpatialHinge* Problem::hinge_of(size_t link) const {
    if (!is_joint(link)) return nullptr;
    const int hinge = hinge_index(link);
    return hinge < 0 ? nullptr : &model.hinges[at(hinge)];
}

double Problem::mobility(size_t link, const Row& row) const {
    double sum = 0;
    for (int side = 0; side < 2; side++) {
        const int body = system.links()[link].body[side];
        if (body < 0) continue;
        const Vec3 m = side == 0 ? row.ma : row.mb;
        const Twist u = system.mobility(at(body), {m, row.t});
        sum += dot(row.t, u.v) + dot(m, u.w);
    }
    return sum;
}

void Problem::set_mobilities(const std::vector<Pose>& poses) {
    const double scale = inertia_share();
    for (size_t i = 0; i < model.bodies.size(); i++) {
        const Body& body = model.bodies[i];
        Mat3 inverse = world(poses[i].q, body.inverse);
        for (Vec3& row : inverse.r) row = (1 / scale) * row;
        system.set_body(i, 1 / (scale * body.mass), inverse);
        inertia[i] = world(poses[i].q, body.inertia);
    }
}

void Problem::locate_spring(const Spring& spring, const std::vector<Pose>& poses, Row& row, double* length) const {
    const Pose a = model.pose(poses, spring.body[0]), b = model.pose(poses, spring.body[1]);
    const Vec3 pa = a.at(spring.arm[0]), pb = b.at(spring.arm[1]), d = pb - pa;
    *length = norm(d);
    const Vec3 t = (*length > 0 ? 1 / *length : 0) * d;
    row = {t, cross(pa - a.x, t), cross(pb - b.x, t)};
}

void Problem::locate_all(const State& s, const std::vector<Pose>& poses, double t, std::vector<Row>& rows, double* error) {
    for (size_t c = 0; c < connections.size(); c++) {
        const size_t index = at(connections[c].index), first = at(start(c));
        if (is_spring(c)) {
            locate_spring(model.springs[index], poses, rows[first], &error[first]);
            continue;
        }
        if (is_contact(c)) {
            contacts.locate(index, poses, &rows[first], &error[first]);
            continue;
        }
        const Joint& joint = model.joints[index];
        const Pose a = model.pose(poses, joint.body[0]), b = model.pose(poses, joint.body[1]);
        double before[most_rows] = {};
        for (int i = 0; i < joint.laws; i++) before[joint.held + i] = s.rotation[at(component[at(joint.hinge)] + i)];
        Target driven;
        if (joint.driven) driven = target_of(joint, s, t);
        JointGeometry& g = geometry[index];
        locate(joint, a, b, joint.driven ? &driven : nullptr, before, g);
        for (int i = 0; i < joint.rows(); i++) {
            rows[first + at(i)] = g.row[i];
            error[first + at(i)] = g.error[i];
        }
    }
}

void Problem::assemble() {
    system.assemble(rows);
    for (size_t c = 0; c < connections.size(); c++) {
        if (system.links()[c].laws > 0) system.set_tangent(c, tangent[c].vectors, tangent[c].root);
    }
}

void Problem::hold_rows() {
    system.assemble(rows);
    system.free_laws();
    system.factor();
}

void Problem::rates(const std::vector<Row>& rows, const Twist* v, double* out) const {
    const std::vector<Link>& links = system.links();
    for (size_t c = 0; c < links.size(); c++) {
        const Link& link = links[c];
        const Twist a = link.body[0] < 0 ? Twist{} : v[link.body[0]], b = link.body[1] < 0 ? Twist{} : v[link.body[1]];
        const int first = start(c);
        for (int i = 0; i < link.rows(); i++) out[first + i] = rate(rows[at(first + i)], a, b);
    }
}

double Problem::displacement(const Drive& drive, size_t index, const State& s, double t) const {
    const DriveStage& driven = stage.drives[index];
    if (!driven.acts) return driven.origin;
    return driven.origin + drive.rate.integral_to(t - s.stage_start);
}

Target Problem::target_of(const Joint& joint, const State& s, double t) const {
    Target out;
    for (int k = 0; k < 6; k++) {
        if (joint.drive[k] < 0) continue;
        const size_t index = at(joint.drive[k]);
        const Drive& drive = model.drives[index];
        out.place[k] = displacement(drive, index, s, t);
        out.rate[k] = stage.drives[index].acts ? drive.rate.at_time(t - s.stage_start) : 0;
    }
    return out;
}

// All vibration that is too fast for the step reverses its sign in every step, whatever its frequency, so that the friction of a contact can
// feed one by another: the contact sticks, slips and opens in turns, in ever shorter steps.  With the weight 1/2 + d a vibration of circular
// frequency w has d w h/2 of critical damping.
double Problem::elastic_weight(double h) const {
    if (stage.quasi_static || contacts.size() == 0) return end_weight();
    return 0.5 + std::min(most_beside_contact, damping_beside_contact / (pi * model.resolved_frequency * h));
}

double Problem::factor_of(const Load& load, const State& s, double h) const {
    const double since = s.t - s.stage_start;
    if (!stage.quasi_static || !elastic) return load.value.mean(since, h);
    return (1 - end_weight()) * load.value.at_time(since) + end_weight() * load.value.at_time(since + h);
}

void Problem::respond(size_t link, const double* w, double* impulse, double* tangent) const {
    const size_t index = at(connections[link].index);
    if (is_contact(link)) return spatial::respond(contacts.frozen(index), contacts.rows(), w, impulse, tangent, nullptr);
    if (is_spring(link)) {
        impulse[0] = spring_force[index] + spring_tangent[index] * w[0];
        if (tangent) tangent[0] = spring_tangent[index];
        return;
    }
    const size_t hinge = at(hinge_index(link));
    spatial::respond(model.hinges[hinge], frozen[hinge], w, impulse, tangent, nullptr);
}

double Problem::load(size_t link, const double* w) const {
    if (!is_joint(link)) return 0;
    const size_t hinge = at(hinge_index(link));
    return load_factor(model.hinges[hinge], frozen[hinge], w);
}

void Problem::seen_rate(size_t link, const double* w, double* seen) const {
    const int n = system.links()[link].laws;
    const FrozenSpatialHinge* f = hinge_of(link) ? &frozen[at(hinge_index(link))] : nullptr;
    const double lead = f ? f->lead : 0;
    for (int k = 0; k < n; k++) seen[k] = lead > 0 ? lead * f->w0[k] + (1 - lead) * w[k] : w[k];
}

void Problem::scale_rate(size_t link, double factor, double* w) const {
    const int n = system.links()[link].laws;
    double seen[most_components];
    seen_rate(link, w, seen);
    const FrozenSpatialHinge* f = hinge_of(link) ? &frozen[at(hinge_index(link))] : nullptr;
    const double lead = f ? f->lead : 0;
    for (int k = 0; k < n; k++) w[k] = lead > 0 ? (factor * seen[k] - lead * f->w0[k]) / (1 - lead) : factor * w[k];
}

}  // namespace crumple::spatial
