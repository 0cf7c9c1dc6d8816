#include "spatial/hinge/capacities.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

constexpr int most = most_components;
// Change of a softening variable [rad or m] below which the mean capacity is taken at the middle: differences of areas lose digits.
constexpr double smallest_mean = 1e-7;
// Flow in a step [rad or m] up to which a hinge creeps: D_0 then changes by the work of the flow at the point of the surface found last.
constexpr double smallest_flow = 1e-8;
// Flow in a step [rad or m] that is the rounding of an elastic rotation.
constexpr double no_flow = 1e-15;
// Share of the capacity in one sense up to which the centre of the set moves in that sense, so that the set keeps both halves.
constexpr double farthest = 0.9;
// Share of the torque that shear forces leave at least: those above what the walls carry are of vibration.
constexpr double least_torque = 0.1;
// Share of its first moment that a fold has lost when it turns about its flange: a fifth to a third of it in shells.
constexpr double folded = 0.3;

bool driven(const SpatialHinge& hinge) {
    for (const Component& c : hinge.components) {
        if (c.driver >= 0) return true;
    }
    return false;
}

// Softening measure per rotation about an axis alone: the initial capacity, along which the centre moves that of another component.
double weight_of(const SpatialHinge& hinge, int k, int sense) {
    const Component& c = hinge.components[static_cast<size_t>(k)];
    return c.softens * first_capacity(hinge, c.shift.values().empty() ? k : c.driver, sense);
}

// Work D_0(e) of a proportional rotation by e at the initial capacities, and the point of the surface where it is found.  `guess`: such a
// point for a similar e, or null.
SurfacePoint measure_from(const SpatialHinge& hinge, const double* e, const double* guess) {
    const int n = size(hinge);
    const double none[most] = {};
    double y[most];
    for (int k = 0; k < n; k++) y[k] = e[k] * weight_of(hinge, k, e[k] < 0 ? 1 : 0);
    return nearest(hinge.surface, n, y, none, guess, nullptr, true);
}

bool spreads(const Component& c) { return !c.spread[0].values().empty() || !c.spread[1].values().empty(); }

// Flow up to which a component spreads over the member in the sense of e.
double spread_end(const Component& c, double e) {
    const hinge::Curve& curve = c.spread[e < 0 ? 1 : 0];
    return curve.values().empty() ? 0 : curve.places().back();
}

// What a plastic rotation has beyond what spreads over the member.
void beyond_spread(const SpatialHinge& hinge, const double* e, double* left) {
    for (int k = 0; k < size(hinge); k++) {
        const Component& c = hinge.components[static_cast<size_t>(k)];
        left[k] = std::copysign(std::max(std::fabs(e[k]) - spread_end(c, e[k]), 0.0), e[k]);
    }
}

// Mean of a capacity over its variable from a to b; the value at b for the elastic form.
double capacity_over(const hinge::Curve& curve, double a, double b, bool at_end, int& hint) {
    if (at_end) return curve.at(b, hint);
    if (std::fabs(b - a) < smallest_mean) return curve.at((a + b) / 2, hint);
    return (curve.integral(b, hint) - curve.integral(a, hint)) / (b - a);
}

bool bends(const SpatialHinge& hinge, int k) { return hinge.components[static_cast<size_t>(k)].freedom > 3; }

// Share of the measure of a rotation e that softens component k.  The moment about y softens by rotation about y, and by a part of that
// about z, which folds the other pair of walls; parts add up as in an ellipsoid.  Bent about a diagonal, an edge is compressed, which
// resists longer than a wall.
double own_share(const SpatialHinge& hinge, int k, const double* e) {
    if (hinge.cross_softening == 1 || !bends(hinge, k)) return 1;
    double left[most], bent = 0, apart = 0, other = 0, own = 0;
    beyond_spread(hinge, e, left);
    for (int j = 0; j < size(hinge); j++) {
        const int sense = left[j] < 0 ? 1 : 0;
        const double part = weight_of(hinge, j, sense) * left[j], of_other = hinge.cross_softening * weight_of(hinge, k, sense) * left[j];
        if (!bends(hinge, j)) {
            other += part * part;
            continue;
        }
        bent += part * part;
        apart += (j == k ? 1 : -1) * part * part;
        own += j == k ? part * part : of_other * of_other;
    }
    if (bent + other == 0) return 1;
    const double uneven = bent > 0 ? apart / bent : 1, even = 1 - uneven * uneven, relieved = 1 - hinge.edge_relief * even * even;
    return std::sqrt((relieved * relieved * own + other) / (bent + other));
}

