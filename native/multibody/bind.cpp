// Python face of the multibody kernels.  Arrays come in as plain NumPy; nothing here decides physics.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstring>
#include <memory>

#include "multibody/simulation.hpp"

namespace nb = nanobind;

namespace crumple::multibody {

namespace {

using Array = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Integers = nb::ndarray<const int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Doubles = std::vector<double>;

void require(bool ok, const char* what) {
    if (!ok) throw nb::value_error(what);
}

// bodies: columns anchor x, y, centre x, y, mass, inertia
Tree make_tree(const Integers& parent, const Integers& joint, const Array& bodies) {
    require(bodies.ndim() == 2 && bodies.shape(1) == 6, "bodies must have shape (n, 6)");
    const size_t n = bodies.shape(0);
    require(parent.shape(0) == n && joint.shape(0) == n, "parent and joint must have one entry per body");
    std::vector<Body> out(n);
    for (size_t i = 0; i < n; i++) {
        const double* b = bodies.data() + 6 * i;
        const auto p = static_cast<int>(parent.data()[i]);
        require(p >= -1 && p < static_cast<int>(i), "a parent must come before its children");
        const Joint kind = joint.data()[i] == 0 ? Joint::revolute : Joint::free;
        require(kind == Joint::revolute || p == -1, "a free joint must hang on the ground");
        require(b[4] > 0 && b[5] > 0, "mass and inertia must be positive");
        out[i] = {p, kind, 0, {b[0], b[1]}, {b[2], b[3]}, b[4], b[5]};
    }
    return Tree(std::move(out));
}

Curve make_curve(const Doubles& x, const Doubles& y) {
    require(!x.empty() && x.size() == y.size(), "a curve needs as many values as places, at least one");
    for (size_t i = 1; i < x.size(); i++) require(x[i] > x[i - 1], "the places of a curve must increase");
    return Curve(x, y);
}

Hinge make_hinge(const nb::dict& d) {
    Hinge h;
    auto number = [&](const char* key) { return nb::cast<double>(d[key]); };
    auto numbers = [&](const char* key) { return nb::cast<Doubles>(d[key]); };
    h.dof = nb::cast<int>(d["dof"]);
    h.form = static_cast<Form>(nb::cast<int>(d["form"]));
    h.softening = static_cast<Softening>(nb::cast<int>(d["softening"]));
    h.positive = make_curve(numbers("positive_rotation"), numbers("positive_moment"));
    h.negative = make_curve(numbers("negative_rotation"), numbers("negative_moment"));
    h.stiffness = number("elastic_stiffness");
    h.ramp_rate = number("regularisation_rate");
    h.rate_reference = number("rate_reference");
    h.rate_exponent = number("rate_exponent");
    h.damping = number("viscous_damping");
    const char* keys[2] = {"stop_positive", "stop_negative"};
    for (int k = 0; k < 2; k++) {
        const Doubles s = numbers(keys[k]);  // empty: no stop
        if (s.empty()) continue;
        require(s.size() == 5, "a stop has rotation, stiffness, exponent, damping, penetration");
        h.stop[k] = {s[0], s[1], s[2], s[3], s[4]};
    }
    return h;
}

Load make_load(const nb::tuple& t) {
    const Doubles at = nb::cast<Doubles>(t[1]), along = nb::cast<Doubles>(t[2]);
    return {nb::cast<int>(t[0]), {at.at(0), at.at(1)}, {along.at(0), {along.at(1), along.at(2)}},
            make_curve(nb::cast<Doubles>(t[3]), nb::cast<Doubles>(t[4]))};
}

Drive make_drive(const nb::tuple& t) {
    const Load load = make_load(t);
    const double start = nb::cast<Doubles>(t[4]).at(0);
    return {load.body, load.point, load.direction, start, make_curve(nb::cast<Doubles>(t[3]), nb::cast<Doubles>(t[5]))};
}

Hold make_hold(const nb::tuple& t) {
    const Doubles at = nb::cast<Doubles>(t[1]), along = nb::cast<Doubles>(t[2]);
    return {nb::cast<int>(t[0]), {at.at(0), at.at(1)}, {along.at(0), {along.at(1), along.at(2)}}};
}

Weld make_weld(const nb::tuple& t) {
    const Doubles a = nb::cast<Doubles>(t[2]), b = nb::cast<Doubles>(t[3]);
    return {nb::cast<int>(t[0]), nb::cast<int>(t[1]), {a.at(0), a.at(1)}, {b.at(0), b.at(1)}};
}

Model make_model(const Integers& parent, const Integers& joint, const Array& bodies, const Doubles& q0,
                 const nb::list& hinges, const nb::list& loads, const nb::list& drives, const nb::list& holds,
                 const nb::list& welds,
                 const Doubles& gravity) {
    Model model{make_tree(parent, joint, bodies), {}, {}, {}, {}, {}, {gravity.at(0), gravity.at(1)}, q0};
    require(q0.size() == static_cast<size_t>(model.tree.dofs()), "q0 must have one entry per joint coordinate");
    for (nb::handle h : hinges) model.hinges.push_back(make_hinge(nb::cast<nb::dict>(h)));
    for (nb::handle l : loads) model.loads.push_back(make_load(nb::cast<nb::tuple>(l)));
    for (nb::handle d : drives) model.drives.push_back(make_drive(nb::cast<nb::tuple>(d)));
    for (nb::handle d : holds) model.holds.push_back(make_hold(nb::cast<nb::tuple>(d)));
    for (nb::handle w : welds) model.welds.push_back(make_weld(nb::cast<nb::tuple>(w)));
    auto known = [&](int body) { return body >= 0 && body < model.tree.bodies(); };
    for (const Hinge& h : model.hinges) require(h.dof >= 0 && h.dof < model.tree.dofs(), "a hinge names an unknown coordinate");
    for (const Load& l : model.loads) require(known(l.body), "a load names an unknown body");
    for (const Drive& d : model.drives) require(known(d.body), "a drive names an unknown body");
    for (const Hold& d : model.holds) require(known(d.body), "a hold names an unknown body");
    for (const Weld& w : model.welds) {
        require(known(w.body) && (w.other == -1 || known(w.other)), "a weld names an unknown body");
    }
    return model;
}

nb::object array(const Doubles& v, std::initializer_list<size_t> shape) {
    auto* data = new double[v.empty() ? 1 : v.size()];
    if (!v.empty()) std::memcpy(data, v.data(), v.size() * sizeof(double));
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, double>(data, shape.size(), shape.begin(), owner));
}

nb::dict to_dict(const Simulation& sim, const Record& r) {
    const size_t n = r.time.size(), bodies = static_cast<size_t>(sim.model().tree.bodies());
    const size_t dofs = static_cast<size_t>(sim.model().tree.dofs()), hinges = sim.model().hinges.size();
    nb::dict d;
    d["time"] = array(r.time, {n});
    d["q"] = array(r.q, {n, dofs});
    d["w"] = array(r.w, {n, dofs});
    d["pose"] = array(r.pose, {n, bodies, 3});
    d["velocity"] = array(r.velocity, {n, bodies, 3});
    d["hinge"] = array(r.hinge, {n, hinges, static_cast<size_t>(hinge_columns)});
    d["energy"] = array(r.energy, {n, 6});
    d["drive"] = array(r.drive, {n, sim.model().drives.size()});
    d["outcome"] = static_cast<int>(r.outcome);
    d["reason"] = r.reason;
    d["residual"] = r.residual;
    d["steps"] = r.steps;
    d["rejected"] = r.rejected;
    d["forced"] = r.forced;
    d["solves"] = r.solves;
    return d;
}

// columns: largest absolute rotation, largest absolute moment, time of rest, 1 while still turning, dissipated
nb::object hinge_summary(Simulation& sim) {
    Doubles out;
    for (size_t j = 0; j < sim.state().hinge.size(); j++) {
        const HingeState& s = sim.state().hinge[j];
        out.insert(out.end(), {s.rotation_max, s.moment_max, s.rest_time, turning(sim.model().hinges[j], s) ? 1.0 : 0.0,
                               s.dissipated + s.damped + s.stop_dissipated});
    }
    return array(out, {sim.state().hinge.size(), 5});
}

std::vector<Twist> to_twists(const Array& a, int bodies) {
    require(a.ndim() == 2 && a.shape(0) == static_cast<size_t>(bodies) && a.shape(1) == 3, "twists must have shape (bodies, 3)");
    std::vector<Twist> out;
    for (int i = 0; i < bodies; i++) out.push_back({a.data()[3 * i], {a.data()[3 * i + 1], a.data()[3 * i + 2]}});
    return out;
}

nb::dict run(Simulation& sim, const Doubles& times, nb::object poll) {
    require(!times.empty(), "at least one output time is needed");
    std::function<bool(double)> ask;
    if (!poll.is_none()) {
        ask = [&poll](double t) {
            nb::gil_scoped_acquire locked;
            return nb::cast<bool>(poll(t));
        };
    }
    Record record;
    {
        nb::gil_scoped_release released;
        record = sim.run(times, ask);
    }
    return to_dict(sim, record);
}

}  // namespace

