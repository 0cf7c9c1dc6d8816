// Python interface of the shell kernel's state; the typed interface for callers is crumple._core.shell.simulation.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/binding.hpp"
#include "shell/run/lowering.hpp"
#include "shell/run/simulation.hpp"

namespace nb = nanobind;

namespace crumple::shell {

using ModelPointer = std::shared_ptr<Model>;
using Run = Used<Simulation>;
void bind_model(nb::module_& m);

static nb::dict energies(const Simulation& s) {
    const Energies e = s.energies();
    nb::dict d;
    d["kinetic"] = e.kinetic;
    d["elastic"] = e.elastic;
    d["plastic"] = e.plastic;
    d["hourglass"] = e.hourglass;
    d["contact"] = e.contact;
    d["damping"] = e.damping;
    d["external_work"] = e.external;
    d["residual"] = e.residual;
    d["eroded"] = e.eroded;
    return d;
}

static Array element_slot(const Simulation& s, int slot) {
    require(slot >= 0 && slot < common_slots, "an element has no such slot");
    std::vector<double> v(s.model().elements());
    for (std::size_t e = 0; e < v.size(); e++) v[e] = s.slot(e, slot);
    return to_array(std::move(v), {s.model().elements()});
}

// (elements, points): one quantity at every thickness point; zero for points that a part does not have
static Array point_slot_values(const Simulation& s, int which) {
    require(which >= 0 && which < point_slots, "a point has no such slot");
    std::size_t points = 0;
    for (const Part& p : s.blocks().parts) points = std::max(points, std::size_t(p.points));
    std::vector<double> v(s.model().elements() * points, 0.0);
    for (std::size_t e = 0; e < s.model().elements(); e++)
        for (int k = 0; k < s.blocks().part(e).points; k++) v[e * points + std::size_t(k)] = s.slot(e, point_slot(k, which));
    return to_array(std::move(v), {s.model().elements(), points});
}

static nb::tuple cut(const Simulation& s, std::size_t i) {
    require(i < s.model().cuts.size(), "there is no such cut");
    Vec3 centre;
    const Wrench w = s.cut(i, &centre);
    return nb::make_tuple(to_array({w.force.x, w.force.y, w.force.z}, {3}), to_array({w.moment.x, w.moment.y, w.moment.z}, {3}),
                          to_array({centre.x, centre.y, centre.z}, {3}));
}

static Array positions(const Simulation& s) {
    const std::size_t n = s.model().nodes();
    std::vector<double> v(3 * n);
    for (std::size_t i = 0; i < n; i++) write3(&v[3 * i], read3(s.position() + position_record * i));
    return to_array(std::move(v), {n, 3});
}

static nb::tuple velocities(const Simulation& s) {
    const std::size_t n = s.model().nodes();
    std::vector<double> v(3 * n), w(3 * n);
    s.velocities(v.data(), w.data());
    return nb::make_tuple(to_array(std::move(v), {n, 3}), to_array(std::move(w), {n, 3}));
}

static Array node_forces(const Simulation& s) {
    std::vector<double> v(6 * s.model().nodes());
    s.node_forces(v.data());
    return to_array(std::move(v), {s.model().nodes(), 6});
}

// centre (3), velocity (3), angular velocity (3), rotation from the start (9, row by row) of each rigid set
static Array rigid_states(const Simulation& s) {
    std::vector<double> v;
    for (const RigidState& b : s.body_states()) {
        for (Vec3 a : {b.centre, b.velocity, b.omega}) v.insert(v.end(), {a.x, a.y, a.z});
        v.insert(v.end(), b.rotation.m, b.rotation.m + 9);
    }
    return to_array(std::move(v), {s.body_states().size(), 18});
}

// displacement and its rate, angle and its rate, force and impulse of the structure on the obstacle, largest penetration (15)
static Array obstacle_states(const Simulation& s) {
    std::vector<double> v;
    for (const ObstacleContact::State& o : s.contact().obstacles().states())
        v.insert(v.end(), {o.shift.x, o.shift.y, o.shift.z, o.velocity.x, o.velocity.y, o.velocity.z, o.angle, o.rate, o.force.x,
                           o.force.y, o.force.z, o.impulse.x, o.impulse.y, o.impulse.z, o.deepest});
    return to_array(std::move(v), {s.contact().obstacles().states().size(), 15});
}

// whether broken, time of the last evaluation or of failure, normal and shear force then, largest value of the criterion so far (5)
static Array weld_states(const Simulation& s) {
    std::vector<double> v;
    for (const WeldState& w : s.welds().states()) v.insert(v.end(), {double(w.broken), w.time, w.normal, w.shear, w.worst});
    return to_array(std::move(v), {s.welds().states().size(), 5});
}

// depth of the deepest node when the obstacle appeared, and the index of that node (2)
static Array appeared_inside(const Simulation& s) {
    std::vector<double> v;
    for (const ObstacleContact::State& o : s.contact().obstacles().states()) v.insert(v.end(), {o.inside, double(o.inside_node)});
    return to_array(std::move(v), {s.contact().obstacles().states().size(), 2});
}

static nb::dict save(const Simulation& s) {
    Checkpoint c = s.save();
    nb::dict d;
    auto put = [&](const char* name, std::vector<double>& v) {
        const std::size_t n = v.size();
        d[name] = to_array(std::move(v), {n});
    };
    put("numbers", c.numbers);
    put("nodes", c.nodes);
    put("elements", c.elements);
    put("sums", c.sums);
    put("bodies", c.bodies);
    put("drives", c.drives);
    put("contact", c.contact);
    return d;
}

// `same`: the checkpoint is of the same model, else of the previous stage
static void restore(Simulation& s, const nb::dict& d, bool same) {
    const Checkpoint before = s.save();
    Checkpoint c;
    auto get = [&](const char* name, std::vector<double>& v) { v = to_vector(entry<In>(d, name)); };
    get("numbers", c.numbers);
    get("nodes", c.nodes);
    get("elements", c.elements);
    get("sums", c.sums);
    get("bodies", c.bodies);
    get("drives", c.drives);
    get("contact", c.contact);
    try {
        same ? s.restore(c) : s.go_on_from(c);
    } catch (const std::invalid_argument&) {
        // a refused checkpoint leaves the state unchanged
        s.restore(before);
        throw;
    }
}

static nb::tuple thickness_points(int points, bool lobatto) {
    require(points >= (lobatto ? 2 : 1) && points <= max_points, "1 to 10 thickness points are allowed (Lobatto: 2 to 10)");
    std::vector<double> z(std::size_t(points), 0.0), w(std::size_t(points), 0.0);
    thickness_rule(points, lobatto, z.data(), w.data());
    return nb::make_tuple(to_array(std::move(z), {std::size_t(points)}), to_array(std::move(w), {std::size_t(points)}));
}

static void deform(Simulation& s, const In& x, const In& v, const In& w, double dt) {
    for (const In* a : {&x, &v, &w})
        if (a->size() != 3 * s.model().nodes()) throw std::invalid_argument("positions and velocities have shape (nodes, 3)");
    require(dt > 0.0 && std::isfinite(dt), "a step is positive");
    s.deform(x.data(), v.data(), w.data(), dt);
}

static void add_motion(Simulation& s, const In& v, const In& w) {
    for (const In* a : {&v, &w})
        if (a->size() != 3 * s.model().nodes()) throw std::invalid_argument("velocities have shape (nodes, 3)");
    s.add_motion(v.data(), w.data());
}

// Advances with the interpreter lock released; other threads must not use the state meanwhile.
static int advance(Run& s, double until, double seconds, std::int64_t steps, int threads) {
    require(!std::isnan(until) && !std::isnan(seconds) && steps >= 0, "a run needs an end, a time and a number of steps");
    const Busy busy(s);
    nb::gil_scoped_release release;
    return int(s.advance(until, seconds, steps, threads));
}

static void bind_simulation(nb::module_& m) {
    nb::class_<Run>(m, "Simulation")
        .def("__init__", [](Run* self, const ModelPointer& model, const std::string& isa) {
            require(model != nullptr, "a model is needed");
            check(*model);
            new (self) Run(std::make_shared<const Model>(*model), choose_kernels(isa.c_str()));
        })
        .def("advance", &advance)
        .def("deform", alone(&deform))
        .def("energies", alone(&energies))
        .def("element_slot", alone(&element_slot))
        .def("point_slot", alone(&point_slot_values))
        .def("cut", alone(&cut))
        .def("positions", alone(&positions))
        .def("velocities", alone(&velocities))
        .def("node_forces", alone(&node_forces))
        .def("rigid_states", alone(&rigid_states))
        .def("weld_states", alone(&weld_states))
        .def("save", alone(&save))
        .def("restore", alone(&restore))
        .def("obstacle_states", alone(&obstacle_states))
        .def("appeared_inside", alone(&appeared_inside))
        .def("add_motion", alone(&add_motion))
        .def("stop", alone(+[](Simulation& s) { s.stop(); }))
        .def("external_work", alone(+[](Simulation& s) { return s.external_work(); }))
        .def_prop_ro("time", alone(+[](const Simulation& s) { return s.time(); }))
        .def_prop_ro("step", alone(+[](const Simulation& s) { return s.step(); }))
        .def_prop_ro("first_step", alone(+[](const Simulation& s) { return s.first_step(); }))
        .def_prop_ro("steps", alone(+[](const Simulation& s) { return s.steps(); }))
        .def_prop_ro("end", alone(+[](const Simulation& s) { return int(s.end()); }))
        .def_prop_ro("failed_element", alone(+[](const Simulation& s) { return s.failed_element(); }))
        .def_prop_ro("isa", alone(+[](const Simulation& s) { return std::string(s.kernels().name); }))
        .def_prop_ro("lanes", alone(+[](const Simulation& s) { return s.kernels().lanes; }))
        .def_prop_ro("mass", alone(+[](const Simulation& s) { return s.masses().structure; }))
        .def_prop_ro("added_mass", alone(+[](const Simulation& s) { return s.masses().added; }))
        .def_prop_ro("deepest_penetration", alone(+[](const Simulation& s) { return s.contact().deepest(); }))
        .def_prop_ro("contact_searches", alone(+[](const Simulation& s) { return s.contact().searches(); }))
        .def_prop_ro("touching_nodes", alone(+[](const Simulation& s) { return s.contact().touching(); }));
}

void bind(nb::module_& m) {
    bind_model(m);
    bind_simulation(m);
    m.def("thickness_rule", &thickness_points);
    m.def("isa", [](const std::string& name) { return std::string(choose_kernels(name.c_str()).name); });
    nb::dict slots;
    slots["thickness"] = int(thickness);
    slots["internal_energy"] = int(internal_energy);
    slots["plastic_energy"] = int(plastic_energy);
    slots["hourglass_energy"] = int(hourglass_energy);
    slots["shear_xz"] = int(shear_xz);
    slots["shear_yz"] = int(shear_yz);
    slots["alive"] = int(alive);
    m.attr("slots") = slots;
}

}  // namespace crumple::shell
