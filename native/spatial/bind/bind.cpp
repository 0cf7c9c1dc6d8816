// Python interface of the spatial kernel: conversion of plain values, no physics.
#include <nanobind/stl/function.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "hinge/bind_hinge.hpp"
#include "spatial/bind/bind_contact.hpp"
#include "spatial/bind/bind_hinge.hpp"
#include "spatial/bind/bind_model.hpp"
#include "spatial/run/simulation.hpp"

namespace nb = nanobind;

namespace crumple::spatial {

namespace {

using hinge::Doubles;
using hinge::make_curve;

Vec3 vector(const double* v) { return {v[0], v[1], v[2]}; }

Vec3 vector(nb::handle h) {
    const Doubles v = as<Doubles>(h, "a list of numbers");
    require(v.size() == 3, "a vector has three components");
    return vector(v.data());
}

// body's centre at the start; the origin for the ground
Vec3 centre(const Model& model, int body) { return body < 0 ? Vec3{} : model.bodies[static_cast<size_t>(body)].centre; }

void require_body(const Model& model, int body, bool ground) {
    require(body >= (ground ? -1 : 0) && body < static_cast<int>(model.bodies.size()), "a body is unknown");
}

void add_bodies(Model& model, const nb::dict& d) {
    const auto mass = entry<In>(d, "mass"), inertia = entry<In>(d, "inertia"), place = entry<In>(d, "centre");
    const size_t n = mass.size();
    require(inertia.size() == 9 * n && place.size() == 3 * n, "every body has a mass, an inertia (3, 3) and a centre (3)");
    for (size_t i = 0; i < n; i++) {
        const double* j = inertia.data() + 9 * i;
        Body body;
        body.mass = mass.data()[i];
        body.inertia = {{vector(j), vector(j + 3), vector(j + 6)}};
        const Vec3 *r = body.inertia.r, minor = cross(r[0], r[1]);
        require(body.mass > 0 && r[0].x > 0 && minor.z > 0 && dot(minor, r[2]) > 0, "mass and inertia must be positive");
        body.inverse = inverse(body.inertia);
        body.centre = vector(place.data() + 3 * i);
        model.bodies.push_back(body);
    }
}

void add_joint(Model& model, const nb::tuple& t) {
    Joint joint;
    const Vec3 place = vector(t[2]);
    for (int k = 0; k < 2; k++) {
        joint.body[k] = entry<int>(t, k);
        require_body(model, joint.body[k], true);
        joint.arm[k] = place - centre(model, joint.body[k]);
    }
    require(joint.body[0] != joint.body[1], "a joint needs two bodies");
    const Doubles axes = entry<Doubles>(t, 3);
    require(axes.size() == 9, "axes must have shape (3, 3)");
    const Mat3 rows = {{vector(axes.data()), vector(axes.data() + 3), vector(axes.data() + 6)}};
    double skew = std::fabs(dot(cross(rows.r[0], rows.r[1]), rows.r[2]) - 1);
    for (const Vec3& row : rows.r) skew = std::max(skew, std::fabs(dot(row, row) - 1));
    require(skew < 1e-6, "axes must be right-handed unit vectors at right angles");
    joint.axes = quaternion(transposed(rows));
    const auto held = entry<std::vector<bool>>(t, 4);
    require(held.size() == 6, "a joint has six freedoms");
    int turns = 0;
    for (int k = 0; k < 6; k++) {
        if (!held[static_cast<size_t>(k)]) continue;
        joint.freedom[joint.held++] = k;
        if (k >= 3) turns++;
        else joint.slotted = joint.slotted || !held[0] || !held[1] || !held[2];
    }
    joint.cross = entry<bool>(t, 5);
    require(!joint.cross || turns == 1, "a joint with a cross holds one rotation");
    model.joints.push_back(joint);
}

// whether a freedom is among a joint's first rows
bool has(const Joint& joint, int rows, int freedom) {
    return std::find(joint.freedom, joint.freedom + rows, freedom) != joint.freedom + rows;
}

void add_hinge(Model& model, const nb::dict& d) {
    const int index = entry<int>(d, "joint");
    require(index >= 0 && index < static_cast<int>(model.joints.size()), "a hinge names an unknown joint");
    Joint& joint = model.joints[static_cast<size_t>(index)];
    require(joint.hinge < 0, "a joint has one hinge at most");
    const SpatialHinge hinge = make_hinge(d);
    for (const Component& c : hinge.components) {
        require(!has(joint, joint.rows(), c.freedom), "a hinge needs freedoms that are not held");
        joint.freedom[joint.held + joint.laws++] = c.freedom;
        // a slip is small: its direction is that of the middle frame
        if (c.freedom < 3) joint.slotted = false;
    }
    joint.hinge = static_cast<int>(model.hinges.size());
    model.hinges.push_back(hinge);
    model.hinge_joint.push_back(index);
}

void add_drive(Model& model, const nb::tuple& t) {
    const int index = entry<int>(t, 0), freedom = entry<int>(t, 1);
    require(index >= 0 && index < static_cast<int>(model.joints.size()), "a drive names an unknown joint");
    Joint& joint = model.joints[static_cast<size_t>(index)];
    require(has(joint, joint.held, freedom), "a driven freedom must be held");
    joint.drive[freedom] = static_cast<int>(model.drives.size());
    joint.driven = true;
    joint.slotted = joint.slotted || freedom < 3;
    model.drives.push_back({index, freedom, entry<double>(t, 4), make_curve(entry<Doubles>(t, 2), entry<Doubles>(t, 3))});
}

void add_cam(Model& model, const nb::tuple& t) {
    const int index = entry<int>(t, 0), freedom = entry<int>(t, 1), about = entry<int>(t, 2);
    require(index >= 0 && index < static_cast<int>(model.joints.size()), "a cam names an unknown joint");
    Joint& joint = model.joints[static_cast<size_t>(index)];
    require(freedom < 3 && has(joint, joint.held, freedom), "a cam moves a held translation");
    require(about >= 3 && about < 6 && !has(joint, joint.rows(), about), "a cam follows a free rotation");
    require(joint.cam.freedom < 0, "a joint has one cam at most");
    joint.cam = {freedom, about, make_curve(entry<Doubles>(t, 3), entry<Doubles>(t, 4))};
}

void add_load(Model& model, const nb::tuple& t) {
    const int body = entry<int>(t, 0);
    require_body(model, body, false);
    const Curve value = make_curve(entry<Doubles>(t, 4), entry<Doubles>(t, 5));
    model.loads.push_back({body, vector(t[1]) - centre(model, body), vector(t[2]), vector(t[3]), value});
}

void add_spring(Model& model, const nb::tuple& t) {
    Spring s;
    for (int k = 0; k < 2; k++) {
        s.body[k] = entry<int>(t, k);
        require_body(model, s.body[k], true);
        s.arm[k] = vector(t[2 + k]) - centre(model, s.body[k]);
    }
    require(s.body[0] != s.body[1], "a spring needs two bodies");
    s.stiffness = entry<double>(t, 4);
    s.length = entry<double>(t, 5);
    s.damping = entry<double>(t, 6);
    require(s.stiffness >= 0 && s.damping >= 0, "stiffness and damping must not be negative");
    model.springs.push_back(s);
}

void add_folds(Capsule& capsule, const nb::list& folds, Vec3 centre) {
    require(folds.size() <= 2, "a capsule has a fold at each end at most");
    for (size_t k = 0; k < folds.size(); k++) {
        const nb::tuple t = fields(folds[k], 2, "a fold has its middle and half of its length");
        capsule.folds[k] = {vector(t[0]) - centre, entry<double>(t, 1)};
        require(capsule.folds[k].half_length > 0, "the length of a fold must be positive");
    }
}

void add_contact(Model& model, const nb::dict& d) {
    ContactModel& contact = model.contact;
    for (nb::handle h : entry<nb::list>(d, "capsules")) {
        const nb::tuple t = fields(h, 6, "a capsule has body, two ends, radius, crush force, folds");
        const int body = entry<int>(t, 0);
        require_body(model, body, true);
        const Vec3 c = centre(model, body);
        const double radius = entry<double>(t, 3);
        require(radius >= 0, "the radius of a capsule must not be negative");
        const double crush_force = entry<double>(t, 4);
        require(crush_force > 0, "the crush force of a capsule must be positive");
        contact.capsules.push_back({body, {vector(t[1]) - c, vector(t[2]) - c, radius}, crush_force, {}});
        add_folds(contact.capsules.back(), entry<nb::list>(t, 5), c);
    }
    const int capsules = static_cast<int>(contact.capsules.size());
    for (nb::handle h : entry<nb::list>(d, "obstacles")) {
        const nb::dict o = as<nb::dict>(h, "an obstacle");
        Obstacle obstacle;
        obstacle.body = entry<int>(o, "body");
        require_body(model, obstacle.body, true);
        obstacle.solid = make_solid(o);
        obstacle.solid.point = obstacle.solid.point - centre(model, obstacle.body);
        if (obstacle.body >= 0) model.bodies[static_cast<size_t>(obstacle.body)].obstacle = true;
        obstacle.law = {entry<double>(o, "friction"), entry<double>(o, "restitution")};
        if (o["capsules"].is_none()) {
            for (int c = 0; c < capsules; c++) {
                if (contact.capsules[static_cast<size_t>(c)].body != obstacle.body) obstacle.capsules.push_back(c);
            }
        } else {
            obstacle.capsules = entry<std::vector<int>>(o, "capsules");
        }
        for (const int c : obstacle.capsules) require(c >= 0 && c < capsules, "an obstacle names an unknown capsule");
        obstacle.ends.assign(obstacle.capsules.size(), both_ends);
        if (!o["ends"].is_none()) obstacle.ends = entry<std::vector<int>>(o, "ends");
        require(obstacle.ends.size() == obstacle.capsules.size(), "an obstacle has ends for each of its capsules");
        contact.obstacles.push_back(obstacle);
    }
    for (nb::handle h : entry<nb::list>(d, "pairs")) {
        const auto pair = as<std::vector<int>>(h, "a pair of 'pairs'");
        for (const int c : {pair.at(0), pair.at(1)}) require(c >= 0 && c < capsules, "a pair names an unknown capsule");
        require(pair.size() == 2 && pair[0] != pair[1], "a capsule does not touch itself");
        contact.pairs.push_back({pair[0], pair[1]});
    }
    for (const Joint& joint : model.joints) {
        if (!joint.driven || joint.body[1] < 0) continue;
        Body& body = model.bodies[static_cast<size_t>(joint.body[1])];
        body.stand_in = body.obstacle;
    }
    const auto between = entry<std::pair<double, double>>(d, "contact");
    contact.between = {between.first, between.second};
}

}  // namespace

Model make_model(const nb::dict& d) {
    Model model;
    add_bodies(model, d);
    for (nb::handle h : entry<nb::list>(d, "joints")) {
        add_joint(model, fields(h, 6, "a joint has two bodies, place, axes, held freedoms, cross"));
    }
    for (nb::handle h : entry<nb::list>(d, "hinges")) add_hinge(model, as<nb::dict>(h, "a hinge"));
    for (nb::handle h : entry<nb::list>(d, "drives")) {
        add_drive(model, fields(h, 5, "a drive has joint, freedom, times, rates, start"));
    }
    for (nb::handle h : entry<nb::list>(d, "cams")) {
        add_cam(model, fields(h, 5, "a cam has joint, translation, rotation, angles, slopes"));
    }
    for (nb::handle h : entry<nb::list>(d, "loads")) {
        add_load(model, fields(h, 6, "a load has body, point, force, moment, times, values"));
    }
    for (nb::handle h : entry<nb::list>(d, "springs")) {
        add_spring(model, fields(h, 7, "a spring has two bodies, two points, stiffness, length, damping"));
    }
    add_contact(model, d);
    model.gravity = vector(d["gravity"]);
    model.length = entry<double>(d, "length");
    require_finite({model.gravity.x, model.gravity.y, model.gravity.z}, "gravity must be finite");
    require(model.length > 0 && std::isfinite(model.length), "the length must be positive");
    model.resolved_frequency = entry<double>(d, "resolved_frequency");
    require(model.resolved_frequency > 0, "the resolved frequency must be positive");
    model.breaks = entry<Doubles>(d, "breaks");
    require_breaks(model.breaks);
    return model;
}

Condition make_condition(const Model& model, nb::handle given) {
    const nb::tuple t = fields(given, 6, "a condition has kind, value, index, freedom, bodies, points");
    Condition c;
    const int kind = entry<int>(t, 0);
    require(kind >= 0 && kind <= static_cast<int>(Quantity::displacement), "unknown condition");
    c.quantity = static_cast<Quantity>(kind);
    c.value = entry<double>(t, 1);
    require(std::isfinite(c.value), "the value of a condition is finite");
    c.index = entry<int>(t, 2);
    c.freedom = entry<int>(t, 3);
    const auto bodies = entry<std::vector<int>>(t, 4);
    const auto points = entry<nb::list>(t, 5);
    require(bodies.size() == 2 && points.size() == 2, "a condition has two bodies and a point of each");
    for (size_t k = 0; k < 2; k++) {
        c.body[k] = bodies[k];
        require_body(model, c.body[k], true);
        c.arm[k] = vector(points[k]);
    }
    if (c.quantity == Quantity::force) {
        require(c.index >= 0 && c.index < static_cast<int>(model.contact.obstacles.size()), "a condition names an unknown obstacle");
    }
    if (c.quantity == Quantity::drive_force || c.quantity == Quantity::displacement) {
        require(c.index >= 0 && c.index < static_cast<int>(model.joints.size()), "a condition names an unknown joint");
        require(c.freedom >= 0 && c.freedom < 6, "a freedom is one of six");
    }
    return c;
}

std::vector<bool> chosen(const std::vector<int>& indices, size_t n, const char* unknown) {
    std::vector<bool> out(n);
    for (const int k : indices) {
        require(k >= 0 && static_cast<size_t>(k) < n, unknown);
        out[static_cast<size_t>(k)] = true;
    }
    return out;
}

namespace {

std::vector<Twist> to_twists(const In& a, size_t bodies) {
    require(a.ndim() == 2 && a.shape(0) == bodies && a.shape(1) == 6, "motions must have shape (bodies, 6)");
    std::vector<Twist> out;
    for (size_t i = 0; i < bodies; i++) out.push_back({vector(a.data() + 6 * i), vector(a.data() + 6 * i + 3)});
    return out;
}

nb::dict to_dict(const Simulation& sim, const Record& r) {
    const Model& m = sim.model();
    const size_t n = r.time.size(), bodies = m.bodies.size(), c = sim.components();
    nb::dict d;
    d["time"] = to_array(r.time, {n});
    d["centre"] = to_array(r.centre, {n, bodies, 3});
    d["rotation"] = to_array(r.rotation, {n, bodies, 4});
    d["velocity"] = to_array(r.velocity, {n, bodies, 6});
    d["acceleration"] = to_array(r.acceleration, {n, bodies, 6});
    d["travel"] = to_array(r.travel, {n, bodies, 6});
    d["step"] = to_array(r.step, {n});
    d["hinge"] = columns(r.hinge, {n, c});
    d["hinge_energy"] = columns(r.hinge_energy, {n, m.hinges.size()});
    d["joint_force"] = to_array(r.joint_force, {n, m.joints.size(), 6});
    d["obstacle_force"] = to_array(r.obstacle_force, {n, m.contact.obstacles.size(), 3});
    d["energy"] = columns(r.energy, {n});
    std::vector<double> along;
    for (const SpatialHingeState& s : sim.state().hinge) along.insert(along.end(), {s.most_pressed, s.most_pulled});
    d["axial_most"] = to_array(along, {m.hinges.size(), 2});
    d["summary"] = columns(sim.summary(), {m.hinges.size()});
    d["outcome"] = static_cast<int>(r.outcome);
    d["reason"] = r.reason;
    d["ended_by"] = r.ended_by;
    d["lost_time"] = r.lost_time;
    d["stuck_body"] = r.stuck_body;
    d["residual"] = r.residual;
    d["unseen"] = r.unseen;
    d["steps"] = r.steps;
    d["rejected"] = r.rejected;
    d["forced"] = r.forced;
    d["solves"] = r.solves;
    return d;
}

void stage(Simulation& sim, bool quasi_static, const std::vector<int>& drives, const std::vector<int>& obstacles,
           const nb::list& until) {
    const std::vector<bool> acting = chosen(drives, sim.model().drives.size(), "a drive is unknown");
    const std::vector<bool> present = chosen(obstacles, sim.model().contact.obstacles.size(), "an obstacle is unknown");
    std::vector<Condition> conditions;
    for (nb::handle h : until) conditions.push_back(make_condition(sim.model(), h));
    sim.begin_stage(quasi_static, acting, present, conditions);
}

nb::dict run(Simulation& sim, const Doubles& times, nb::object poll) {
    require_times(times, sim.state().t);
    return to_dict(sim, unlocked(poll, [&](const auto& ask) { return sim.run(times, ask); }));
}

double set_motion(Simulation& s, const In& velocity, const In& impulse) {
    const size_t n = s.model().bodies.size();
    return s.set_motion(to_twists(velocity, n).data(), to_twists(impulse, n).data());
}

bool step(Simulation& s, double h) {
    require_step(h);
    return s.step(h);
}

nb::list crushed(Simulation& s) {
    nb::list out;
    for (const Contacts::Crushed& c : s.stepper().contacts().crushed(s.state().contact)) {
        out.append(nb::make_tuple(c.obstacle, c.first, c.second, c.depth));
    }
    return out;
}

std::pair<int, int> freedoms(Simulation& s) {
    const int held = s.stepper().held_rows(), redundant = s.stepper().redundant();
    return {6 * static_cast<int>(s.model().bodies.size()) - held + redundant, redundant};
}

}  // namespace

void bind(nb::module_& m) {
    using Run = Used<Simulation>;
    nb::class_<Guide>(m, "Guide", "The steps of a run, with which runs of similar models start theirs.");
    nb::class_<Run>(m, "Simulation", "One run: a frozen model, its state, and the adaptive stepper.")
        .def("__init__",
             [](Run* self, const nb::dict& model, double accuracy, double minimum_step, double maximum_step, int parts) {
                 require_settings(accuracy, minimum_step, maximum_step, parts);
                 new (self) Run(make_model(model), Settings{accuracy, minimum_step, maximum_step, parts});
             },
             nb::arg("model"), nb::arg("accuracy"), nb::arg("minimum_step"), nb::arg("maximum_step"), nb::arg("parts") = 1)
        .def("set_motion", alone(&set_motion))
        .def("stage", alone(&stage))
        .def("run", alone(&run), nb::arg("times"), nb::arg("poll") = nb::none())
        .def("step", alone(&step))
        .def("keep_guide", alone(+[](Simulation& s) { s.keep_guide(); }))
        .def("guide", alone(+[](Simulation& s) { return s.guide(); }))
        .def("be_guided_by", alone(+[](Simulation& s, std::shared_ptr<Guide> lead, bool pairs) {
                 s.be_guided_by(pairs ? std::make_shared<Guide>(in_pairs(std::move(lead))) : std::move(lead));
             }))
        .def("crushed", alone(&crushed))
        .def("freedoms", alone(&freedoms))
        .def("redundant", alone(+[](Simulation& s) { return s.stepper().redundant_rows(); }))
        .def_prop_ro("time", alone(+[](Simulation& s) { return s.state().t; }));
}

}  // namespace crumple::spatial
