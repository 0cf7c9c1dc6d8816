// Response of a hinge to its end rates with everything else frozen: impulse, tangent, potential, and derivative over the capacities.
#include <algorithm>
#include <cmath>
#include <limits>

#include "spatial/hinge/hinge.hpp"

namespace crumple::spatial {

namespace {

constexpr int most = most_components;
// Rounding error of eight operations on a rate, 2.2e-16 each, relative to the tolerance of impulses, 1e-9.
constexpr double rounding_weight = 8 * 2.2e-16 / 1e-9;

// The problem of surface.hpp for the rates of a step.  Components are x = (tau - centre)/scale, impulses are h (centre + scale x).
struct Trial {
    // of the components that the hinge has
    double scale[most], y[most], m[most];
    double y_rate[most];  // dy_k/dw_k
    double guess[most];
    Flange flange;
};

bool on_flange(const SpatialHinge& hinge) { return hinge.surface.coupling == Coupling::tension_flange; }

Flange flange_of(const SpatialHinge& hinge, const FrozenSpatialHinge& f, double moment_sign) {
    Flange out;
    out.axial = hinge.components[0].freedom < 3 ? 0 : 1;
    const int sense = moment_sign < 0 ? 1 : 0;
    out.arm = f.grown * hinge.surface.arm;
    out.gains = &hinge.surface.gains;
    out.moment = f.component[1 - out.axial].capacity[sense];
    out.top = std::max(f.top[sense], out.moment);
    out.pull = f.component[out.axial].capacity[0];
    out.crush = f.component[out.axial].capacity[1];
    return out;
}

// Components are scaled by the capacity in the sense of their load.  The surface of the tension flange contains both senses of N, so
// it uses plain forces, weighted with the larger capacity.
Trial trial_of(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w) {
    Trial t;
    const int n = size(hinge);
    const Form form = hinge.components[0].law.form;
    double drive[most], load = 0;
    for (int k = 0; k < n; k++) {
        const hinge::Hinge& law = hinge.components[static_cast<size_t>(k)].law;
        drive[k] = form == Form::elastic_plastic ? f.tau0[k] - f.centre[k] + law.stiffness * f.h * (f.w0[k] + w[k]) / 2
                                                 : f.lead * f.w0[k] + (1 - f.lead) * w[k];
        if (hinge.components[static_cast<size_t>(k)].freedom >= 3) load = drive[k];
    }
    if (on_flange(hinge)) t.flange = flange_of(hinge, f, load);
    for (int k = 0; k < n; k++) {
        const hinge::Hinge& law = hinge.components[static_cast<size_t>(k)].law;
        const double* both = f.component[k].capacity;
        const double capacity = on_flange(hinge) ? std::max(both[0], both[1]) : both[drive[k] < 0 ? 1 : 0];
        const double c = on_flange(hinge) ? 1 : capacity;
        t.scale[k] = c;
        if (form == Form::elastic_plastic) {
            t.m[k] = c * c / law.stiffness;
            t.y[k] = c * drive[k] / law.stiffness;
            t.y_rate[k] = c * f.h / 2;
        } else {
            t.m[k] = form == Form::set_valued ? f.width * f.reference * c * c / (capacity * capacity) : 0;
            t.y[k] = c * drive[k];
            t.y_rate[k] = c * (1 - f.lead);
        }
        t.guess[k] = f.found[k];
    }
    return t;
}

SurfacePoint point_of(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const Trial& t, double* derivative) {
    if (on_flange(hinge)) return nearest(t.flange, t.y, t.m, derivative);
    const SurfacePoint p = nearest(hinge.surface, size(hinge), t.y, t.m, t.guess, derivative);
    std::copy_n(p.x, size(hinge), f.found);
    return p;
}

void scaled_block(int n, const Trial& t, double factor, const double* block, double* tangent) {
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < n; k++) tangent[j * n + k] = factor * t.scale[j] * block[j * n + k] * t.y_rate[k];
    }
}

// Capacity times ramp; the argument of the ramp is the power that the hinge would dissipate at full capacity.
void regularised_law(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
                     double* potential) {
    const int n = size(hinge);
    const Trial t = trial_of(hinge, f, w);
    const double full = f.width * f.reference;
    double block[most * most];
    const SurfacePoint p = point_of(hinge, f, t, tangent != nullptr ? block : nullptr);
    const hinge::Ramp ramp = hinge::ramp_over(f.power0 / full, p.value / full);
    for (int k = 0; k < n && impulse != nullptr; k++) impulse[k] = f.h * ramp.value * t.scale[k] * p.x[k];
    if (potential != nullptr) {
        *potential = f.h * full * hinge::ramp_over_integral(f.power0 / full, p.value / full) / (1 - f.lead);
    }
    if (tangent == nullptr) return;
    scaled_block(n, t, f.h * ramp.value, block, tangent);
    for (int j = 0; j < n; j++) {
        // at zero rates the direction is undefined: the tangent of an ellipsoid is used for all surfaces
        if (p.value == 0) tangent[j * n + j] = f.h * ramp.slope / full * t.scale[j] * t.y_rate[j];
        for (int k = 0; k < n; k++) tangent[j * n + k] += f.h * ramp.slope / full * t.scale[j] * p.x[j] * p.x[k] * t.y_rate[k];
    }
}

