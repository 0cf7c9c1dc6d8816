// Python interface of `solve_many`, and of a run with its followers.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "common/binding.hpp"
#include "spatial/run/batch.hpp"
#include "spatial/bind/bind_model.hpp"

namespace nb = nanobind;

namespace crumple::spatial {

namespace {

void add_stage(Case& of, double duration, bool quasi_static, const std::vector<int>& drives, const std::vector<int>& obstacles,
               const nb::list& until) {
    require(duration > 0 && std::isfinite(duration), "a stage must last");
    CaseStage stage;
    stage.duration = duration;
    stage.quasi_static = quasi_static;
    stage.drives = chosen(drives, of.model.drives.size(), "a drive is unknown");
    stage.obstacles = chosen(obstacles, of.model.contact.obstacles.size(), "an obstacle is unknown");
    for (nb::handle h : until) stage.until.push_back(make_condition(of.model, h));
    of.stages.push_back(stage);
}

nb::dict samples_of(const Samples& f, const Case& of, size_t n) {
    const size_t bodies = of.model.bodies.size(), components = n > 0 ? f.hinge.rate.size() / n : 0;
    nb::dict d;
    d["centre"] = to_array(f.centre, {n, bodies, 3});
    d["rotation"] = to_array(f.rotation, {n, bodies, 4});
    d["velocity"] = to_array(f.velocity, {n, bodies, 6});
    d["hinge"] = columns(f.hinge, {n, components});
    d["hinge_energy"] = columns(f.hinge_energy, {n, of.model.hinges.size()});
    d["energy"] = columns(f.energy, {n});
    return d;
}

nb::dict to_dict(const EndValues& f, const Case& of, size_t n) {
    const size_t bodies = of.model.bodies.size(), hinges = of.model.hinges.size(), components = n > 0 ? f.hinge.rate.size() / n : 0;
    nb::dict d;
    d["time"] = to_array(f.time, {n});
    d["start"] = to_array(f.start, {n, bodies, 3});
    d["centre"] = to_array(f.centre, {n, bodies, 3});
    d["rotation"] = to_array(f.rotation, {n, bodies, 4});
    d["velocity"] = to_array(f.velocity, {n, bodies, 6});
    d["hinge"] = columns(f.hinge, {n, components});
    d["hinge_energy"] = columns(f.hinge_energy, {n, hinges});
    d["summary"] = columns(f.summary, {n, hinges});
    d["energy"] = columns(f.energy, {n});
    d["residual"] = to_array(f.residual, {n});
    d["lost"] = to_array(f.lost, {n});
    d["outcome"] = to_array(f.outcome, {n});
    d["steps"] = to_array(f.steps, {n});
    return d;
}

nb::dict solve(const std::vector<const Case*>& cases, const InNumbers& case_of, const Rows& velocity, const Rows& impulse,
               const Rows& capacity_scale, const Rows& load_scale, const Rows& bodies, const Rows& gravity, double accuracy,
               double minimum_step, double maximum_step, int threads, nb::object poll,
               bool led, const std::vector<double>& times, int parts, bool guided) {
    require(!cases.empty(), "at least one model is needed");
    require_all(cases);
    require_settings(accuracy, minimum_step, maximum_step, parts);
    const Case& first = *cases.front();
    require(!first.stages.empty(), "a case needs a stage");
    for (const Case* other : cases) {
        require(alike(first, *other), "all models of a batch must have the same bodies, hinges, loads, drives and stages");
    }
    const ContactModel& contact = first.model.contact;
    require(!led || (contact.obstacles.empty() && contact.pairs.empty()), "runs with contact have no followers");
    const size_t n = first.model.bodies.size(), motions = 6 * n * first.stages.size();
    double end = 0;
    for (const CaseStage& stage : first.stages) end += stage.duration;
    require_sample_times(times, end * (1 + 1e-12));
    require(!led || times.empty(), "followers have no samples");
    Variations v;
    v.times = times;
    v.count = case_of.shape(0);
    v.cases = cases;
    v.case_of = case_of.data();
    for (size_t i = 0; i < v.count; i++) {
        require(v.case_of[i] >= 0 && static_cast<size_t>(v.case_of[i]) < cases.size(), "a variant names an unknown model");
    }
    v.velocity = rows(velocity, v.count, motions, "velocity must have shape (variants, stages, bodies, 6)");
    v.impulse = rows(impulse, v.count, motions, "impulse must have shape (variants, stages, bodies, 6)");
    v.capacity_scale = rows(capacity_scale, v.count, first.model.hinges.size(), "capacity_scale must have shape (variants, hinges)");
    v.load_scale = rows(load_scale, v.count, first.model.loads.size(), "load_scale must have shape (variants, loads)");
    v.bodies = rows(bodies, v.count, body_columns * n, "bodies must have shape (variants, bodies, 13)");
    v.gravity = rows(gravity, v.count, 3, "gravity must have shape (variants, 3)");
    const Settings settings{accuracy, minimum_step, maximum_step, parts};
    const auto solver = led ? solve_led : guided ? solve_guided : solve_many;
    const EndValues end_values = unlocked(poll, [&](const auto& ask) { return solver(v, settings, threads, ask); });
    nb::dict found = to_dict(end_values, first, v.count);
    if (!times.empty()) found["samples"] = samples_of(end_values.samples, first, v.count * times.size());
    return found;
}

}  // namespace

void bind_batch(nb::module_& m) {
    nb::class_<Case>(m, "Case", "A model and the stages of its run.")
        .def("__init__", [](Case* self, const nb::dict& model) { new (self) Case{make_model(model), {}}; })
        .def("add_stage", &add_stage);
    m.def("solve_many", &solve, nb::arg("cases"), nb::arg("case_of"), nb::arg("velocity").none(), nb::arg("impulse").none(),
          nb::arg("capacity_scale").none(), nb::arg("load_scale").none(), nb::arg("bodies").none(), nb::arg("gravity").none(),
          nb::arg("accuracy"), nb::arg("minimum_step"), nb::arg("maximum_step"), nb::arg("threads"), nb::arg("poll").none(),
          nb::arg("led"), nb::arg("times") = std::vector<double>{}, nb::arg("parts") = 1,
          nb::arg("guided") = false, "Solve every variant as one run would; or, led, the first so and the others in its steps, or guided by them.");
}

}  // namespace crumple::spatial