// What softens a component before and after a flow, and the share of the flow before it exceeds the largest value so far.
struct Way {
    double from, to, held = 0;
};

Way way_to_peak(double largest, double from, double to) {
    const double peak = std::max(largest, from);
    if (to <= peak) return {peak, peak, 1};
    return {peak, to, (peak - from) / (to - from)};
}

}  // namespace

// The walls of a round tube share every shear force alike; in others each pair of walls loses its own part.
double left_by_shear(const SpatialHinge& hinge, double along_y, double along_z) {
    const double y = hinge.shear_loss[0] * std::fabs(along_y), z = hinge.shear_loss[1] * std::fabs(along_z);
    return std::max(least_torque, 1 - (hinge.round_shear ? std::hypot(y, z) : y + z));
}

void hold_by_tension(const SpatialHinge& hinge, double tension, double factor, FrozenSpatialHinge& f, int k) {
    const double most = tension * hinge.components[static_cast<size_t>(k)].flange;
    for (int sense = 0; sense < 2 && most > 0; sense++) {
        const double first = factor * first_capacity(hinge, k, sense), lost = first - f.component[k].capacity[sense];
        if (lost > 0) f.component[k].capacity[sense] += std::min(lost, most * std::min(lost / (folded * first), 1.0));
    }
}

double first_capacity(const SpatialHinge& hinge, int k, int sense) {
    int hint = 0;
    return law_of(hinge, k).scale * curve_of(law_of(hinge, k), sense).at(0, hint);
}

double measure(const SpatialHinge& hinge, const double* e) { return measure_from(hinge, e, nullptr).value; }

bool stands_still(const SpatialHinge& hinge, const double* flow) {
    return std::all_of(flow, flow + size(hinge), [](double part) { return std::fabs(part) <= no_flow; });
}

namespace {

// D_0 of what the rotation e, after a flow from the present one, has beyond what spreads over the member
SurfacePoint measure_after(const SpatialHinge& hinge, const SpatialHingeState& s, const double* e, const double* flow) {
    bool creeps = hinge.surface.coupling == Coupling::section;
    for (int k = 0; k < size(hinge); k++) creeps = creeps && std::fabs(flow[k]) <= smallest_flow;
    SurfacePoint p{{s.along[0], s.along[1], s.along[2], s.along[3]}, s.work};
    if (!creeps) {
        double left[most];
        beyond_spread(hinge, e, left);
        if (!std::all_of(left, left + size(hinge), [](double part) { return part == 0; })) return measure_from(hinge, left, s.along);
        p.value = 0;
        return p;
    }
    for (int k = 0; k < size(hinge); k++) {
        if (std::fabs(e[k]) < spread_end(hinge.components[static_cast<size_t>(k)], e[k])) continue;
        p.value += p.x[k] * weight_of(hinge, k, p.x[k] < 0 ? 1 : 0) * flow[k];
    }
    return p;
}

// what a flow from e adds to the measure where its increments are summed
double softening_by(const SpatialHinge& hinge, const double* e, const double* flow) {
    double end[most], before[most], after[most];
    for (int k = 0; k < size(hinge); k++) end[k] = e[k] + flow[k];
    beyond_spread(hinge, e, before);
    beyond_spread(hinge, end, after);
    for (int k = 0; k < size(hinge); k++) after[k] -= before[k];
    return measure(hinge, after);
}

}  // namespace

void soften(const SpatialHinge& hinge, SpatialHingeState& s, const double* e, const double* flow) {
    const SurfacePoint reached = measure_after(hinge, s, e, flow);
    const bool adds = law_of(hinge, 0).softening == Softening::accumulated && !stands_still(hinge, flow);
    s.work = reached.value;
    std::copy_n(reached.x, size(hinge), s.along);
    double start[most] = {}, added = 0;
    for (int k = 0; k < size(hinge); k++) start[k] = e[k] - flow[k];
    if (adds) added = softening_by(hinge, start, flow);
    const bool peak = law_of(hinge, 0).softening == Softening::peak;
    s.softening = peak ? std::max(s.softening, s.work) : s.softening + added;
    for (int k = 0; k < size(hinge) && hinge.cross_softening < 1; k++) {
        double& own = s.softening_of[k];
        own = peak ? std::max(own, s.work * own_share(hinge, k, e)) : own + added * own_share(hinge, k, flow);
    }
}