void coupled_law(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
                 double* potential) {
    const int n = size(hinge);
    const Form form = hinge.components[0].law.form;
    if (form == Form::regularised) return regularised_law(hinge, f, w, impulse, tangent, potential);
    const bool elastic = form == Form::elastic_plastic;
    const Trial t = trial_of(hinge, f, w);
    double block[most * most];
    const SurfacePoint p = point_of(hinge, f, t, tangent != nullptr ? block : nullptr);
    const double share = elastic ? f.late * f.h : f.h;
    double sum = elastic ? 2 * f.late * p.value : f.h * p.value / (1 - f.lead);
    for (int k = 0; k < n; k++) {
        const double start = share * ((elastic ? (1 - f.late) / f.late * f.tau0[k] : 0) + f.centre[k]);
        sum += start * w[k];
        if (impulse != nullptr) impulse[k] = start + share * t.scale[k] * p.x[k];
    }
    if (potential != nullptr) *potential = sum;
    if (tangent != nullptr) scaled_block(n, t, share, block, tangent);
}

// Fractured hinge: the remaining elastic moment decreases linearly to zero over the step.
void open_law(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
              double* potential) {
    const int n = size(hinge);
    const bool elastic = hinge.components[0].law.form == Form::elastic_plastic;
    double sum = 0;
    for (int k = 0; k < n; k++) {
        const double left = elastic ? (1 - f.late) * f.h * f.tau0[k] : 0;
        sum += left * w[k];
        if (impulse != nullptr) impulse[k] = left;
    }
    if (potential != nullptr) *potential = sum;
    if (tangent != nullptr) std::fill(tangent, tangent + n * n, 0.0);
}

void separate_law(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
                  double* potential) {
    const int n = size(hinge);
    if (tangent != nullptr) std::fill(tangent, tangent + n * n, 0.0);
    if (potential != nullptr) *potential = 0;
    for (int k = 0; k < n; k++) {
        const hinge::Hinge& law = hinge.components[static_cast<size_t>(k)].law;
        const hinge::Response r = hinge::law_response(law, f.component[k], w[k]);
        if (impulse != nullptr) impulse[k] = r.impulse;
        if (tangent != nullptr) tangent[k * n + k] = r.slope;
        if (potential != nullptr) *potential += hinge::law_potential(law, f.component[k], w[k]);
    }
}

bool falls_open(const SpatialHinge& hinge, const FrozenSpatialHinge& f) {
    return f.intact <= 0 || (f.intact < 1 && hinge.components[0].law.form == Form::elastic_plastic);
}

}  // namespace

void law(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
         double* potential) {
    if (falls_open(hinge, f)) return open_law(hinge, f, w, impulse, tangent, potential);
    if (coupled(hinge)) return coupled_law(hinge, f, w, impulse, tangent, potential);
    separate_law(hinge, f, w, impulse, tangent, potential);
}

void respond(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
             double* potential) {
    law(hinge, f, w, impulse, tangent, potential);
    add_beside(hinge, f, w, impulse, tangent, potential);
}

void add_beside(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
                double* potential) {
    const int n = size(hinge);
    for (int k = 0; k < n; k++) {
        const hinge::Hinge& one = hinge.components[static_cast<size_t>(k)].law;
        const hinge::Response r = hinge::beside_response(one, f.component[k], w[k]);
        if (impulse != nullptr) impulse[k] += r.impulse + f.h * dividing_moment(f, k, w[k]);
        if (tangent != nullptr) tangent[k * n + k] += r.slope + f.h * (f.viscous[k] + f.growth[k]);
        if (potential == nullptr) continue;
        *potential += hinge::beside_potential(one, f.component[k], w[k]);
        *potential += f.h * w[k] * ((f.viscous[k] + f.growth[k]) * w[k] / 2 - f.growth[k] * f.expected[k]);
    }
}

double power_at_capacity(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w) {
    Trial t = trial_of(hinge, f, w);
    std::fill(t.m, t.m + most, 0.0);
    double power = point_of(hinge, f, t, nullptr).value;
    for (int k = 0; k < size(hinge); k++) power += f.centre[k] * (f.lead * f.w0[k] + (1 - f.lead) * w[k]);
    return power;
}

bool round(const SpatialHinge& hinge) {
    const bool smooth = hinge.surface.coupling == Coupling::ball || hinge.surface.coupling == Coupling::ellipsoid;
    return smooth && coupled(hinge) && hinge.components[0].law.form == Form::set_valued;
}

