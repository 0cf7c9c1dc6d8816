// Python interface of contact geometry and contact law for tests; simulations use them inside the kernel.
#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include "spatial/bind/bind_contact.hpp"
#include "common/binding.hpp"
#include "spatial/contact/contact.hpp"

namespace nb = nanobind;

namespace crumple::spatial {

namespace {

using Doubles = std::vector<double>;

Vec3 vector(const Doubles& v) { return {v.at(0), v.at(1), v.at(2)}; }
Doubles list(Vec3 v) { return {v.x, v.y, v.z}; }

nb::list find_touches(const nb::dict& solid, const Doubles& first, const Doubles& second, double radius) {
    Touch touch[most_touches];
    const int n = touches(make_solid(solid), {vector(first), vector(second), radius}, touch);
    nb::list out;
    for (int k = 0; k < n; k++) {
        out.append(nb::make_tuple(touch[k].gap, list(touch[k].normal), list(touch[k].point), touch[k].slot));
    }
    return out;
}

nb::tuple answer(double friction, double inverse_mass, double normal_impulse, const Doubles& rates, double cap) {
    const FrozenContact f = freeze({friction, 0}, inverse_mass, normal_impulse, cap);
    double impulse[3], tangent[9], potential;
    if (rates.size() != 3) throw nb::value_error("a contact has three rates");
    respond(f, 3, rates.data(), impulse, tangent, &potential);
    return nb::make_tuple(Doubles(impulse, impulse + 3), Doubles(tangent, tangent + 9), potential);
}

}  // namespace

Solid make_solid(const nb::dict& d) {
    Solid s;
    const int shape = entry<int>(d, "kind");
    if (shape < 0 || shape > static_cast<int>(Shape::capsule)) throw nb::value_error("an obstacle is of unknown shape");
    s.shape = static_cast<Shape>(shape);
    s.point = vector(entry<Doubles>(d, "point"));
    s.direction = vector(entry<Doubles>(d, "direction"));
    s.edge = vector(entry<Doubles>(d, "edge"));
    s.radius = entry<double>(d, "radius");
    s.length = entry<double>(d, "length");
    if (s.shape != Shape::sphere) {
        if (!(norm(s.direction) > 0)) throw nb::value_error("an obstacle needs a direction");
        s.direction = (1 / norm(s.direction)) * s.direction;
    }
    s.has_edge = s.shape == Shape::plane && norm(s.edge) > 0;
    if (s.has_edge) {
        s.edge = s.edge - dot(s.edge, s.direction) * s.direction;
        if (!(norm(s.edge) > 0)) throw nb::value_error("an edge must not lie along the normal");
        s.edge = (1 / norm(s.edge)) * s.edge;
    }
    return s;
}

void bind_contact(nb::module_& m) {
    m.def("touches", &find_touches, nb::arg("solid"), nb::arg("first"), nb::arg("second"), nb::arg("radius"),
          "Points of contact of a capsule with a solid: (gap, normal, point, slot) each.");
    m.def("contact_response", &answer, nb::arg("friction"), nb::arg("inverse_mass"), nb::arg("normal_impulse"),
          nb::arg("rates"), nb::arg("cap") = INFINITY, "Impulse (3), tangent (9) and potential of a frozen contact.");
    m.def("allowed_rate", &allowed_rate, nb::arg("restitution"), nb::arg("gap"), nb::arg("rate"), nb::arg("h"),
          nb::arg("closed"), nb::arg("rest"), "Normal rate that a step allows at its end.");
}

}  // namespace crumple::spatial
