// Builds the model of a planar tree from plain Python data; no physics.
#include "planar/bind/bind_model.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// bodies: columns anchor x, y, centre x, y, mass, inertia
Tree make_tree(const InNumbers& parent, const InNumbers& joint, const In& bodies) {
    require(bodies.ndim() == 2 && bodies.shape(1) == 6, "bodies must have shape (n, 6)");
    const size_t n = bodies.shape(0);
    require(parent.shape(0) == n && joint.shape(0) == n, "parent and joint must have one entry per body");
    std::vector<Body> out(n);
    for (size_t i = 0; i < n; i++) {
        const double* b = bodies.data() + 6 * i;
        const auto p = static_cast<int>(parent.data()[i]);
        require(p == parent.data()[i] && p >= -1 && p < static_cast<int>(i), "a parent must come before its children");
        require(joint.data()[i] == 0 || joint.data()[i] == 1, "a joint is revolute or free");
        for (int k = 0; k < 6; k++) require(std::isfinite(b[k]), "the numbers of a body must be finite");
        const Joint kind = joint.data()[i] == 0 ? Joint::revolute : Joint::free;
        require(kind == Joint::revolute || p == -1, "a free joint must hang on the ground");
        require(b[4] > 0 && b[5] > 0, "mass and inertia must be positive");
        out[i] = {p, kind, 0, {b[0], b[1]}, {b[2], b[3]}, b[4], b[5]};
    }
    return Tree(std::move(out));
}

Hinge make_tree_hinge(const nb::dict& d) {
    Hinge h = make_hinge(d, static_cast<Form>(entry<int>(d, "form")), static_cast<Softening>(entry<int>(d, "softening")));
    h.dof = entry<int>(d, "dof");
    h.scale = entry<double>(d, "capacity_scale");
    return h;
}

// the first fields of a load or a drive: body, point, direction, times, values
Load make_load(const nb::tuple& t) {
    const Doubles at = entry<Doubles>(t, 1), along = entry<Doubles>(t, 2);
    return {entry<int>(t, 0), {at.at(0), at.at(1)}, {along.at(0), {along.at(1), along.at(2)}},
            make_curve(entry<Doubles>(t, 3), entry<Doubles>(t, 4)), 1};
}

Drive make_drive(const nb::tuple& t) {
    const Load load = make_load(t);
    const double start = entry<Doubles>(t, 4).at(0);
    return {load.body, load.point, load.direction, start, make_curve(entry<Doubles>(t, 3), entry<Doubles>(t, 5))};
}

Hold make_hold(const nb::tuple& t) {
    const Doubles at = entry<Doubles>(t, 1), along = entry<Doubles>(t, 2);
    return {entry<int>(t, 0), {at.at(0), at.at(1)}, {along.at(0), {along.at(1), along.at(2)}}};
}

Weld make_weld(const nb::tuple& t) {
    const Doubles a = entry<Doubles>(t, 2), b = entry<Doubles>(t, 3);
    return {entry<int>(t, 0), entry<int>(t, 1), {a.at(0), a.at(1)}, {b.at(0), b.at(1)}};
}

Model make_model(const InNumbers& parent, const InNumbers& joint, const In& bodies, const Doubles& q0,
                 const nb::list& hinges, const nb::list& loads, const nb::list& drives, const nb::list& holds,
                 const nb::list& welds, const Doubles& gravity, double length, const Doubles& breaks,
                 double resolved_frequency) {
    Model model{make_tree(parent, joint, bodies), {}, {}, {}, {}, {}, {gravity.at(0), gravity.at(1)}, {q0.begin(), q0.end()}, length, breaks,
                resolved_frequency};
    require_breaks(breaks);
    require(resolved_frequency > 0, "the resolved frequency must be positive");
    require_finite({gravity[0], gravity[1]}, "gravity must be finite");
    require(length > 0 && std::isfinite(length), "the length must be positive");
    for (const double q : q0) require_finite({q}, "q0 must be finite");
    require(q0.size() == static_cast<size_t>(model.tree.dofs()), "q0 must have one entry per joint coordinate");
    for (nb::handle h : hinges) model.hinges.push_back(make_tree_hinge(as<nb::dict>(h, "a hinge")));
    for (nb::handle l : loads) model.loads.push_back(make_load(fields(l, 5, "a load has body, point, direction, times, values")));
    for (nb::handle d : drives) model.drives.push_back(make_drive(fields(d, 6, "a drive is a load with rates")));
    for (nb::handle d : holds) model.holds.push_back(make_hold(fields(d, 3, "a hold has body, point, direction")));
    for (nb::handle w : welds) model.welds.push_back(make_weld(fields(w, 4, "a weld has two bodies and two points")));
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

}  // namespace

void bind_model(nb::module_& m) {
    nb::class_<Model>(m, "Model", "Constants of a planar tree of bodies.")
        .def("__init__",
             [](Model* self, const InNumbers& parent, const InNumbers& joint, const In& bodies, const Doubles& q0,
                const nb::list& hinges, const nb::list& loads, const nb::list& drives, const nb::list& holds,
                const nb::list& welds, const Doubles& gravity, double length, const Doubles& breaks, double resolved_frequency) {
                 new (self) Model(make_model(parent, joint, bodies, q0, hinges, loads, drives, holds, welds, gravity, length, breaks,
                                              resolved_frequency));
             },
             nb::arg("parent"), nb::arg("joint"), nb::arg("bodies"), nb::arg("q0"), nb::arg("hinges"), nb::arg("loads"),
             nb::arg("drives"), nb::arg("holds"), nb::arg("welds"), nb::arg("gravity"), nb::arg("length"),
             nb::arg("breaks"), nb::arg("resolved_frequency"));
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