// Newton's method on x = y/|y|, the point of the unit sphere for rates y, changes directions only in proportion to |y|: from rates that
// are too small it keeps the direction and at best doubles |y| in an iteration.  With x and s as unknowns, y = s x and |x| = 1, the
// direction follows from the impulse, as in any smooth problem; both forms have the same solutions and tangents.
bool follow_impulse(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* impulse, double* w) {
    if (falls_open(hinge, f)) return true;
    const int n = size(hinge);
    const Trial t = trial_of(hinge, f, w);
    double x[most], square = 0, along = 0;
    for (int k = 0; k < n; k++) {
        const hinge::Hinge& one = hinge.components[static_cast<size_t>(k)].law;
        x[k] = (impulse[k] - f.h * f.centre[k] - hinge::beside_response(one, f.component[k], w[k]).impulse) / (f.h * t.scale[k]) - dividing_moment(f, k, w[k]) / t.scale[k];
        square += x[k] * x[k];
        along += x[k] * t.y[k];
    }
    if (!(along > t.m[0] * std::sqrt(square))) return false;
    for (int k = 0; k < n; k++) w[k] = (along * x[k] / square / t.scale[k] - f.lead * f.w0[k]) / (1 - f.lead);
    return true;
}

double load_factor(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w) {
    if (falls_open(hinge, f)) return std::numeric_limits<double>::infinity();
    const int n = size(hinge);
    const Form form = hinge.components[0].law.form;
    if (!coupled(hinge)) {
        double most_loaded = 0;
        for (int k = 0; k < n; k++) {
            const hinge::FrozenHinge& c = f.component[k];
            double share = std::fabs(w[k]) / f.width;
            if (form == Form::elastic_plastic) {
                const double stiffness = hinge.components[static_cast<size_t>(k)].law.stiffness;
                const double trial = c.m0 + stiffness * c.h * (c.w0 + w[k]) / 2;
                share = std::fabs(trial) / c.capacity[trial < 0 ? 1 : 0];
            }
            most_loaded = std::max(most_loaded, share);
        }
        return most_loaded;
    }
    if (form == Form::regularised) return power_at_capacity(hinge, f, w) / (f.width * f.reference);
    const Trial t = trial_of(hinge, f, w);
    double x[most];
    for (int k = 0; k < n; k++) x[k] = t.y[k] / t.m[k];
    return on_flange(hinge) ? gauge(t.flange, x) : gauge(hinge.surface, n, x, nullptr);
}

// On a flat side of a surface the tangent is as large as in a locked hinge although the rates are not small, so that the rounding of
// the rates matters.
double impulse_scale(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, int k) {
    const double plain = f.h * (f.component[k].capacity[0] + f.component[k].capacity[1]);
    if (!coupled(hinge) || hinge.components[0].law.form != Form::set_valued || f.reference == 0) return plain;
    double power = 0;
    for (int j = 0; j < size(hinge); j++) power += std::max(f.component[j].capacity[0], f.component[j].capacity[1]) * std::fabs(w[j]);
    return plain * std::max(1.0, rounding_weight * power / (f.width * f.reference));
}

void capacity_sensitivity(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* derivative) {
    const int n = size(hinge);
    std::fill(derivative, derivative + n * n, 0.0);
    if (falls_open(hinge, f)) return;
    const bool elastic = hinge.components[0].law.form == Form::elastic_plastic;
    double impulse[most];
    law(hinge, f, w, impulse, nullptr, nullptr);
    if (!coupled(hinge)) {
        for (int k = 0; k < n; k++) {
            const double end = end_of(f, k, impulse[k]);
            const hinge::Hinge& one = hinge.components[static_cast<size_t>(k)].law;
            const bool bound = hinge::law_response(one, f.component[k], w[k]).slope == 0;
            derivative[k * n + k] = !elastic ? impulse[k] : bound ? f.late * f.h * end : 0;
        }
        return;
    }
    if (on_flange(hinge)) {
        // the point is linear in the capacities as long as it stays on its side or corner
        constexpr double change = 1e-6;
        for (int j = 0; j < n; j++) {
            double ends[2][most];
            for (int side = 0; side < 2; side++) {
                FrozenSpatialHinge other = f;
                const double factor = side == 0 ? 1 - change : 1 + change;
                for (double& capacity : other.component[j].capacity) capacity *= factor;
                for (double& top : other.top) top *= hinge.components[static_cast<size_t>(j)].freedom < 3 ? 1 : factor;
                law(hinge, other, w, ends[side], nullptr, nullptr);
            }
            for (int i = 0; i < n; i++) derivative[i * n + j] = (ends[1][i] - ends[0][i]) / (2 * change);
        }
        return;
    }
    const Trial t = trial_of(hinge, f, w);
    double block[most * most];
    const SurfacePoint p = point_of(hinge, f, t, block);
    const double full = f.width * f.reference;
    const bool ramped = hinge.components[0].law.form == Form::regularised;
    const hinge::Ramp ramp = ramped ? hinge::ramp_over(f.power0 / full, p.value / full) : hinge::Ramp{1, 0};
    const double share = (elastic ? f.late * f.h : f.h) * ramp.value;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const double load = elastic ? t.y[j] - 2 * t.m[j] * p.x[j] : t.y[j];
            derivative[i * n + j] = share * t.scale[i] * block[i * n + j] * load;
            derivative[i * n + j] += f.h * ramp.slope / full * t.scale[i] * p.x[i] * p.x[j] * t.y[j];
        }
        derivative[i * n + i] += share * t.scale[i] * p.x[i];
    }
}

}  // namespace crumple::spatial
