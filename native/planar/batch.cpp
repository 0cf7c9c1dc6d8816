#include "planar/batch.hpp"

#include <algorithm>
#include <cmath>

#include "common/tasks.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// Variants that a thread takes at a time: some milliseconds of work, so that threads rarely contend for the counter.
constexpr size_t share = 16;

Model varied(const Variations& v, size_t row) {
    Model model = *v.models[v.model ? static_cast<size_t>(v.model[row]) : 0];
    const auto bodies = static_cast<size_t>(model.tree.bodies());
    if (v.bodies) {
        for (size_t i = 0; i < bodies; i++) {
            const double* b = v.bodies + 4 * (row * bodies + i);
            Body& body = model.tree.body(static_cast<int>(i));
            body.centre = {b[0], b[1]};
            body.mass = b[2];
            body.inertia = b[3];
        }
    }
    for (size_t j = 0; v.capacity_scale && j < model.hinges.size(); j++) {
        model.hinges[j].scale *= v.capacity_scale[row * model.hinges.size() + j];
    }
    for (size_t j = 0; v.load_scale && j < model.loads.size(); j++) {
        model.loads[j].scale *= v.load_scale[row * model.loads.size() + j];
    }
    if (v.gravity) model.gravity = {v.gravity[2 * row], v.gravity[2 * row + 1]};
    return model;
}

// whether the equations have a solution: positive masses and capacities, finite loads
bool sensible(const Model& model) {
    auto positive = [](double x) { return x > 0 && std::isfinite(x); };
    for (int i = 0; i < model.tree.bodies(); i++) {
        const Body& b = model.tree[i];
        if (!positive(b.mass) || !positive(b.inertia) || !std::isfinite(b.centre.x) || !std::isfinite(b.centre.y)) return false;
    }
    for (const Hinge& h : model.hinges) {
        if (!positive(h.scale)) return false;
    }
    for (const Load& l : model.loads) {
        if (!std::isfinite(l.scale)) return false;
    }
    return std::isfinite(model.gravity.x) && std::isfinite(model.gravity.y);
}

std::vector<Twist> twists(const double* rows, size_t row, size_t bodies, bool& finite) {
    std::vector<Twist> out(bodies);
    for (size_t i = 0; rows && i < bodies; i++) {
        const double* t = rows + 3 * (row * bodies + i);
        out[i] = {t[0], {t[1], t[2]}};
        finite = finite && std::isfinite(t[0]) && std::isfinite(t[1]) && std::isfinite(t[2]);
    }
    return out;
}

// rows of a run that reached their times
void keep(const std::vector<double>& times, const Record& record, size_t row, Samples& out) {
    const size_t rows = record.time.size();
    for (size_t i = 0; i < std::min(rows, times.size()) && record.time[i] >= times[i]; i++) {
        const size_t to = row * times.size() + i;
        put_from(out.q, to, record.q, i, rows);
        put_from(out.w, to, record.w, i, rows);
        put_from(out.pose, to, record.pose, i, rows);
        put_from(out.velocity, to, record.velocity, i, rows);
        put_record(out.hinge, to, record.hinge, i, rows);
        put_record(out.hinge_energy, to, record.hinge_energy, i, rows);
        put_record(out.energy, to, record.energy, i, rows);
    }
}

void solve_row(const Variations& v, size_t row, double end, const Settings& settings,
               const std::function<bool(double)>& go_on, EndValues& out) {
    Model model = varied(v, row);
    const auto bodies = static_cast<size_t>(model.tree.bodies());
    bool finite = true;
    const std::vector<Twist> velocity = twists(v.velocity, row, bodies, finite);
    const std::vector<Twist> impulse = twists(v.impulse, row, bodies, finite);
    out.outcome[row] = static_cast<int>(Outcome::refused);
    if (!finite || !sensible(model)) return;
    Simulation simulation(std::move(model), settings);
    out.lost[row] = simulation.set_motion(velocity.data(), impulse.data());
    std::vector<double> times = v.times;
    if (times.empty() || times.back() < end) times.push_back(end);
    const Record record = simulation.run(times, go_on), last = simulation.present();
    if (!v.times.empty()) keep(v.times, record, row, out.samples);
    out.time[row] = last.time.back();
    put(out.q, row, last.q);
    put(out.w, row, last.w);
    put(out.pose, row, last.pose);
    put(out.velocity, row, last.velocity);
    put_row(out.hinge, row, last.hinge);
    put_row(out.hinge_energy, row, last.hinge_energy);
    put_row(out.energy, row, last.energy);
    put_row(out.summary, row, hinge_summary(simulation));
    out.residual[row] = record.residual;
    out.steps[row] = record.steps;
    out.outcome[row] = static_cast<int>(record.outcome);
}

EndValues sized(const Variations& v) {
    const Model& model = *v.models.front();
    const size_t n = v.count, bodies = static_cast<size_t>(model.tree.bodies()), dofs = static_cast<size_t>(model.tree.dofs());
    EndValues out;
    for (auto* column : {&out.time, &out.residual, &out.lost}) column->assign(n, 0.0);
    for (auto* column : {&out.q, &out.w}) column->assign(n * dofs, 0.0);
    for (auto* column : {&out.pose, &out.velocity}) column->assign(n * bodies * 3, 0.0);
    resize(out.hinge, n * model.hinges.size());
    resize(out.hinge_energy, n * model.hinges.size());
    resize(out.summary, n * model.hinges.size());
    resize(out.energy, n);
    const size_t samples = n * v.times.size();
    for (auto* column : {&out.samples.q, &out.samples.w}) column->assign(samples * dofs, 0.0);
    for (auto* column : {&out.samples.pose, &out.samples.velocity}) column->assign(samples * bodies * 3, 0.0);
    resize(out.samples.hinge, samples * model.hinges.size());
    resize(out.samples.hinge_energy, samples * model.hinges.size());
    resize(out.samples.energy, samples);
    out.steps.assign(n, 0);
    out.outcome.assign(n, static_cast<int>(Outcome::cancelled));
    return out;
}

}  // namespace

EndValues solve_many(const Variations& v, double end, const Settings& settings, int threads,
                  const std::function<bool(double)>& poll) {
    EndValues out = sized(v);
    auto solve = [&](size_t row, const std::function<bool(double)>& go_on) { solve_row(v, row, end, settings, go_on, out); };
    share_out(v.count, share, threads, solve, poll);
    return out;
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
