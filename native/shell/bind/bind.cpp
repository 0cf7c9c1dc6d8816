// Python face of the shell engine's state; the typed face that people use is crumple._core.shell.simulation.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "common/binding.hpp"
#include "shell/run/simulation.hpp"

namespace nb = nanobind;

namespace crumple::shell {

using ModelPointer = std::shared_ptr<Model>;
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
    std::vector<double> v(s.model().elements());
    for (std::size_t e = 0; e < v.size(); e++) v[e] = s.slot(e, slot);
    return to_array(std::move(v), {s.model().elements()});
}

// (elements, points): one quantity of every thickness point; points that a part does not have are zero
static Array point_slot_values(const Simulation& s, int which) {
    std::size_t points = 0;
    for (const Part& p : s.blocks().parts) points = std::max(points, std::size_t(p.points));
    std::vector<double> v(s.model().elements() * points, 0.0);
    for (std::size_t e = 0; e < s.model().elements(); e++)
        for (int k = 0; k < s.blocks().part(e).points; k++) v[e * points + std::size_t(k)] = s.slot(e, point_slot(k, which));
    return to_array(std::move(v), {s.model().elements(), points});
}

static nb::tuple cut(const Simulation& s, std::size_t i) {
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

// displacement, its rate, angle and its rate, force and impulse of the structure on it, deepest penetration (15)
static Array obstacle_states(const Simulation& s) {
    std::vector<double> v;
    for (const ObstacleContact::State& o : s.contact().obstacles().states())
        v.insert(v.end(), {o.shift.x, o.shift.y, o.shift.z, o.velocity.x, o.velocity.y, o.velocity.z, o.angle, o.rate, o.force.x,
                           o.force.y, o.force.z, o.impulse.x, o.impulse.y, o.impulse.z, o.deepest});
    return to_array(std::move(v), {s.contact().obstacles().states().size(), 15});
}

// broken or not, time of the last look or of failure, normal and shear force then, largest use so far (5)
static Array weld_states(const Simulation& s) {
    std::vector<double> v;
    for (const WeldState& w : s.welds().states()) v.insert(v.end(), {double(w.broken), w.time, w.normal, w.shear, w.worst});
    return to_array(std::move(v), {s.welds().states().size(), 5});
}

// depth of the deepest node when an obstacle appeared, and that node (2)
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

// `same`: of the same model, else of the stage before
static void restore(Simulation& s, const nb::dict& d, bool same) {
    const Checkpoint size = s.save();
    Checkpoint c;
    auto get = [&](const char* name, std::vector<double>& v, std::size_t expected) {
        v = to_vector(nb::cast<In>(d[name]));
        if (expected && v.size() != expected) throw std::invalid_argument("the checkpoint belongs to another model or instruction set");
    };
    get("numbers", c.numbers, size.numbers.size());
    get("nodes", c.nodes, size.nodes.size());
    get("elements", c.elements, size.elements.size());
    get("sums", c.sums, size.sums.size());
    get("bodies", c.bodies, size.bodies.size());
    get("drives", c.drives, same ? size.drives.size() : 0);
    get("contact", c.contact, 0);
    same ? s.restore(c) : s.go_on_from(c);
}

static nb::tuple thickness_points(int points, bool lobatto) {
    std::vector<double> z(std::size_t(points), 0.0), w(std::size_t(points), 0.0);
    thickness_rule(points, lobatto, z.data(), w.data());
    return nb::make_tuple(to_array(std::move(z), {std::size_t(points)}), to_array(std::move(w), {std::size_t(points)}));
}

static void deform(Simulation& s, const In& x, const In& v, const In& w, double dt) {
    for (const In* a : {&x, &v, &w})
        if (a->size() != 3 * s.model().nodes()) throw std::invalid_argument("positions and velocities have shape (nodes, 3)");
    s.deform(x.data(), v.data(), w.data(), dt);
}

static void add_motion(Simulation& s, const In& v, const In& w) {
    for (const In* a : {&v, &w})
        if (a->size() != 3 * s.model().nodes()) throw std::invalid_argument("velocities have shape (nodes, 3)");
    s.add_motion(v.data(), w.data());
}

static void bind_simulation(nb::module_& m) {
    nb::class_<Simulation>(m, "Simulation")
        .def("__init__", [](Simulation* self, const ModelPointer& model, const std::string& isa) {
            check(*model);
            new (self) Simulation(std::make_shared<const Model>(*model), choose_kernels(isa.c_str()));
        })
        .def("advance", [](Simulation& s, double until, double seconds, std::int64_t steps, int threads) {
            nb::gil_scoped_release release;
            return int(s.advance(until, seconds, steps, threads));
        })
        .def("deform", &deform)
        .def("energies", &energies)
        .def("element_slot", &element_slot)
        .def("point_slot", &point_slot_values)
        .def("cut", &cut)
        .def("positions", &positions)
        .def("velocities", &velocities)
        .def("node_forces", &node_forces)
        .def("rigid_states", &rigid_states)
        .def("weld_states", &weld_states)
        .def("save", &save)
        .def("restore", &restore)
        .def("obstacle_states", &obstacle_states)
        .def("appeared_inside", &appeared_inside)
        .def("add_motion", &add_motion)
        .def("stop", &Simulation::stop)
        .def("external_work", &Simulation::external_work)
        .def_prop_ro("time", &Simulation::time)
        .def_prop_ro("step", &Simulation::step)
        .def_prop_ro("first_step", &Simulation::first_step)
        .def_prop_ro("steps", &Simulation::steps)
        .def_prop_ro("end", [](const Simulation& s) { return int(s.end()); })
        .def_prop_ro("failed_element", &Simulation::failed_element)
        .def_prop_ro("isa", [](const Simulation& s) { return std::string(s.kernels().name); })
        .def_prop_ro("mass", [](const Simulation& s) { return s.masses().structure; })
        .def_prop_ro("added_mass", [](const Simulation& s) { return s.masses().added; })
        .def_prop_ro("deepest_penetration", [](const Simulation& s) { return s.contact().deepest(); })
        .def_prop_ro("contact_searches", [](const Simulation& s) { return s.contact().searches(); })
        .def_prop_ro("touching_nodes", [](const Simulation& s) { return s.contact().touching(); });
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
