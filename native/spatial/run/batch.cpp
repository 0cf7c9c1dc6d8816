#include "spatial/run/batch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/tasks.hpp"

namespace crumple::spatial {

namespace {

Vec3 vector(const double* v) { return {v[0], v[1], v[2]}; }

// Points of a body keep their positions in the world when its centre of mass is changed.
void set_body(Model& model, size_t index, const double* row) {
    Body& body = model.bodies[index];
    const Vec3 shift = vector(row) - body.centre;
    const int i = static_cast<int>(index);
    auto move = [&](int owner, Vec3& arm) {
        if (owner == i) arm = arm - shift;
    };
    for (Joint& joint : model.joints) {
        for (int k = 0; k < 2; k++) move(joint.body[k], joint.arm[k]);
    }
    for (Spring& spring : model.springs) {
        for (int k = 0; k < 2; k++) move(spring.body[k], spring.arm[k]);
    }
    for (Load& load : model.loads) move(load.body, load.arm);
    for (Obstacle& obstacle : model.contact.obstacles) move(obstacle.body, obstacle.solid.point);
    for (Capsule& capsule : model.contact.capsules) {
        move(capsule.body, capsule.segment.first);
        move(capsule.body, capsule.segment.second);
    }
    body.centre = vector(row);
    body.mass = row[3];
    body.inertia = {{vector(row + 4), vector(row + 7), vector(row + 10)}};
    body.inverse = inverse(body.inertia);
}

Model varied(const Variations& v, const Case& of, size_t row) {
    Model model = of.model;
    const size_t bodies = model.bodies.size();
    for (size_t i = 0; v.bodies && i < bodies; i++) set_body(model, i, v.bodies + body_columns * (row * bodies + i));
    for (size_t j = 0; v.capacity_scale && j < model.hinges.size(); j++) {
        for (Component& c : model.hinges[j].components) c.law.scale *= v.capacity_scale[row * model.hinges.size() + j];
    }
    for (size_t j = 0; v.load_scale && j < model.loads.size(); j++) {
        const double scale = v.load_scale[row * model.loads.size() + j];
        model.loads[j].force = scale * model.loads[j].force;
        model.loads[j].moment = scale * model.loads[j].moment;
    }
    if (v.gravity) model.gravity = vector(v.gravity + 3 * row);
    return model;
}

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool positive(const Body& body) {
    const Vec3 *r = body.inertia.r, minor = cross(r[0], r[1]);
    const bool rotary = r[0].x > 0 && minor.z > 0 && dot(minor, r[2]) > 0;
    return body.mass > 0 && std::isfinite(body.mass) && rotary && finite(r[0]) && finite(r[1]) && finite(r[2]) && finite(body.centre);
}

// whether the values are admissible: positive masses, inertias and capacities, finite loads
bool sensible(const Model& model) {
    for (const Body& body : model.bodies) {
        if (!positive(body)) return false;
    }
    for (const SpatialHinge& hinge : model.hinges) {
        for (const Component& c : hinge.components) {
            if (!(c.law.scale > 0 && std::isfinite(c.law.scale))) return false;
        }
    }
    for (const Load& load : model.loads) {
        if (!finite(load.force) || !finite(load.moment)) return false;
    }
    return finite(model.gravity);
}

std::vector<Twist> twists(const double* rows, size_t row, size_t count, bool& all_finite) {
    std::vector<Twist> out(count);
    for (size_t i = 0; rows && i < count; i++) {
        const double* t = rows + 6 * (row * count + i);
        out[i] = {vector(t), vector(t + 3)};
        all_finite = all_finite && finite(out[i].w) && finite(out[i].v);
    }
    return out;
}

// Runs one variant through the stages of its case and stores the end values in its row.
class Tour {
public:
    Tour(const Variations& v, size_t row, const Settings& settings, EndValues& out)
        : times_(v.times), of_(*v.cases[v.case_of ? static_cast<size_t>(v.case_of[row]) : 0]), row_(row), out_(out) {
        out_.outcome[row] = static_cast<int>(Outcome::refused);
        Model model = varied(v, of_, row);
        const size_t count = of_.stages.size() * model.bodies.size();
        bool all_finite = true;
        velocity_ = twists(v.velocity, row, count, all_finite);
        impulse_ = twists(v.impulse, row, count, all_finite);
        if (all_finite && sensible(model)) simulation_.emplace(std::move(model), settings);
    }
    // stores the steps of every stage in `step_records` unless that is null
    void run(const std::function<bool(double)>& go_on, std::vector<StepRecords>* step_records) {
        Outcome outcome = Outcome::complete;
        for (size_t k = 0; simulation_ && k < of_.stages.size() && outcome == Outcome::complete; k++) {
            begin(k);
            if (step_records) simulation_->keep(&step_records->emplace_back());
            const double end = simulation_->state().t + of_.stages[k].duration;
            std::vector<double> times;
            // a stage that ended on a condition is followed by one that begins between the samples
            for (const double t : times_) {
                if (t >= simulation_->state().t && t < end) times.push_back(t);
            }
            times.push_back(end);
            const Record record = simulation_->run(times, go_on);
            simulation_->keep(nullptr);
            keep(record);
            outcome = record.outcome;
            out_.residual[row_] = std::max(out_.residual[row_], record.residual);
            out_.steps[row_] += record.steps;
        }
        store(outcome);
    }
    // of the steps of `run`; null if the variant was refused
    std::shared_ptr<const Guide> keep_guide() {
        if (!simulation_) return nullptr;
        simulation_->keep_guide();
        return simulation_->guide();
    }
    void be_guided_by(const std::shared_ptr<const Guide>& lead) {
        if (simulation_) simulation_->be_guided_by(lead);
    }
    void follow(const std::vector<StepRecords>& step_records) {
        bool solved = true;
        for (size_t k = 0; simulation_ && k < step_records.size() && solved; k++) {
            begin(k);
            solved = simulation_->follow(step_records[k]);
            out_.steps[row_] += static_cast<int64_t>(step_records[k].size());
        }
        store(solved ? Outcome::complete : Outcome::step_collapsed);
    }

private:
    void begin(size_t k) {
        const CaseStage& stage = of_.stages[k];
        const size_t first = k * of_.model.bodies.size();
        simulation_->begin_stage(stage.quasi_static, stage.drives, stage.obstacles, stage.until);
        out_.lost[row_] += simulation_->set_motion(velocity_.data() + first, impulse_.data() + first);
    }
    void store(Outcome outcome);
    void keep(const Record& record);

