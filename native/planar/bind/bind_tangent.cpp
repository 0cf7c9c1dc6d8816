// Python interface of a run with derivatives.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "planar/bind/bind_model.hpp"
#include "planar/directions.hpp"
#include "planar/simulation.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// values of one variant, (bodies, 3), with their derivatives, (directions, bodies, 3)
std::vector<Twist> twists(const In& values, const In& slopes, int bodies, size_t count) {
    const auto n = static_cast<size_t>(3 * bodies);
    require(values.size() == n && slopes.size() == count * n, "velocities and impulses must have shape (bodies, 3)");
    std::vector<Twist> out(static_cast<size_t>(bodies));
    for (size_t i = 0; i < n; i++) {
        Real x(values.data()[i]);
        for (size_t k = 0; k < count; k++) x.d[k] = slopes.data()[k * n + i];
        Twist& t = out[i / 3];
        (i % 3 == 0 ? t.w : i % 3 == 1 ? t.v.x : t.v.y) = x;
    }
    return out;
}

// appends the values as the first row and the derivatives, one direction per row, as the following rows
void append_rows(Doubles& out, const std::vector<Real>& values, size_t count) {
    for (const Real& x : values) out.push_back(x.v);
    for (size_t k = 0; k < count; k++) {
        for (const Real& x : values) out.push_back(x.d[k]);
    }
}

Array rows(const std::vector<Real>& values, size_t count) {
    Doubles out;
    append_rows(out, values, count);
    return to_array(out, {count + 1, values.size()});
}

// the same for every column of a record, (columns, count + 1, values)
template <class R> Array rows_of(const R& record, size_t count) {
    Doubles out;
    size_t number = 0, size = 0;
    R::each([&](const char*, auto column) {
        append_rows(out, record.*column, count);
        size = (record.*column).size();
        number++;
    });
    return to_array(out, {number, count + 1, size});
}

nb::dict solve(Model& given, const std::vector<Model*>& up, const std::vector<Model*>& down, const Doubles& width,
               const In& velocity, const In& velocity_slopes, const In& impulse, const In& impulse_slopes,
               double end, double accuracy, double minimum_step, double maximum_step, nb::object poll) {
    const size_t count = width.size();
    require_all(up);
    require_all(down);
    require_settings(accuracy, minimum_step, maximum_step);
    require(std::isfinite(end) && end > 0, "the end must come after the start");
    require(count <= directions && up.size() == count && down.size() == count, "too many directions at a time");
    Model model = given;
    require(set_directions(model, up, down, width), "a parameter changes more than numbers of the model");
    const int bodies = model.tree.bodies();
    const std::vector<Twist> v = twists(velocity, velocity_slopes, bodies, count);
    const std::vector<Twist> blow = twists(impulse, impulse_slopes, bodies, count);
    Simulation simulation(std::move(model), {accuracy, minimum_step, maximum_step, 1});
    simulation.set_motion(v.data(), blow.data());
    const Record record = unlocked(poll, [&](const auto& ask) { return simulation.run({end}, ask); });
    const Record last = simulation.present();
    nb::dict ends;
    ends["q"] = rows(last.q, count);
    ends["w"] = rows(last.w, count);
    ends["pose"] = rows(last.pose, count);
    ends["velocity"] = rows(last.velocity, count);
    ends["hinge"] = rows_of(last.hinge, count);
    ends["hinge_energy"] = rows_of(last.hinge_energy, count);
    ends["energy"] = rows_of(last.energy, count);
    ends["summary"] = rows_of(hinge_summary(simulation), count);
    nb::dict d;
    d["ends"] = ends;
    d["time"] = simulation.state().t;
    d["outcome"] = static_cast<int>(record.outcome);
    d["reason"] = record.reason;
    d["residual"] = record.residual;
    d["steps"] = record.steps;
    return d;
}

}  // namespace

void bind_tangent(nb::module_& m) {
    bind_model(m);
    m.attr("directions") = directions;
    m.def("solve", &solve, nb::arg("model"), nb::arg("up"), nb::arg("down"), nb::arg("width"), nb::arg("velocity"),
          nb::arg("velocity_slopes"), nb::arg("impulse"), nb::arg("impulse_slopes"), nb::arg("end"), nb::arg("accuracy"),
          nb::arg("minimum_step"), nb::arg("maximum_step"), nb::arg("poll").none(),
          "One run to its end, with derivatives along directions.");
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
