// Python interface of the planar kernel: conversion of NumPy arrays, no physics.
#include <nanobind/stl/function.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "planar/batch.hpp"
#include "planar/bind/bind_batch.hpp"
#include "planar/bind/bind_model.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

nb::dict to_dict(const Simulation& sim, const Record& r) {
    const size_t n = r.time.size(), bodies = static_cast<size_t>(sim.model().tree.bodies());
    const size_t dofs = static_cast<size_t>(sim.model().tree.dofs()), hinges = sim.model().hinges.size();
    nb::dict d;
    d["time"] = to_array(r.time, {n});
    d["q"] = to_array(r.q, {n, dofs});
    d["w"] = to_array(r.w, {n, dofs});
    d["pose"] = to_array(r.pose, {n, bodies, 3});
    d["velocity"] = to_array(r.velocity, {n, bodies, 3});
    d["hinge"] = columns(r.hinge, {n, hinges});
    d["hinge_energy"] = columns(r.hinge_energy, {n, hinges});
    d["energy"] = columns(r.energy, {n});
    d["drive"] = to_array(r.drive, {n, sim.model().drives.size()});
    d["outcome"] = static_cast<int>(r.outcome);
    d["reason"] = r.reason;
    d["residual"] = r.residual;
    d["unseen"] = r.unseen;
    d["steps"] = r.steps;
    d["rejected"] = r.rejected;
    d["forced"] = r.forced;
    d["solves"] = r.solves;
    return d;
}

std::vector<Twist> to_twists(const In& a, int bodies) {
    require(a.ndim() == 2 && a.shape(0) == static_cast<size_t>(bodies) && a.shape(1) == 3, "twists must have shape (bodies, 3)");
    std::vector<Twist> out;
    for (int i = 0; i < bodies; i++) out.push_back({a.data()[3 * i], {a.data()[3 * i + 1], a.data()[3 * i + 2]}});
    return out;
}

nb::dict run(Simulation& sim, const Doubles& times, nb::object poll) {
    require_times(times, sim.state().t);
    return to_dict(sim, unlocked(poll, [&](const auto& ask) { return sim.run(times, ask); }));
}

double set_motion(Simulation& s, const In& velocity, const In& impulse) {
    const int n = s.model().tree.bodies();
    return s.set_motion(to_twists(velocity, n).data(), to_twists(impulse, n).data());
}

void set_rates(Simulation& s, const Doubles& w) {
    require(w.size() == static_cast<size_t>(s.model().tree.dofs()), "one rate per joint coordinate");
    s.set_rates(w.data());
}

bool step(Simulation& s, double h) {
    require_step(h);
    s.make_ready();
    return s.stepper().step(s.state(), h);
}

double effective_inertia(Simulation& s, int dof) {
    require(dof >= 0 && dof < s.model().tree.dofs(), "there is no such joint coordinate");
    return s.stepper().effective_inertia(s.state(), dof);
}

}  // namespace

void bind(nb::module_& m) {
    bind_model(m);
    bind_batch(m);
    using Run = Used<Simulation>;
    nb::class_<Run>(m, "Simulation", "One run: a frozen model, its state, and the adaptive stepper.")
        .def("__init__",
             [](Run* self, const Model& model, double accuracy, double minimum_step, double maximum_step, int parts) {
                 require_settings(accuracy, minimum_step, maximum_step, parts);
                 new (self) Run(model, Settings{accuracy, minimum_step, maximum_step, parts});
             },
             nb::arg("model"), nb::arg("accuracy"), nb::arg("minimum_step"), nb::arg("maximum_step"), nb::arg("parts") = 1)
        .def("set_motion", alone(&set_motion), nb::arg("velocity"), nb::arg("impulse"))
        .def("set_rates", alone(&set_rates), nb::arg("w"))
        .def("run", alone(&run), nb::arg("times"), nb::arg("poll") = nb::none())
        .def("step", alone(&step), nb::arg("h"), "One fixed step of length h [s]; False when it did not converge.")
        .def("effective_inertia", alone(&effective_inertia), nb::arg("dof"))
        .def("summary", alone(+[](const Simulation& s) { return columns(hinge_summary(s), {s.state().hinge.size()}); }))
        .def_prop_ro("time", alone(+[](const Simulation& s) { return s.state().t; }))
        .def_prop_ro("q", alone(+[](const Simulation& s) { return s.state().q; }))
        .def_prop_ro("w", alone(+[](const Simulation& s) { return s.state().w; }));
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