bool softens(const SpatialHinge& hinge) {
    if (driven(hinge)) return true;
    for (const Component& c : hinge.components) {
        if (spreads(c)) return true;
        for (const hinge::Curve* curve : {&c.law.positive, &c.law.negative}) {
            for (const double value : curve->values()) {
                if (value != curve->values().front()) return true;
            }
        }
    }
    return false;
}

bool rated(const SpatialHinge& hinge) {
    for (const Component& c : hinge.components) {
        if (std::isfinite(c.law.rate_reference)) return true;
    }
    return false;
}

namespace {

// Growth of a capacity over its variable from a to b with b: of the mean over it, or of the value at b for the elastic form; 0 if it falls.
double slope_over(const hinge::Curve& curve, double a, double b, bool at_end, int& hint) {
    const double further = capacity_over(curve, a, b + smallest_mean, at_end, hint) - capacity_over(curve, a, b, at_end, hint);
    return std::max(further, 0.0) / smallest_mean;
}

// Shares of the capacities of a component that spreads over the member, on its way to a flow `end`.
void spread_over(const Component& c, const hinge::HingeState& s, double end, FrozenSpatialHinge& f, int k) {
    const bool at_end = c.law.form == Form::elastic_plastic;
    const double so_far = std::max(s.peak[0], s.peak[1]), ahead = std::max(so_far, std::fabs(end));
    for (int sense = 0; sense < 2; sense++) {
        if (c.spread[sense].values().empty()) continue;
        int hint = 0;
        double& capacity = f.component[k].capacity[sense];
        if (f.late != 0.5 && ahead > so_far) f.slope[k] = std::max(f.slope[k], capacity * slope_over(c.spread[sense], so_far, ahead, at_end, hint));
        capacity *= capacity_over(c.spread[sense], so_far, ahead, at_end, hint);
    }
}

void mean_capacities(const SpatialHinge& hinge, const SpatialHingeState& s, const double* e, const double* flow, FrozenSpatialHinge& f) {
    const int n = size(hinge);
    const bool at_end = form_of(hinge) == Form::elastic_plastic;
    if (on_flange(hinge)) {
        const int turn = rotates(hinge, 0) ? 0 : 1;
        hinge::HingeState turned = s.component[turn];
        const hinge::HingeState& slipped = s.component[1 - turn];
        const double shortened = std::max(slipped.peak[1], -slipped.plastic - std::min(flow[1 - turn], 0.0));
        turned.peak[0] = std::max(turned.peak[0], hinge.surface.shortened_turn * shortened);
        hinge::set_capacity(law_of(hinge, turn), turned, flow[turn], f.hint[turn], f.component[turn]);
        hinge::set_capacity(law_of(hinge, 1 - turn), slipped, flow[1 - turn], f.hint[1 - turn], f.component[1 - turn]);
        if (hinge.surface.growth.values().empty()) return;
        const double so_far = std::max(turned.peak[0], turned.peak[1]);
        int hint = 0;
        f.grown = capacity_over(hinge.surface.growth, so_far, std::max(so_far, std::fabs(e[turn] + flow[turn])), at_end, hint);
        return;
    }
    if (!softens(hinge)) {
        for (int k = 0; k < n; k++) {
            for (int sense = 0; sense < 2; sense++) f.component[k].capacity[sense] = first_capacity(hinge, k, sense);
        }
        return;
    }
    double end[most] = {};
    for (int k = 0; k < n; k++) end[k] = e[k] + flow[k];
    const double none[most] = {};
    const double now = hinge.surface.coupling == Coupling::section ? s.work : measure_after(hinge, s, e, none).value;
    const double then = measure_after(hinge, s, end, flow).value;
    const Softening variable = law_of(hinge, 0).softening;
    const double added = variable == Softening::accumulated ? softening_by(hinge, e, flow) : 0;
    for (int k = 0; k < n; k++) {
        const double largest = hinge.cross_softening == 1 ? s.softening : s.softening_of[k];
        Way way{now * own_share(hinge, k, e), then * own_share(hinge, k, end)};
        if (variable == Softening::accumulated) way = {largest, largest + added * own_share(hinge, k, flow)};
        if (variable == Softening::peak) way = way_to_peak(largest, way.from, way.to);
        for (int sense = 0; sense < 2; sense++) {
            const hinge::Curve& curve = curve_of(law_of(hinge, k), sense);
            const double per_work = 1 / weight_of(hinge, k, sense);
            const double ahead = capacity_over(curve, way.from * per_work, way.to * per_work, at_end, f.hint[k][sense]);
            const double here = way.held > 0 && !at_end ? curve.at(way.from * per_work, f.hint[k][sense]) : 0;
            f.component[k].capacity[sense] = law_of(hinge, k).scale * (at_end ? ahead : way.held * here + (1 - way.held) * ahead);
            // in motion, where both ends of a step weigh the same, nothing needs it
            if (f.late == 0.5 || way.held > 0.5) continue;
            const double slope = law_of(hinge, k).scale * slope_over(curve, way.from * per_work, way.to * per_work, at_end, f.hint[k][sense]);
            f.slope[k] = std::max(f.slope[k], slope);
        }
        const Component& c = hinge.components[static_cast<size_t>(k)];
        if (spreads(c)) spread_over(c, s.component[k], end[k], f, k);
        if (c.driver < 0) continue;
        const hinge::HingeState& driver = s.component[c.driver];
        const double so_far = std::max(driver.peak[0], driver.peak[1]), ahead = std::max(so_far, std::fabs(end[c.driver]));
        int hint = 0;
        if (!c.shift.values().empty()) f.shift[k] = capacity_over(c.shift, so_far, ahead, at_end, hint);
        if (c.worn.values().empty()) continue;
        for (double& capacity : f.component[k].capacity) capacity *= 1 - capacity_over(c.worn, so_far, ahead, at_end, hint);
    }
}

// Moves the centre of an ellipsoid along a component such that the capacity about every axis alone stays: half axes in place of capacities.
void shift_centre(const SpatialHinge& hinge, FrozenSpatialHinge& f) {
    for (int k = 0; k < size(hinge); k++) {
        f.centre[k] = 0;
        if (f.shift[k] == 0) continue;
        const int far = f.shift[k] < 0 ? 0 : 1;
        double* capacity = f.component[k].capacity;
        const double share = std::fabs(f.shift[k]), way = std::min(share / (1 - share) * capacity[far], farthest * capacity[1 - far]);
        capacity[far] += way;
        capacity[1 - far] -= way;
        f.centre[k] = f.shift[k] < 0 ? -way : way;
        const double wider = 1 / std::sqrt(1 - way * way / (capacity[far] * capacity[far]));
        for (int other = 0; other < size(hinge); other++) {
            for (int sense = 0; sense < 2 && other != k; sense++) f.component[other].capacity[sense] *= wider;
        }
    }
}

// Rate factors.  For coupled components the rate is the one about their own axis that alone would dissipate the total power.
void apply_rate_factor(const SpatialHinge& hinge, const double* rate, FrozenSpatialHinge& f) {
    if (!rated(hinge) && !on_flange(hinge)) return;
    const double power = on_flange(hinge) ? 0 : measure(hinge, rate);
    for (int k = 0; k < size(hinge); k++) {
        for (int sense = 0; sense < 2; sense++) {
            const double own = on_flange(hinge) ? rate[k] : power / weight_of(hinge, k, sense);
            const double factor = hinge::rate_factor(law_of(hinge, k), own);
            f.component[k].capacity[sense] *= factor;
            if (on_flange(hinge) && rotates(hinge, k)) f.top[sense] = factor * first_capacity(hinge, k, sense);
        }
    }
}

}  // namespace

void set_coupled_capacity(const SpatialHinge& hinge, const SpatialHingeState& s, const double* e, const double* flow, const double* rate,
                          FrozenSpatialHinge& f) {
    mean_capacities(hinge, s, e, flow, f);
    for (int k = 0; k < size(hinge); k++) hold_by_tension(hinge, s.tension, 1, f, k);
    if (rate != nullptr) apply_rate_factor(hinge, rate, f);
    for (int k = 0; k < size(hinge); k++) {
        if (hinge.components[static_cast<size_t>(k)].freedom != 3) continue;
        for (double& capacity : f.component[k].capacity) capacity *= s.torque_left;
    }
    shift_centre(hinge, f);
}

}  // namespace crumple::spatial
