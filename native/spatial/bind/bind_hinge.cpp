#include "spatial/bind/bind_hinge.hpp"

#include <nanobind/ndarray.h>

#include <cmath>

#include "hinge/bind_hinge.hpp"

namespace nb = nanobind;

namespace crumple::spatial {

namespace {

using hinge::Doubles;

// One hinge whose rates are prescribed.
struct Element {
    SpatialHinge hinge;
    SpatialHingeState state;
    FrozenSpatialHinge frozen;
    double time = 0;
    Doubles q;
};

const double* checked(const Element& e, const Doubles& values) {
    require(values.size() == static_cast<size_t>(size(e.hinge)), "one value per component is needed");
    return values.data();
}

nb::tuple answer(const Element& e, const Doubles& w, bool alone) {
    const auto n = static_cast<size_t>(size(e.hinge));
    Doubles impulse(n), tangent(n * n);
    double potential = 0;
    (alone ? law : respond)(e.hinge, e.frozen, checked(e, w), impulse.data(), tangent.data(), &potential);
    return nb::make_tuple(impulse, tangent, potential);
}

Doubles committed(Element& e, const Doubles& w1) {
    Doubles turn(w1.size());
    commit(e.hinge, e.frozen, e.state, e.time, e.q.data(), checked(e, w1), turn.data());
    e.time += e.frozen.h;
    for (size_t k = 0; k < turn.size(); k++) e.q[k] += turn[k];
    return turn;
}

nb::dict state_of(const Element& e) {
    const SpatialHingeState& s = e.state;
    Doubles plastic, moment, total, capacity;
    for (int k = 0; k < size(e.hinge); k++) {
        const hinge::HingeState& c = s.component[k];
        plastic.push_back(c.plastic);
        moment.push_back(c.moment);
        total.push_back(c.total_moment);
        capacity.push_back(c.capacity);
    }
    nb::dict d;
    d["plastic"] = plastic;
    d["moment"] = moment;
    d["total_moment"] = total;
    d["capacity"] = capacity;
    d["softening"] = s.softening;
    d["softening_of"] = Doubles(s.softening_of, s.softening_of + size(e.hinge));
    d["dissipated"] = dissipated(e.hinge, s);
    d["damped"] = damped(e.hinge, s);
    d["stop_dissipated"] = stop_dissipated(e.hinge, s);
    d["elastic"] = elastic_energy(e.hinge, s);
    d["stop"] = stop_energy(e.hinge, e.q.data());
    d["rotation_max"] = s.rotation_max;
    d["opening_time"] = s.opening_time;
    d["rest_time"] = s.rest_time;
    d["fracture_time"] = s.fracture_time;
    d["fracture_energy"] = s.fracture_energy;
    d["sliding"] = s.sliding;
    d["turning"] = turning(e.hinge, s);
    return d;
}

// Shares over increasing rotations, all below a limit.
hinge::Curve make_shares(const Doubles& rotation, const Doubles& share, double limit, const char* refusal) {
    require(rotation.size() == share.size(), "one share per rotation is needed");
    for (size_t i = 0; i < share.size(); i++) require(std::fabs(share[i]) < limit && (i == 0 || rotation[i] > rotation[i - 1]), refusal);
    return {{rotation.begin(), rotation.end()}, {share.begin(), share.end()}};
}

// Shares of a capacity over a flow that spreads: places, then shares, from 0 on and up to 1.
hinge::Curve make_spread(const nb::dict& d, const char* key) {
    const auto given = entry<std::vector<Doubles>>(d, key);
    require(given.size() == 2, "a spread has places and shares");
    for (size_t i = 0; i < given[1].size(); i++) {
        require(given[1][i] > 0 && given[1][i] >= (i == 0 ? 0 : given[1][i - 1]), "shares of a spread are positive and do not fall");
    }
    require(given[0].empty() || (given[0].front() == 0 && given[0].size() > 1 && given[1].back() == 1), "a spread begins at 0 and ends with all of the capacity");
    return make_shares(given[0], given[1], 1 + 1e-12, "shares of a spread are at most 1, at increasing flows");
}

Surface make_surface(const nb::dict& d, int n) {
    require(n >= 1 && n <= most_components, "a hinge has one to four components");
    Surface s;
    const int kind = entry<int>(d, "coupling");
    require(kind >= 0 && kind <= static_cast<int>(Coupling::tension_flange), "unknown coupling");
    s.coupling = static_cast<Coupling>(kind);
    s.rows = entry<Doubles>(d, "rows");
    s.power = entry<double>(d, "power");
    s.torque_power = entry<double>(d, "torque_power");
    s.torsion = entry<int>(d, "torsion");
    s.axisymmetric = entry<bool>(d, "axisymmetric");
    s.arm = entry<double>(d, "arm");
    s.shortened_turn = entry<double>(d, "shortened_turn");
    require(s.shortened_turn >= 0 && std::isfinite(s.shortened_turn), "a shortening counts as no negative rotation");
    const auto gains = entry<Doubles>(d, "arm_gains"), shares = entry<Doubles>(d, "arm_gain_shares");
    require(gains.size() == shares.size() && gains.size() <= most_arm_gains, "an arm has up to three gains, with a share each");
    for (size_t i = 0; i < gains.size(); i++) {
        require(gains[i] > (i == 0 ? 0 : gains[i - 1]) && shares[i] > (i == 0 ? 0 : shares[i - 1]), "gains of an arm and their shares increase");
        s.gains.push_back({gains[i], shares[i]});
    }
    s.growth = make_shares(entry<Doubles>(d, "growth_rotation"), entry<Doubles>(d, "growth_share"), 1,
                           "shares of the growth of an arm are below 1, at increasing rotations");
    if (s.coupling == Coupling::section) {
        require(!s.axisymmetric || (n >= 3 && s.torsion <= n - 3 && s.torsion != 0), "an axisymmetric surface has an axial force and two moments");
        const int columns = s.axisymmetric ? 2 : n;
        require(!s.rows.empty() && s.rows.size() % static_cast<size_t>(columns) == 0,
                "rows must have one column per component, two of an axisymmetric surface");
        require(s.power >= 2 && s.torque_power >= 2, "the powers of a surface are at least 2");
        require(s.torsion >= -1 && s.torsion < n, "the torque is no component");
        for (int k = 0; k < n; k++) {
            double capacity[most_components] = {};
            capacity[k] = 1;
            s.alone[k] = gauge(s, n, capacity, nullptr);
        }
    }
    return s;
}

}  // namespace

SpatialHinge make_hinge(const nb::dict& d) {
    SpatialHinge h;
    const int form = entry<int>(d, "form"), softening = entry<int>(d, "softening");
    int slips = 0, turns = 0;
    bool driven = false, spreads = false;
    for (nb::handle item : entry<nb::list>(d, "components")) {
        const auto c = as<nb::dict>(item, "a component of a hinge");
        h.components.push_back({entry<int>(c, "freedom"),
                                hinge::make_hinge(c, static_cast<Form>(form), static_cast<Softening>(softening)),
                                make_shares(entry<Doubles>(c, "shift_rotation"), entry<Doubles>(c, "shift_share"), 1,
                                            "shares of a shift are below 1, at increasing rotations"),
                                make_shares(entry<Doubles>(c, "worn_rotation"), entry<Doubles>(c, "worn_share"), 1,
                                            "shares of a capacity that is gone are below 1, at increasing rotations"),
                                entry<int>(c, "driver"),
                                {make_spread(c, "positive_spread"), make_spread(c, "negative_spread")},
                                entry<double>(c, "softens"),
                                entry<double>(c, "flange")});
        const Component& last = h.components.back();
        spreads = spreads || !last.spread[0].values().empty() || !last.spread[1].values().empty();
        require(last.freedom >= 0 && last.freedom < 6, "a freedom is one of six");
        require(last.softens > 0 && std::isfinite(last.softens), "a component has a positive weight in the measure of softening");
        require(last.flange >= 0 && std::isfinite(last.flange), "a flange is at no negative distance");
        require(form != 1 || (last.law.stiffness > 0 && std::isfinite(last.law.stiffness)), "an elastic hinge needs a stiffness");
        (last.freedom < 3 ? slips : turns)++;
        driven = driven || last.driver >= 0;
    }
    require(size(h) >= 1 && size(h) <= most_components, "a hinge has one to four components");
    h.surface = make_surface(d, size(h));
    h.fracture = entry<double>(d, "fracture");
    const auto loss = entry<Doubles>(d, "shear_loss");
    require(loss.size() == 2 && loss[0] >= 0 && loss[1] >= 0, "a shear force along y and one along z take no negative share of the torque");
    std::copy(loss.begin(), loss.end(), h.shear_loss);
    h.round_shear = entry<bool>(d, "round_shear");
    h.cross_softening = entry<double>(d, "cross_softening");
    require(h.cross_softening > 0 && h.cross_softening <= 1, "a rotation about the other axis softens by a positive part of its measure, at most all");
    h.edge_relief = entry<double>(d, "edge_relief");
    require(h.edge_relief >= 0 && h.edge_relief < 1, "a fold about both axes is relieved of a part of its measure, of none at least");
    for (const Component& c : h.components) {
        const bool drives = !c.shift.values().empty() || !c.worn.values().empty();
        require(c.driver < size(h) && (c.driver >= 0) == drives, "a share depends on the rotation about a component of its hinge");
        for (const double share : c.worn.values()) require(share >= 0, "no capacity is gained");
    }
    require(!driven || (h.surface.coupling == Coupling::ellipsoid && form != 2), "only an ellipsoid that is not regularised has shares that depend on a rotation");
    const bool together = h.surface.coupling == Coupling::section || h.surface.coupling == Coupling::ellipsoid;
    require(!spreads || (together && form != 2), "only components with one measure of softening, which are not regularised, spread");
    require(h.surface.coupling != Coupling::ball || slips == 0, "a ball hinge has rotations only");
    require(h.surface.coupling != Coupling::tension_flange || (slips == 1 && turns == 1 && form != 2 && h.surface.arm > 0),
            "a hinge about its tension flange has one slip and one rotation, an arm, and is not regularised");
    return h;
}

void bind_hinge(nb::module_& m) {
    nb::class_<Element>(m, "HingeElement")
        .def("__init__",
             [](Element* self, const nb::dict& d) {
                 new (self) Element{make_hinge(d), {}, {}, 0, {}};
                 self->q.assign(static_cast<size_t>(size(self->hinge)), 0.0);
             })
        .def("freeze",
             [](Element& e, double h, const Doubles& w0, const Doubles& w1, double late) {
                 require_step(h);
                 e.frozen = freeze(e.hinge, e.state, {h, late}, e.q.data(), checked(e, w0), checked(e, w1));
             },
             nb::arg("h"), nb::arg("w0"), nb::arg("w1"), nb::arg("late") = 0.5)
        .def("widen", [](Element& e, double width) { widen(e.hinge, e.frozen, width); })
        .def("scale_capacity",
             [](Element& e, int k, double factor) {
                 require(k >= 0 && k < size(e.hinge), "a hinge has no such component");
                 for (double& c : e.frozen.component[k].capacity) c *= factor;
                 if (e.hinge.components[static_cast<size_t>(k)].freedom < 3) return;
                 for (double& top : e.frozen.top) top *= factor;
             })
        .def("set_damped_inertia",
             [](Element& e, size_t k, double inertia) { e.hinge.components.at(k).law.damped_inertia = inertia; })
        .def("respond", [](const Element& e, const Doubles& w) { return answer(e, w, false); })
        .def("law", [](const Element& e, const Doubles& w) { return answer(e, w, true); })
        .def("capacity_sensitivity",
             [](const Element& e, const Doubles& w) {
                 Doubles d(w.size() * w.size());
                 capacity_sensitivity(e.hinge, e.frozen, checked(e, w), d.data());
                 return d;
             })
        .def("commit", &committed)
        .def_prop_ro("q", [](const Element& e) { return e.q; })
        .def_prop_ro("state", &state_of);
    m.def("surface_point", [](const nb::dict& d, const Doubles& y, const Doubles& metric) {
        const auto n = y.size();
        require(n <= most_components && metric.size() == n, "the metric must have shape (n,)");
        const Surface s = make_surface(d, static_cast<int>(n));
        Doubles derivative(n * n);
        const SurfacePoint p = nearest(s, static_cast<int>(n), y.data(), metric.data(), nullptr, derivative.data());
        return nb::make_tuple(Doubles(p.x, p.x + n), p.value, p.multiplier, derivative);
    });
    m.def("surface_gauge", [](const nb::dict& d, const Doubles& x) {
        require(x.size() <= most_components, "a hinge has one to four components");
        const Surface s = make_surface(d, static_cast<int>(x.size()));
        Doubles gradient(x.size());
        const double g = gauge(s, static_cast<int>(x.size()), x.data(), gradient.data());
        return nb::make_tuple(g, gradient);
    });
}

}  // namespace crumple::spatial
