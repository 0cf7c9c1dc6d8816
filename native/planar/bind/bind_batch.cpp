// Python interface of `solve_many`.
#include "planar/bind/bind_batch.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "planar/batch.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

void require_one_topology(const std::vector<const Model*>& models) {
    require(!models.empty(), "at least one model is needed");
    const Model& first = *models.front();
    for (const Model* m : models) {
        bool same = m->tree.bodies() == first.tree.bodies() && m->tree.dofs() == first.tree.dofs() &&
                    m->hinges.size() == first.hinges.size() && m->loads.size() == first.loads.size() &&
                    m->drives.size() == first.drives.size() &&
                    m->welds.size() == first.welds.size() && m->holds.size() == first.holds.size();
        for (int i = 0; same && i < first.tree.bodies(); i++) same = m->tree[i].parent == first.tree[i].parent;
        require(same, "all models of a batch must have the same bodies, hinges, loads and drives");
    }
}

nb::dict samples_of(const Samples& f, const Model& model, size_t n) {
    const size_t bodies = static_cast<size_t>(model.tree.bodies()), hinges = model.hinges.size();
    nb::dict d;
    d["q"] = to_array(f.q, {n, static_cast<size_t>(model.tree.dofs())});
    d["w"] = to_array(f.w, {n, static_cast<size_t>(model.tree.dofs())});
    d["pose"] = to_array(f.pose, {n, bodies, 3});
    d["velocity"] = to_array(f.velocity, {n, bodies, 3});
    d["hinge"] = columns(f.hinge, {n, hinges});
    d["hinge_energy"] = columns(f.hinge_energy, {n, hinges});
    d["energy"] = columns(f.energy, {n});
    return d;
}

nb::dict to_dict(const EndValues& f, const Model& model, size_t n) {
    const size_t bodies = static_cast<size_t>(model.tree.bodies()), dofs = static_cast<size_t>(model.tree.dofs());
    const size_t hinges = model.hinges.size();
    nb::dict d;
    d["time"] = to_array(f.time, {n});
    d["q"] = to_array(f.q, {n, dofs});
    d["w"] = to_array(f.w, {n, dofs});
    d["pose"] = to_array(f.pose, {n, bodies, 3});
    d["velocity"] = to_array(f.velocity, {n, bodies, 3});
    d["hinge"] = columns(f.hinge, {n, hinges});
    d["hinge_energy"] = columns(f.hinge_energy, {n, hinges});
    d["summary"] = columns(f.summary, {n, hinges});
    d["energy"] = columns(f.energy, {n});
    d["residual"] = to_array(f.residual, {n});
    d["lost"] = to_array(f.lost, {n});
    d["outcome"] = to_array(f.outcome, {n});
    d["steps"] = to_array(f.steps, {n});
    return d;
}

nb::dict solve(const std::vector<const Model*>& models, const InNumbers& model_of, double end, const Rows& velocity,
               const Rows& impulse, const Rows& capacity_scale, const Rows& load_scale, const Rows& bodies,
               const Rows& gravity, double accuracy, double minimum_step, double maximum_step, int threads,
               nb::object poll, const std::vector<double>& times, int parts) {
    require_all(models);
    require_one_topology(models);
    require_settings(accuracy, minimum_step, maximum_step, parts);
    require(std::isfinite(end) && end > 0, "the end must come after the start");
    require_sample_times(times, end);
    const Model& first = *models.front();
    const auto n = static_cast<size_t>(first.tree.bodies());
    Variations v;
    v.count = model_of.shape(0);
    v.models = models;
    v.model = model_of.data();
    for (size_t i = 0; i < v.count; i++) {
        require(v.model[i] >= 0 && static_cast<size_t>(v.model[i]) < models.size(), "a variant names an unknown model");
    }
    v.velocity = rows(velocity, v.count, 3 * n, "velocity must have shape (variants, bodies, 3)");
    v.impulse = rows(impulse, v.count, 3 * n, "impulse must have shape (variants, bodies, 3)");
    v.capacity_scale = rows(capacity_scale, v.count, first.hinges.size(), "capacity_scale must have shape (variants, hinges)");
    v.load_scale = rows(load_scale, v.count, first.loads.size(), "load_scale must have shape (variants, loads)");
    v.bodies = rows(bodies, v.count, 4 * n, "bodies must have shape (variants, bodies, 4)");
    v.gravity = rows(gravity, v.count, 2, "gravity must have shape (variants, 2)");
    v.times = times;
    const Settings settings{accuracy, minimum_step, maximum_step, parts};
    const EndValues end_values = unlocked(poll, [&](const auto& ask) { return solve_many(v, end, settings, threads, ask); });
    nb::dict found = to_dict(end_values, first, v.count);
    if (!times.empty()) found["samples"] = samples_of(end_values.samples, first, v.count * times.size());
    return found;
}

}  // namespace

void bind_batch(nb::module_& m) {
    m.def("solve_many", &solve, nb::arg("models"), nb::arg("model_of"), nb::arg("end"), nb::arg("velocity").none(),
          nb::arg("impulse").none(), nb::arg("capacity_scale").none(), nb::arg("load_scale").none(), nb::arg("bodies").none(),
          nb::arg("gravity").none(), nb::arg("accuracy"), nb::arg("minimum_step"), nb::arg("maximum_step"), nb::arg("threads"),
          nb::arg("poll").none(), nb::arg("times") = std::vector<double>{}, nb::arg("parts") = 1,
          "Solve every variant as one run would, on several threads.");
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
