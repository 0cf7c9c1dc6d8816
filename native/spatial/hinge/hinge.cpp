#include "spatial/hinge/hinge.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/hinge/capacities.hpp"

namespace crumple::spatial {

namespace {

constexpr int most = most_components;
// The rest time of an elastic hinge ignores flow below this share of its accumulated plastic work, as with a single component.
constexpr double smallest_episode = 1e-2;
// Share of the capacity from which an elastic hinge takes part in the division of a rotation, in full at its capacity.
constexpr double divided_from = 0.9;
// Flow [rad or m] over which the change of a capacity is taken.
constexpr double small_flow = 1e-6;
// Rates below this multiple of the ramp's half-width count as rest when the rotation of the hinge's axis is evaluated.
constexpr double at_rest = 10;

// Plastic rotation that determines the softening of a coupled hinge: the integrated rates; for the ball the relative rotation itself,
// so that its angle counts independently of the path of the axis.
void plastic_rotation(const SpatialHinge& hinge, const SpatialHingeState& s, const double* q, double* e) {
    for (int k = 0; k < size(hinge); k++) {
        const hinge::HingeState& c = s.component[k];
        e[k] = c.plastic;
        if (hinge.surface.coupling != Coupling::ball) continue;
        e[k] = form_of(hinge) == Form::elastic_plastic ? q[k] - c.moment / law_of(hinge, k).stiffness : q[k];
    }
}

double larger_capacity(const FrozenSpatialHinge& f, int k) { return std::max(f.component[k].capacity[0], f.component[k].capacity[1]); }

double length_of_rotation(const SpatialHinge& hinge, const double* e) {
    double square = 0;
    for (int k = 0; k < size(hinge); k++) square += rotates(hinge, k) ? e[k] * e[k] : 0;
    return std::sqrt(square);
}

// Share t of a plastic flow from e at which the rotation reaches the fracture rotation: |e + t flow| = fracture.
double share_before_fracture(const SpatialHinge& hinge, const double* e, const double* flow) {
    if (!std::isfinite(hinge.fracture)) return 1;
    const double limit = hinge.fracture, start = length_of_rotation(hinge, e), way = length_of_rotation(hinge, flow);
    if (start >= limit) return 0;
    double along = 0;
    for (int k = 0; k < size(hinge); k++) along += rotates(hinge, k) ? e[k] * flow[k] : 0;
    const double far = limit * limit - start * start, root = std::sqrt(along * along + way * way * far);
    // solution of far = way^2 t^2 + 2 along t, in a form without cancellation
    return root + along > 0 ? std::min(1.0, far / (along + root)) : 1;
}

void break_open(const SpatialHinge& hinge, FrozenSpatialHinge& f) {
    if (f.intact >= 1) return;
    const double left = form_of(hinge) == Form::elastic_plastic ? 0 : f.intact;
    for (hinge::FrozenHinge& c : f.component) {
        for (double& capacity : c.capacity) capacity *= left;
    }
    for (double& centre : f.centre) centre *= left;
    for (double& top : f.top) top *= left;
}

// Weight of the start rate: up to 1/2 (mean rate) if the hinge slides with a rotating axis, 0 (end rate) if it comes to rest.
double lead_of(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w1) {
    double square0 = 0, square1 = 0, product = 0;
    for (int k = 0; k < size(hinge); k++) {
        const double c = larger_capacity(f, k);
        square0 += c * c * f.w0[k] * f.w0[k];
        square1 += c * c * w1[k] * w1[k];
        product += c * c * f.w0[k] * w1[k];
    }
    const double rest = at_rest * f.width * f.reference, least = std::min(square0, square1);
    if (!(least > rest * rest) || product <= 0) return 0;
    const double alike = std::min(1.0, 2 * product / (square0 + square1));
    return alike * alike * (3 - 2 * alike) / 2;
}

void set_reference(const SpatialHinge& hinge, FrozenSpatialHinge& f) {
    bool any_rotation = false;
    for (int k = 0; k < size(hinge); k++) any_rotation = any_rotation || rotates(hinge, k);
    f.reference = 0;
    for (int k = 0; k < size(hinge); k++) {
        if (rotates(hinge, k) != any_rotation) continue;
        f.reference = std::max({f.reference, f.component[k].capacity[0], f.component[k].capacity[1]});
    }
}

void freeze_coupled(const SpatialHinge& hinge, const SpatialHingeState& s, const double* q0, const double* w1,
                    FrozenSpatialHinge& f) {
    const int n = size(hinge);
    double e[most], flow[most], mean[most];
    const double none[most] = {};
    plastic_rotation(hinge, s, q0, e);
    for (int k = 0; k < n; k++) mean[k] = (f.w0[k] + w1[k]) / 2, flow[k] = f.h * mean[k];
    if (form_of(hinge) == Form::elastic_plastic) {
        set_coupled_capacity(hinge, s, e, none, nullptr, f);
        for (int sense = 0; sense < 2; sense++) {
            for (int k = 0; k < n; k++) {
                if (rotates(hinge, k)) f.top[sense] = first_capacity(hinge, k, sense);
            }
        }
        double impulse[most];
        law(hinge, f, w1, impulse, nullptr, nullptr);
        for (int k = 0; k < n; k++) flow[k] -= (end_of(f, k, impulse[k]) - f.tau0[k]) / law_of(hinge, k).stiffness;
    }
    // the capacities without flow are those of an elastic hinge that does not yield
    const bool elastic = form_of(hinge) == Form::elastic_plastic && !on_flange(hinge) && !rated(hinge);
    if (!elastic || !stands_still(hinge, flow)) set_coupled_capacity(hinge, s, e, flow, mean, f);
    set_reference(hinge, f);
    f.lead = form_of(hinge) == Form::elastic_plastic ? 0 : lead_of(hinge, f, w1);
    f.intact = s.fracture_time >= 0 ? 0 : share_before_fracture(hinge, e, flow);
    break_open(hinge, f);
    set_reference(hinge, f);
    if (form_of(hinge) == Form::regularised && f.intact > 0) f.power0 = power_at_capacity(hinge, f, f.w0);
}

void freeze_separate(const SpatialHinge& hinge, const SpatialHingeState& s, const double* q0, const double* w1,
                     FrozenSpatialHinge& f) {
    const int n = size(hinge);
    double e[most], flow[most];
    for (int k = 0; k < n; k++) {
        const hinge::Hinge& one = law_of(hinge, k);
        hinge::FrozenHinge& c = f.component[k];
        c = hinge::freeze(one, s.component[k], {f.h, f.late}, q0[k], f.w0[k], w1[k], f.hint[k]);
        hold_by_tension(hinge, s.tension, hinge::rate_factor(one, (f.w0[k] + w1[k]) / 2), f, k);
        e[k] = s.component[k].plastic;
        flow[k] = f.h * (f.w0[k] + w1[k]) / 2;
        if (form_of(hinge) == Form::elastic_plastic) {
            flow[k] -= (end_of(f, k, hinge::law_response(one, c, w1[k]).impulse) - c.m0) / one.stiffness;
        }
    }
    f.intact = s.fracture_time >= 0 ? 0 : share_before_fracture(hinge, e, flow);
    break_open(hinge, f);
    set_reference(hinge, f);
}

// Growth of the capacity of a component without coupling with its flow in the sense in which it is loaded; 0 if it falls.
double slope_alone(const hinge::Hinge& law, const hinge::HingeState& s, const FrozenSpatialHinge& f, int k) {
    const double sense = s.moment < 0 ? -1 : 1, so_far = sense * std::max(sense * f.h * (f.w0[k] + f.expected[k]) / 2, 0.0);
    hinge::FrozenHinge here, further;
    int hint[2] = {f.hint[k][0], f.hint[k][1]};
    hinge::set_capacity(law, s, so_far, hint, here);
    hinge::set_capacity(law, s, so_far + sense * small_flow, hint, further);
    const int index = sense > 0 ? 0 : 1;
    return std::max(further.capacity[index] - here.capacity[index], 0.0) / small_flow;
}

// Collects times and flags of a hinge without coupling from its components.
void gather_separate(const SpatialHinge& hinge, const FrozenSpatialHinge& f, SpatialHingeState& s, double t0, const double* before,
                     double arrest) {
    s.sliding = false;
    for (int k = 0; k < size(hinge); k++) {
        hinge::HingeState& c = s.component[k];
        s.sliding = s.sliding || c.sliding;
        if (c.rest_time == before[k]) continue;
        if (!c.sliding) c.rest_time = std::min(c.rest_time, arrest);
        s.rest_time = std::max(s.rest_time, c.rest_time);
        if (s.opening_time < 0 && f.intact > 0) s.opening_time = t0;
    }
}

// Updates the times and the episode of a coupled hinge after a flow.
void follow_flow(const SpatialHinge& hinge, const FrozenSpatialHinge& f, SpatialHingeState& s, double t0, const double* w1,
                 const double* flow, double arrest) {
    const bool elastic = form_of(hinge) == Form::elastic_plastic;
    // rigid hinges flow whenever they slide; the work of a flow shows when an elastic one does
    const double work = on_flange(hinge) || !elastic || stands_still(hinge, flow) ? 0 : measure(hinge, flow);
    double ahead = 0, start = 0;
    for (int k = 0; k < size(hinge); k++) {
        const double c = larger_capacity(f, k);
        ahead += c * c * f.w0[k] * w1[k], start += c * c * f.w0[k] * f.w0[k];
    }
    bool flowed = false, turned_back = false;
    if (elastic) {
        flowed = load_factor(hinge, f, w1) > 1;
        turned_back = (s.sliding || flowed) && ahead < 0;
        if (turned_back) {
            flowed = true;
            arrest = t0 + f.h * start / (start - ahead);
        }
        s.sliding = flowed && !turned_back;
    } else {
        FrozenSpatialHinge still = f;
        still.lead = 0;
        s.sliding = load_factor(hinge, still, w1) > 1;
        flowed = s.sliding || load_factor(hinge, still, f.w0) > 1;
    }
    double size_of_flow = work;
    if (on_flange(hinge)) {
        for (int k = 0; k < size(hinge); k++) size_of_flow += std::fabs(flow[k]) * first_capacity(hinge, k, flow[k] < 0 ? 1 : 0);
    }
    s.accumulated += size_of_flow;
    if (flowed) s.episode += size_of_flow;
    if (flowed && s.opening_time < 0 && f.intact > 0) s.opening_time = t0;
    if (flowed && (!elastic || s.episode > smallest_episode * s.accumulated)) s.rest_time = s.sliding ? t0 + f.h : arrest;
    if (!s.sliding) s.episode = 0;
}

}  // namespace

bool coupled(const SpatialHinge& hinge) { return hinge.surface.coupling != Coupling::none && size(hinge) > 1; }

double ramp_width(const SpatialHinge& hinge) { return hinge::ramp_width(law_of(hinge, 0)); }

FrozenSpatialHinge freeze(const SpatialHinge& hinge, const SpatialHingeState& s, hinge::Span step, const double* q0, const double* w0,
                        const double* w1) {
    FrozenSpatialHinge f;
    const int n = size(hinge);
    f.h = step.h;
    f.late = step.late;
    f.width = ramp_width(hinge);
    for (int k = 0; k < n; k++) {
        f.w0[k] = w0[k], f.expected[k] = w1[k];
        f.tau0[k] = s.component[k].moment;
        for (int sense = 0; sense < 2; sense++) f.hint[k][sense] = s.component[k].hint[sense];
    }
    if (!coupled(hinge)) {
        freeze_separate(hinge, s, q0, w1, f);
        return f;
    }
    for (int k = 0; k < n; k++) {
        hinge::FrozenHinge& c = f.component[k];
        c.h = f.h, c.late = f.late, c.w0 = w0[k], c.m0 = f.tau0[k], c.width = f.width;
        hinge::freeze_beside(law_of(hinge, k), q0[k], f.h * (w0[k] + w1[k]) / 2, c);
    }
    for (int k = 0; k < n; k++) {
        const double capacity = s.component[k].capacity;
        f.found[k] = capacity > 0 ? f.tau0[k] / capacity : 0;
    }
    freeze_coupled(hinge, s, q0, w1, f);
    return f;
}

void divide_shared(const SpatialHinge& hinge, const SpatialHingeState& state, FrozenSpatialHinge& f, double share, double fastest) {
    for (int k = 0; k < size(hinge) && !coupled(hinge); k++) f.slope[k] = slope_alone(law_of(hinge, k), state.component[k], f, k);
    double weight = 1;
    if (form_of(hinge) == Form::elastic_plastic) {
        // the load at the start of the step
        double back[most];
        for (int k = 0; k < size(hinge); k++) back[k] = -f.w0[k];
        const double load = std::clamp((load_factor(hinge, f, back) - divided_from) / (1 - divided_from), 0.0, 1.0);
        weight = load * load * (3 - 2 * load);
    }
    if (f.intact < 1) weight = 0;
    const double power = f.reference * fastest;
    for (int k = 0; k < size(hinge); k++) {
        const double c = larger_capacity(f, k);
        f.growth[k] = weight * f.slope[k] * f.h / 2;
        f.viscous[k] = power > 0 ? weight * share * c * c / power : 0;
    }
}

void widen(const SpatialHinge& hinge, FrozenSpatialHinge& f, double width) {
    f.width = width;
    for (int k = 0; k < size(hinge); k++) f.component[k].width = width;
}

void commit(const SpatialHinge& hinge, const FrozenSpatialHinge& f, SpatialHingeState& s, double t0, const double* q0,
            const double* w1, double* turn) {
    const int n = size(hinge);
    const bool elastic = form_of(hinge) == Form::elastic_plastic, apart = !coupled(hinge);
    double impulse[most], flow[most], before[most], e[most], q1[most], carried[most];
    law(hinge, f, w1, impulse, nullptr, nullptr);
    // forces and moments before fracture, if it fractures in this step
    for (int k = 0; k < n; k++) carried[k] = !elastic && f.intact > 0 ? impulse[k] / (f.intact * f.h) : f.tau0[k];
    const double held = elastic_energy(hinge, s);
    bool stopped = false;
    for (int k = 0; k < n; k++) stopped = stopped || hinge::stop_response(law_of(hinge, k), f.component[k], w1[k]).impulse != 0;
    // a hinge at rest at the end came to rest when its capacity had yielded the impulse
    const bool alone = form_of(hinge) == Form::set_valued && !stopped;
    const double arrest = t0 + (alone ? std::min(load_factor(hinge, f, w1), 1.0) : 1) * f.h;
    for (int k = 0; k < n; k++) {
        hinge::HingeState& c = s.component[k];
        for (int sense = 0; sense < 2; sense++) c.hint[sense] = f.hint[k][sense];
        before[k] = c.rest_time;
        turn[k] = f.h * (f.w0[k] + w1[k]) / 2;
        q1[k] = q0[k] + turn[k];
        c.damped += dividing_moment(f, k, w1[k]) * turn[k];
        if (apart) {
            hinge::commit(law_of(hinge, k), f.component[k], c, t0, q0[k], w1[k], &f.component[k].h);
            continue;
        }
        const double end = elastic ? end_of(f, k, impulse[k]) : impulse[k] / f.h;
        flow[k] = elastic ? turn[k] - (end - f.tau0[k]) / law_of(hinge, k).stiffness : turn[k];
        c.dissipated += impulse[k] / f.h * flow[k];
        if (elastic) c.damped += hinge::damped_by_weight(law_of(hinge, k), f.component[k], end);
        c.moment = end;
        const int sense = f.w0[k] + w1[k] < 0 ? 1 : 0;
        c.capacity = f.component[k].capacity[sense] + (sense == 0 ? f.centre[k] : -f.centre[k]);
        c.plastic += flow[k];
        c.accumulated += std::fabs(flow[k]);
        c.peak[0] = std::max(c.peak[0], c.plastic);
        c.peak[1] = std::max(c.peak[1], -c.plastic);
        hinge::commit_beside(law_of(hinge, k), f.component[k], c, q0[k], turn[k], w1[k]);
    }
    plastic_rotation(hinge, s, q1, e);
    if (apart) {
        gather_separate(hinge, f, s, t0, before, arrest);
    } else {
        follow_flow(hinge, f, s, t0, w1, flow, arrest);
        // only softening depends on the work so far
        if (!on_flange(hinge) && softens(hinge)) soften(hinge, s, e, flow);
    }
    s.rotation_max = std::max(s.rotation_max, length_of_rotation(hinge, q1));
    if (s.fracture_time < 0 && length_of_rotation(hinge, e) >= hinge.fracture) {
        s.fracture_time = t0 + f.intact * f.h;
        s.fracture_energy = elastic ? held : 0;
        s.fracture_moment = length_of_rotation(hinge, carried);
    }
}

double length_of_moment(const SpatialHinge& hinge, const SpatialHingeState& s) {
    double moment[most];
    for (int k = 0; k < size(hinge); k++) moment[k] = s.component[k].total_moment;
    return length_of_rotation(hinge, moment);
}

bool turning(const SpatialHinge& hinge, const SpatialHingeState& s) {
    if (!coupled(hinge)) {
        bool any = false;
        for (int k = 0; k < size(hinge); k++) any = any || hinge::turning(law_of(hinge, k), s.component[k]);
        return any;
    }
    return s.sliding && (form_of(hinge) != Form::elastic_plastic || s.episode > smallest_episode * s.accumulated);
}

}  // namespace crumple::spatial
