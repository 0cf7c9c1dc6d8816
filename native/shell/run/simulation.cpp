// Construction of the state, and the time stepping loop.
#include "shell/run/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "common/team.hpp"

namespace crumple::shell {

namespace {

// With fewer elements per thread the barriers cost more than another thread gains.
constexpr std::size_t elements_per_thread = 500;
// States with more numbers than this are prefetched; smaller ones stay in the cache.
constexpr std::size_t largest_in_cache = 500'000;
// Steps between readings of the clock.
constexpr std::int64_t steps_per_look = 16;

}  // namespace

Simulation::Simulation(std::shared_ptr<const Model> model, const Kernels& kernels)
    : model_(std::move(model)), kernels_(kernels), masses_(lump(*model_)), blocks_(block_up(*model_, kernels.lanes)) {
    for (const RigidSet& set : model_->rigid_sets) {
        bodies_.push_back(make_body(*model_, set, masses_));
        body_states_.push_back(start_body(bodies_.back(), *model_, masses_));
    }
    place_nodes();
    sort_drives();
    welds_ = std::make_unique<SpotWelds>(*model_, masses_);
    sort_welds();
    fit_welds();
    start_elements();
    double step = std::numeric_limits<double>::max();
    for (std::size_t e = 0; e < model_->elements(); e++)
        step = std::min(step, first_stable_step(*model_, e) * std::sqrt(masses_.scale[e] / masses_.loose[e]));
    first_dt_ = model_->settings.safety * step;
    contact_ = std::make_unique<Contact>(*model_, masses_, first_dt_);
    contact_->obstacles().attach(bodies_, body_states_);
    contact_->obstacles().place(motions());
    contact_->search(motions(), alive_, {});
    // contact forces at the start; the elements are free of stress
    contact_->prepare(0.0);
    contact_->evaluate(motions(), {});
    contact_->turn_over(motions());
    contact_->sum(motions(), {});
    first_kinetic_ = kinetic();      // before the first step, with the velocities as given
    dt_ = first_dt_;
    for (Driven& d : driven_) std::copy_n(kick_driven(d).outside, 6, d.outside);
}

void Simulation::place_nodes() {
    const std::size_t n = model_->nodes();
    position_.assign(position_record * n, 0.0);
    velocity_.assign(velocity_record * n, 0.0);
    inverse_mass_.assign(velocity_record * n, 0.0);
    kind_.assign(n, 0);
    damping_work_.assign(n / node_chunk + 1, 0.0);
    for (std::size_t i = 0; i < n; i++) {
        for (std::size_t k = 0; k < 6; k++) {
            const bool held = model_->fixed[i] & (1u << k);
            const double mass = k < 3 ? masses_.mass[i] : masses_.inertia[i];
            const std::size_t at = velocity_record * i + (k < 3 ? k : k + 1);
            inverse_mass_[at] = held || !(mass > 0.0) ? 0.0 : 1.0 / mass;
            velocity_[at] = held ? 0.0 : (k < 3 ? model_->velocity[3 * i + k] : model_->spin[3 * i + k - 3]);
        }
        write3(&position_[position_record * i], read3(&model_->position[3 * i]));
    }
    for (std::size_t b = 0; b < bodies_.size(); b++)
        for (std::size_t k = 0; k < bodies_[b].nodes.size(); k++) {
            const Index i = bodies_[b].nodes[k];
            const RigidState& s = body_states_[b];
            kind_[i] = 1;
            write3(&velocity_[velocity_record * i], s.velocity + cross(s.omega, bodies_[b].arm[k]));
            write3(&velocity_[velocity_record * i + 4], s.omega);
        }
}

void Simulation::sort_drives() {
    std::vector<std::int64_t> body_of(model_->nodes(), -1), place(model_->nodes(), -1);
    for (std::size_t b = 0; b < bodies_.size(); b++)
        for (Index n : bodies_[b].nodes) body_of[n] = std::int64_t(b);
    body_drives_.assign(bodies_.size(), BodyDrive{});
    auto driven = [&](Index n) -> Driven& {
        if (place[n] < 0) {
            place[n] = std::int64_t(driven_.size());
            driven_.push_back(Driven{n, 0, {}, {}, {}});
            kind_[n] = 2;
        }
        return driven_[std::size_t(place[n])];
    };
    for (std::size_t i = 0; i < model_->loads.size(); i++) {
        const Index n = model_->loads[i].node;
        (body_of[n] >= 0 ? body_drives_[std::size_t(body_of[n])].loads : driven(n).loads).push_back(i);
    }
    for (std::size_t i = 0; i < model_->motions.size(); i++) {
        const Motion& a = model_->motions[i];
        if (a.rigid) {
            body_drives_[a.target].motions.push_back(i);
            bodies_[a.target].held |= 1u << a.dof;
        } else {
            driven(a.target).motions.push_back(i);
            driven(a.target).held |= 1u << a.dof;
        }
    }
}

void Simulation::start_elements() {
    state_.assign(blocks_.offset.back(), 0.0);
    sum_.assign(std::size_t(corner_record) * blocks_.sum_of.size(), 0.0);
    kept_.assign(std::size_t(corner_record) * blocks_.chunks.kept_corner.size(), 0.0);
    alive_.assign(model_->elements(), 1);
    std::size_t e = 0;
    for (std::size_t place = 0; place < blocks_.element_of.size(); place++) {
        // copies have the initial state of the element they copy
        if (blocks_.element_of[place] >= 0) e = std::size_t(blocks_.element_of[place]);
        const std::size_t block = place / std::size_t(blocks_.lanes), lane = place % std::size_t(blocks_.lanes);
        const Part& part = blocks_.parts[blocks_.part_of[block]];
        auto slot = [&](int s) -> double& { return state_[blocks_.offset[block] + std::size_t(s * blocks_.lanes) + lane]; };
        slot(thickness) = model_->thickness[e];
        slot(volume0) = model_->thickness[e] * area_of(*model_, e);
        slot(wave) = (part.formulation == Formulation::triangle ? 3.0 : 4.0) * part.plane_modulus * masses_.loose[e] / (part.density * masses_.scale[e]);
        slot(alive) = 1.0;
        can_fail_ |= part.fails;
    }
}

ElementStage Simulation::element_stage(double dt, double* corner) {
    const double least = model_->settings.least_step / model_->settings.safety;
    return {position_.data(), velocity_.data(), blocks_.nodes.data(), blocks_.part_of.data(), blocks_.offset.data(),
            blocks_.parts.data(), state_.data(), corner, dt,
            state_.size() > largest_in_cache, 4.0 / (least * least)};
}

// merges two reports; of all bad blocks the first is kept, independent of the order of merging
static void add(ElementReport& sum, const ElementReport& r) {
    if (r.bad_block >= 0) sum.bad_block = sum.bad_block < 0 ? r.bad_block : std::min(sum.bad_block, r.bad_block);
    sum.frequency = std::max(sum.frequency, r.frequency);
}

void Simulation::move_elements(const ElementStage& stage, std::size_t i, ElementReport& report) {
    const Chunks& c = blocks_.chunks;
    add(report, kernels_.elements(stage, c.block[i], c.block[i + 1]));
    kernels_.sums({stage.corner, c.first.data(), c.corner_of.data(), sum_.data()}, c.sums[i], c.sums[i + 1]);
    for (std::size_t j = c.kept[i]; j < c.kept[i + 1]; j++)
        std::copy_n(stage.corner + std::size_t(corner_record) * c.kept_corner[j], corner_record, &kept_[corner_record * j]);
}

NodeStage Simulation::node_stage() {
    const Settings& s = model_->settings;
    return {position_.data(), velocity_.data(), inverse_mass_.data(), sum_.data(), contact_->any() ? contact_->force() : nullptr,
            contact_->seen(), kind_.data(), blocks_.first.data(), blocks_.sum_of.data(), damping_work_.data(), kick(), dt_, s.damping,
            {s.gravity.x, s.gravity.y, s.gravity.z}};
}

double Simulation::move_nodes(Range range) { return kernels_.nodes(node_stage(), range.first, range.last); }

// sets the next time step from the elements' reports, or the reason why the run ends
void Simulation::end_step(const std::vector<ElementReport>& reports) {
    ElementReport all;
    for (const ElementReport& r : reports) add(all, r);
    if (all.bad_block >= 0) note_failure(all);
    last_dt_ = dt_;
    time_ += dt_;
    steps_++;
    if (end_ != End::running) return;
    contact_->turn_over(motions());
    sort_welds();
    // the step grows slowly if the stable step does; with all elements deleted it is kept
    const double stable = all.frequency > 0.0 ? model_->settings.safety * 2.0 / std::sqrt(all.frequency) : dt_;
    dt_ = std::min(stable, 1.02 * dt_);
}

// as in frame.hpp
static bool is_inverted(const Vec3 (&x)[4]) {
    const Vec3 d31 = x[2] - x[0], d42 = x[3] - x[1], normal = cross(d31, d42), h = (x[0] + x[2]) - (x[1] + x[3]);
    const double area = dot(normal, normal), first = dot(h, cross(normal, d42)), second = dot(h, cross(normal, d31));
    return std::max(std::abs(first), std::abs(second)) > 3.0 * area;
}

// finds the failed element of a block: the first with a non-finite state or inverted shape, else the torn or the smallest one
void Simulation::note_failure(const ElementReport& r) {
    const std::size_t block = std::size_t(r.bad_block);
    end_ = std::isinf(r.frequency) ? End::torn : End::step_collapsed;
    double worst = -1.0;
    for (std::size_t lane = 0; lane < std::size_t(blocks_.lanes); lane++) {
        const std::int64_t e = blocks_.element_of[block * std::size_t(blocks_.lanes) + lane];
        if (e < 0) continue;
        Vec3 x[4], v[4];
        for (std::size_t c = 0; c < 4; c++) {
            x[c] = read3(&position_[position_record * model_->quads[4 * std::size_t(e) + c]]);
            v[c] = read3(&velocity_[velocity_record * model_->quads[4 * std::size_t(e) + c]]);
        }
        const double area = norm(cross(x[2] - x[0], x[3] - x[1]));
        if (!std::isfinite(area) || !std::isfinite(slot(std::size_t(e), internal_energy))) {
            end_ = End::not_finite;
            failed_element_ = e;
            return;
        }
        if (std::isinf(r.frequency) && !model_->triangle(std::size_t(e)) && is_inverted(x)) {
            end_ = End::inverted;
            failed_element_ = e;
            return;
        }
        const double speed = std::max(norm(v[2] - v[0]), norm(v[3] - v[1])), badness = (end_ == End::torn ? speed : 1.0) / area;
        if (badness > worst) {
            worst = badness;
            failed_element_ = e;
        }
    }
}

void Simulation::update_alive() {
    for (std::size_t e = 0; e < alive_.size(); e++) alive_[e] = slot(e, alive) > 0.5;
}

// sums the contact forces and searches if due; a run that has failed keeps the forces of the previous step
void Simulation::end_contact(const Member& member) {
    if (!contact_->any() || end_ != End::running) return;
    contact_->sum(motions(), member);
    member.meet([&] {
        contact_->commit(last_dt_);
        if (contact_->search_due() && can_fail_) update_alive();
    });
    if (contact_->search_due()) contact_->search(motions(), alive_, member);
}

End Simulation::advance(double until, double seconds, std::int64_t steps, int threads) {
    if (end_ != End::running) return end_;
    const auto start = std::chrono::steady_clock::now();
    const std::int64_t last_step = steps_ + std::min(steps, std::numeric_limits<std::int64_t>::max() - steps_);
    const std::size_t useful = std::max<std::size_t>(1, model_->elements() / elements_per_thread);
    const int members = team_.gather(int(std::min<std::size_t>(useful, std::size_t(std::max(threads, 1)))));
    std::vector<ElementReport> reports;
    reports.resize(std::size_t(members));
    std::vector<double> ways(reports.size(), 0.0);
    Shares shares(members);
    bool go = true;
    auto decide = [&] {
        go = end_ == End::running && time_ < until && steps_ < last_step;
        if (go && steps_ % steps_per_look == 0)
            go = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds;
    };
    decide();
    team_.run([&](const Member& member) {
        aligned_vector<double> corner = chunk_corners();
        while (go) {
            // update velocities and positions of the nodes with the forces of the last step
            double& way = ways[std::size_t(member.index)];
            way = move_nodes(member.share(model_->nodes(), node_chunk));
            if (member.index == 0) {
                move_driven();
                move_bodies();
                move_welds();
                contact_->obstacles().move(time_, kick(), dt_);
                way = std::max(way, way_of_others());
            }
            member.meet([&] {
                contact_->prepare(*std::max_element(ways.begin(), ways.end()));
                shares.deal(blocks_.chunks.count());
            });
            // compute the forces of elements and contact at the new positions
            ElementReport report;
            const ElementStage stage = element_stage(dt_, corner.data());
            shares.take(member, [&](std::size_t chunk) { move_elements(stage, chunk, report); });
            reports[std::size_t(member.index)] = report;
            contact_->evaluate(motions(), member);
            member.meet([&] {
                end_step(reports);
                decide();
            });
            end_contact(member);
        }
    });
    return end_ != End::running ? end_ : time_ >= until ? End::reached : End::running;
}

void Simulation::deform(const double* position, const double* velocity, const double* spin, double dt) {
    for (std::size_t i = 0; i < model_->nodes(); i++) {
        write3(&position_[position_record * i], read3(position + 3 * i));
        write3(&velocity_[velocity_record * i], read3(velocity + 3 * i));
        write3(&velocity_[velocity_record * i + 4], read3(spin + 3 * i));
    }
    aligned_vector<double> corner = chunk_corners();
    ElementReport report;
    for (std::size_t i = 0; i < blocks_.chunks.count(); i++) move_elements(element_stage(dt, corner.data()), i, report);
}

}  // namespace crumple::shell