void bind(nb::module_& m) {
    nb::class_<Simulation>(m, "Simulation", "One run: a frozen model, its state, and the adaptive stepper.")
        .def("__init__",
             [](Simulation* self, const Integers& parent, const Integers& joint, const Array& bodies, const Doubles& q0,
                const nb::list& hinges, const nb::list& loads, const nb::list& drives, const nb::list& holds,
                 const nb::list& welds,
                const Doubles& gravity, double accuracy, double minimum_step, double maximum_step, double length) {
                 Settings settings;
                 settings.accuracy = accuracy;
                 settings.minimum_step = minimum_step;
                 settings.maximum_step = maximum_step;
                 settings.length = length;
                 new (self) Simulation(make_model(parent, joint, bodies, q0, hinges, loads, drives, holds, welds,
                                                  gravity),
                                       settings);
             },
             nb::arg("parent"), nb::arg("joint"), nb::arg("bodies"), nb::arg("q0"), nb::arg("hinges"), nb::arg("loads"),
             nb::arg("drives"), nb::arg("holds"), nb::arg("welds"), nb::arg("gravity"), nb::arg("accuracy"), nb::arg("minimum_step"),
             nb::arg("maximum_step"), nb::arg("length"))
        .def("set_motion",
             [](Simulation& s, const Array& velocity, const Array& impulse) {
                 const int n = s.model().tree.bodies();
                 return s.set_motion(to_twists(velocity, n).data(), to_twists(impulse, n).data());
             },
             nb::arg("velocity"), nb::arg("impulse"))
        .def("set_rates",
             [](Simulation& s, const Doubles& w) {
                 require(w.size() == static_cast<size_t>(s.model().tree.dofs()), "one rate per joint coordinate");
                 s.set_rates(w.data());
             },
             nb::arg("w"))
        .def("run", &run, nb::arg("times"), nb::arg("poll") = nb::none())
        .def("step", [](Simulation& s, double h) { return s.stepper().step(s.state(), h); }, nb::arg("h"),
             "One fixed step of length h [s]; False when it did not converge.")
        .def("effective_inertia", [](Simulation& s, int dof) { return s.stepper().effective_inertia(s.state(), dof); },
             nb::arg("dof"))
        .def("summary", &hinge_summary)
        .def_prop_ro("time", [](Simulation& s) { return s.state().t; })
        .def_prop_ro("q", [](Simulation& s) { return s.state().q; })
        .def_prop_ro("w", [](Simulation& s) { return s.state().w; });
}

}  // namespace crumple::multibody
