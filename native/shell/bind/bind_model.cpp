// Builds a model from arrays, one kind of component per call.
#include <nanobind/nanobind.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <stdexcept>

#include "common/binding.hpp"
#include "shell/run/model.hpp"

namespace nb = nanobind;

namespace crumple::shell {

static Vec3 vec3(const In& a) {
    if (a.size() != 3) throw std::invalid_argument("a vector has three components");
    return read3(a.data());
}

static void set_nodes(Model& m, const In& position, const In& velocity, const In& spin, const In& mass, const In& inertia,
                      const InBits& fixed) {
    m.position = to_vector(position);
    m.velocity = to_vector(velocity);
    m.spin = to_vector(spin);
    m.added_mass = to_vector(mass);
    m.added_inertia = to_vector(inertia);
    m.fixed = to_vector(fixed);
    const std::size_t n = m.nodes();
    if (m.velocity.size() != 3 * n || m.spin.size() != 3 * n || m.added_mass.size() != n || m.added_inertia.size() != n ||
        m.fixed.size() != n)
        throw std::invalid_argument("the arrays of the nodes differ in length");
}

static void set_elements(Model& m, const InIndex& quads, const In& thickness, const InIndex& sheet) {
    m.quads = to_vector(quads);
    m.thickness = to_vector(thickness);
    m.sheet_of = to_vector(sheet);
    if (m.quads.size() != 4 * m.thickness.size() || m.sheet_of.size() != m.thickness.size())
        throw std::invalid_argument("the arrays of the elements differ in length");
}

static void add_material(Model& m, const nb::dict& d) {
    Material a;
    a.density = entry<double>(d, "density");
    a.youngs_modulus = entry<double>(d, "youngs_modulus");
    a.poissons_ratio = entry<double>(d, "poissons_ratio");
    a.plastic_strain = to_vector(entry<In>(d, "plastic_strain"));
    a.yield_stress = to_vector(entry<In>(d, "yield_stress"));
    a.hardening_modulus = entry<double>(d, "hardening_modulus");
    a.rate_reference = entry<double>(d, "rate_reference");
    a.rate_exponent = entry<double>(d, "rate_exponent");
    a.rate_time = entry<double>(d, "rate_time");
    a.rate_logarithm = entry<double>(d, "rate_logarithm");
    a.rigid = entry<bool>(d, "rigid");
    a.failure_strain = entry<double>(d, "failure_strain");
    a.fails_at_any_point = entry<bool>(d, "fails_at_any_point");
    if (a.plastic_strain.size() != a.yield_stress.size()) throw std::invalid_argument("a hardening table has unequal columns");
    m.materials.push_back(std::move(a));
}

static void add_rigid_set(Model& m, const InIndex& nodes, double mass, const In& at, const In& inertia, unsigned fixed,
                          const In& pin) {
    // an empty array means no pin
    RigidSet s{to_vector(nodes), mass, vec3(at), {}, fixed, pin.size() > 0, {}};
    if (s.pinned) s.pin = vec3(pin);
    if (s.pinned && (fixed & 7u) != 7u) throw std::invalid_argument("a pinned rigid set holds x, y and z");
    if (inertia.size() != 6) throw std::invalid_argument("an inertia has six components");
    std::copy_n(inertia.data(), 6, s.added_inertia);
    m.rigid_sets.push_back(std::move(s));
}

static void add_spot_weld(Model& m, const InIndex& nodes, const In& weight, std::size_t first, double normal_strength, double shear_strength) {
    m.spot_welds.push_back({to_vector(nodes), to_vector(weight), first, normal_strength, shear_strength});
}

static Curve curve(const In& time, const In& value) {
    Curve c{to_vector(time), to_vector(value)};
    if (c.time.empty() || c.time.size() != c.value.size()) throw std::invalid_argument("a curve needs as many values as times, at least one");
    for (std::size_t i = 1; i < c.time.size(); i++)
        if (!(c.time[i] > c.time[i - 1])) throw std::invalid_argument("the times of a curve do not increase");
    return c;
}

static void set_settings(Model& m, const nb::dict& d) {
    Settings& s = m.settings;
    s.safety = entry<double>(d, "safety");
    s.scaled_step = entry<double>(d, "scaled_step");
    s.least_step = entry<double>(d, "least_step");
    s.damping = entry<double>(d, "damping");
    s.gravity = vec3(entry<In>(d, "gravity"));
    s.thickness_update = entry<bool>(d, "thickness_update");
    s.warping_correction = entry<bool>(d, "warping_correction");
    s.viscous_hourglass = entry<bool>(d, "viscous_hourglass");
    s.hourglass_membrane = entry<double>(d, "hourglass_membrane");
    s.hourglass_shear = entry<double>(d, "hourglass_shear");
    s.hourglass_bending = entry<double>(d, "hourglass_bending");
    s.stabilised = entry<bool>(d, "stabilised");
    s.drill_stiffness = entry<double>(d, "drill_stiffness");
}

static void set_contact(Model& m, const nb::dict& d) {
    m.contact.on = entry<bool>(d, "on");
    m.contact.gap = entry<double>(d, "gap");
    m.contact.stiffness = entry<double>(d, "stiffness");
    m.contact.friction = entry<double>(d, "friction");
    m.contact.damping = entry<double>(d, "damping");
}

static Vec3 unit(const nb::handle& given, const char* what) {
    const Vec3 v = vec3(as<In>(given, "a vector"));
    if (!(norm(v) > 0.0)) throw std::invalid_argument(std::string("an obstacle's ") + what + " has no length");
    return (1.0 / norm(v)) * v;
}

// curves are passed as pairs of arrays
static Curve curve_of(const nb::handle& pair) {
    if (nb::len(pair) != 2) throw std::invalid_argument("a curve is times and values");
    return curve(entry<In>(pair, 0), entry<In>(pair, 1));
}

static void add_obstacle(Model& m, const nb::dict& d) {
    Obstacle o{};
    o.shape = Shape(entry<int>(d, "shape"));
    o.point = vec3(entry<In>(d, "point"));
    o.axis = unit(d["axis"], "axis");
    o.edge = unit(d["edge"], "edge");
    o.radius = entry<double>(d, "radius");
    o.length = entry<double>(d, "length");
    o.friction = entry<double>(d, "friction");
    o.gap = entry<double>(d, "gap");
    o.damping = entry<double>(d, "damping");
    o.mass = entry<double>(d, "mass");
    o.guide = unit(d["guide"], "guide");
    o.velocity = vec3(entry<In>(d, "velocity"));
    if (nb::len(nb::object(d["motion"])) != 3) throw std::invalid_argument("an obstacle moves in three directions");
    for (int i = 0; i < 3; i++) {
        const nb::object motion = d["motion"][i];
        if (!motion.is_none()) o.motion[i] = curve_of(motion);
    }
    o.turn_about = vec3(entry<In>(d, "turn_about"));
    o.turn_axis = unit(d["turn_axis"], "turning axis");
    const nb::object turning = d["turning"];
    if (!turning.is_none()) o.turning = curve_of(turning);
    o.active = entry<bool>(d, "active");
    o.nodes = to_vector(entry<InIndex>(d, "nodes"));
    m.obstacles.push_back(std::move(o));
}

void bind_model(nb::module_& module) {
    nb::class_<Model>(module, "Model")
        .def(nb::init<>())
        .def("nodes", &set_nodes)
        .def("elements", &set_elements)
        .def("material", &add_material)
        .def("sheet", [](Model& m, Index material, int points, bool lobatto) { m.sheets.push_back({material, points, lobatto}); })
        .def("rigid_set", &add_rigid_set)
        .def("spot_weld", &add_spot_weld)
        .def("load", [](Model& m, Index node, int dof, const In& t, const In& v) { m.loads.push_back({node, dof, curve(t, v)}); })
        .def("motion", [](Model& m, bool rigid, Index target, int dof, const In& t, const In& v) {
            m.motions.push_back({rigid, target, dof, curve(t, v)});
        })
        .def("obstacle", &add_obstacle)
        .def("cut", [](Model& m, const InIndex& elements, const InIndex& nodes) { m.cuts.push_back({to_vector(elements), to_vector(nodes)}); })
        .def("contact", &set_contact)
        .def("settings", &set_settings);
}

}  // namespace crumple::shell