    const std::vector<double>& times_;
    size_t kept_ = 0;  // samples so far
    const Case& of_;
    size_t row_;
    EndValues& out_;
    std::vector<Twist> velocity_, impulse_;
    std::optional<Simulation> simulation_;
};

void Tour::store(Outcome outcome) {
    if (!simulation_) return;
    const Record last = simulation_->present();
    out_.time[row_] = last.time.back();
    std::vector<double> start;
    for (const Body& body : simulation_->model().bodies) start.insert(start.end(), {body.centre.x, body.centre.y, body.centre.z});
    put(out_.start, row_, start);
    put(out_.centre, row_, last.centre);
    put(out_.rotation, row_, last.rotation);
    put(out_.velocity, row_, last.velocity);
    put_row(out_.hinge, row_, last.hinge);
    put_row(out_.hinge_energy, row_, last.hinge_energy);
    put_row(out_.summary, row_, simulation_->summary());
    put_row(out_.energy, row_, last.energy);
    out_.outcome[row_] = static_cast<int>(outcome);
}

// the rows of a stage that are at the times of samples
void Tour::keep(const Record& record) {
    const size_t rows = record.time.size();
    Samples& out = out_.samples;
    for (size_t i = 0; i < rows && kept_ < times_.size(); i++) {
        // a stage's end is rounded, and what it leaves out begins the next one
        if (std::fabs(record.time[i] - times_[kept_]) > 1e-12 * times_.back()) continue;
        const size_t row = row_ * times_.size() + kept_++;
        put_from(out.centre, row, record.centre, i, rows);
        put_from(out.rotation, row, record.rotation, i, rows);
        put_from(out.velocity, row, record.velocity, i, rows);
        put_record(out.hinge, row, record.hinge, i, rows);
        put_record(out.hinge_energy, row, record.hinge_energy, i, rows);
        put_record(out.energy, row, record.energy, i, rows);
    }
}

}  // namespace

bool alike(const Case& a, const Case& b) {
    const Model &m = a.model, &n = b.model;
    bool same = m.bodies.size() == n.bodies.size() && m.joints.size() == n.joints.size() && m.hinges.size() == n.hinges.size() &&
                m.loads.size() == n.loads.size() && m.springs.size() == n.springs.size() && m.drives.size() == n.drives.size() &&
                m.contact.obstacles.size() == n.contact.obstacles.size() && a.stages.size() == b.stages.size();
    for (size_t j = 0; same && j < m.joints.size(); j++) {
        for (int k = 0; k < 2; k++) same = same && m.joints[j].body[k] == n.joints[j].body[k];
    }
    for (size_t j = 0; same && j < m.hinges.size(); j++) same = size(m.hinges[j]) == size(n.hinges[j]);
    return same;
}

EndValues sized(const Case& of, size_t n, size_t times) {
    const size_t bodies = of.model.bodies.size(), hinges = of.model.hinges.size();
    size_t components = 0;
    for (const SpatialHinge& hinge : of.model.hinges) components += static_cast<size_t>(size(hinge));
    EndValues out;
    for (auto* column : {&out.time, &out.residual, &out.lost}) column->assign(n, 0.0);
    for (auto* column : {&out.start, &out.centre}) column->assign(n * bodies * 3, 0.0);
    out.rotation.assign(n * bodies * 4, 0.0);
    out.velocity.assign(n * bodies * 6, 0.0);
    resize(out.hinge, n * components);
    resize(out.hinge_energy, n * hinges);
    resize(out.summary, n * hinges);
    resize(out.energy, n);
    const size_t samples = n * times;
    out.samples.centre.assign(samples * bodies * 3, 0.0);
    out.samples.rotation.assign(samples * bodies * 4, 0.0);
    out.samples.velocity.assign(samples * bodies * 6, 0.0);
    resize(out.samples.hinge, samples * components);
    resize(out.samples.hinge_energy, samples * hinges);
    resize(out.samples.energy, samples);
    out.steps.assign(n, 0);
    out.outcome.assign(n, static_cast<int>(Outcome::cancelled));
    return out;
}

EndValues solve_many(const Variations& v, const Settings& settings, int threads, const std::function<bool(double)>& poll) {
    EndValues out = sized(*v.cases.front(), v.count, v.times.size());
    auto solve = [&](size_t row, const std::function<bool(double)>& go_on) { Tour(v, row, settings, out).run(go_on, nullptr); };
    // a variant takes a millisecond or more, so threads take one at a time
    share_out(v.count, 1, threads, solve, poll);
    return out;
}

EndValues solve_led(const Variations& v, const Settings& settings, int threads, const std::function<bool(double)>& poll) {
    EndValues out = sized(*v.cases.front(), v.count, v.times.size());
    std::vector<StepRecords> step_records;
    auto lead = [&](size_t row, const std::function<bool(double)>& go_on) { Tour(v, row, settings, out).run(go_on, &step_records); };
    share_out(std::min<size_t>(v.count, 1), 1, 1, lead, poll);
    auto follow = [&](size_t row, const std::function<bool(double)>&) { Tour(v, row + 1, settings, out).follow(step_records); };
    if (v.count > 1) share_out(v.count - 1, 1, threads, follow, poll);
    return out;
}

EndValues solve_guided(const Variations& v, const Settings& settings, int threads, const std::function<bool(double)>& poll) {
    EndValues out = sized(*v.cases.front(), v.count, v.times.size());
    std::shared_ptr<const Guide> guide;
    auto lead = [&](size_t row, const std::function<bool(double)>& go_on) {
        Tour tour(v, row, settings, out);
        guide = tour.keep_guide();
        tour.run(go_on, nullptr);
    };
    share_out(std::min<size_t>(v.count, 1), 1, 1, lead, poll);
    auto solve = [&](size_t row, const std::function<bool(double)>& go_on) {
        Tour tour(v, row + 1, settings, out);
        tour.be_guided_by(guide);
        tour.run(go_on, nullptr);
    };
    if (v.count > 1) share_out(v.count - 1, 1, threads, solve, poll);
    return out;
}

}  // namespace crumple::spatial
