#include "hinge/hinge.hpp"

#include <algorithm>

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();
constexpr double half_pi = 1.57079632679489661923;
// Below this rotation [rad] the mean capacity is taken as the present one: the difference of areas would lose its digits.
constexpr double smallest_mean = 1e-7;
// After yielding, an elastic hinge vibrates with peaks just at its capacity, where errors of the step decide whether it flows.
// Its rest time ignores flow below this share of its accumulated plastic rotation.
constexpr double smallest_episode = 1e-2;
// The same for rigid hinges: in a loop, the correction of the loop's gap moves a hinge again after it has come to rest.
constexpr double smallest_rigid_episode = 1e-5;

// Capacity in one sense (0 positive, 1 negative) at the present plastic rotation; `u` is the plastic rotation counted in that
// sense.  With Softening::peak a loss of strength is permanent in both senses: folded walls do not become straight again.
Real present_capacity(const Hinge& hinge, const HingeState& s, int sense, Real u, int& hint) {
    const Curve& curve = sense == 0 ? hinge.positive : hinge.negative;
    switch (hinge.softening) {
        case Softening::rotation: return hinge.scale * curve.at(fabs(u), hint);
        case Softening::accumulated: return hinge.scale * curve.at(s.accumulated, hint);
        case Softening::peak: break;
    }
    return hinge.scale * curve.at(max(max(s.peak[0], s.peak[1]), u), hint);
}

// Mean capacity over a rotation by `turn` > 0 in one sense from u.
Real mean_capacity(const Hinge& hinge, const HingeState& s, int sense, Real u, Real turn, int& hint) {
    const Curve& curve = sense == 0 ? hinge.positive : hinge.negative;
    const Real end = u + turn;
    auto odd = [&](Real v) { return v < 0 ? -curve.integral(-v, hint) : curve.integral(v, hint); };
    switch (hinge.softening) {
        case Softening::rotation: return hinge.scale * (odd(end) - odd(u)) / turn;
        case Softening::accumulated:
            return hinge.scale * (curve.integral(s.accumulated + turn, hint) - curve.integral(s.accumulated, hint)) / turn;
        case Softening::peak: break;
    }
    const Real peak = max(s.peak[0], s.peak[1]);
    Real work = 0;
    if (u < peak) work += (min(end, peak) - u) * curve.at(peak, hint);
    if (end > peak) work += curve.integral(end, hint) - curve.integral(max(u, peak), hint);
    return hinge.scale * work / turn;
}

Real step_polynomial(Real x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    return x * x * (3 - 2 * x);
}

// Weight of the end rate with which a damped rate decays by e^-z over a step, z = h c/I: 1/(1 - e^-z) - 1/z.
Real end_weight(Real z) { return z < 1e-3 ? 0.5 + z / 12 : 1 / (1 - exp(-z)) - 1 / z; }

Real damper_rate(const FrozenHinge& f, Real w) { return (1 - f.damper_weight) * f.w0 + f.damper_weight * w; }

Real elastic_moment(const Hinge& hinge, const FrozenHinge& f, Real w) {
    return f.m0 + hinge.stiffness * f.h * (f.w0 + w) / 2;
}

// mean moment of an elastic-plastic hinge that ends a step with m1
Real mean_moment(const FrozenHinge& f, Real m1) { return (1 - f.late) * f.m0 + f.late * m1; }

Real penetration_at_end(const FrozenHinge& f, int k, Real w) {
    return f.gap[k] + (k == 0 ? 1 : -1) * f.h * (f.w0 + w) / 2;
}

bool counts(const Hinge& hinge, const HingeState& s) {
    const double share = hinge.form == Form::elastic_plastic ? smallest_episode : smallest_rigid_episode;
    return s.episode > share * s.accumulated;
}

Real clamped(const FrozenHinge& f, Real m) { return min(max(m, -f.capacity[1]), f.capacity[0]); }

// HAVSIN ramp and its integral, for a rate of x > 0 half-widths.
Real ramp(Real x) { return x < 1 ? sin(half_pi * x) : 1; }
Real ramp_integral(Real x) { return x < 1 ? (1 - cos(half_pi * x)) / half_pi : 1 / half_pi + x - 1; }
Real mean_ramp(Real x0, Real x) { return (ramp_integral(x) - ramp_integral(x0)) / (x - x0); }

// Integral of the mean ramp from x0 to x, x0 < x: Gauss quadrature (8 points) within the ramp, closed form beyond it.
Real mean_ramp_integral(Real x0, Real x) {
    static constexpr double place[4] = {0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168};
    static constexpr double weight[4] = {0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915};
    Real sum = 0;
    const Real inner = min(x, 1.0);
    if (x0 < inner) {
        const Real middle = (x0 + inner) / 2, half = (inner - x0) / 2;
        for (int i = 0; i < 4; i++) sum += half * weight[i] * (mean_ramp(x0, middle - half * place[i]) + mean_ramp(x0, middle + half * place[i]));
    }
    if (x <= 1) return sum;
    const Real start = max(x0, 1.0);
    // beyond the ramp the mean is 1 - lost/(x - x0), `lost` being the integral of 1 - ramp within the ramp
    const Real lost = x0 < 1 ? ramp_integral(x0) - x0 - 1 / half_pi + 1 : 0;
    return sum + (x - start) - (lost > 0 ? lost * log((x - x0) / (start - x0)) : 0);
}

// The regularised form uses the ramp at the end rate while the hinge slows down, which decays however steep the ramp is.  While
// the hinge accelerates it uses the mean over the range of rates, because one step may cross the whole ramp.
Real ramp_start(const FrozenHinge& f, Real w) { return fabs(w * f.w0 < 0 ? w : f.w0) / f.width; }

// Rate towards a stop at which the forces of its spring and damper cancel; below this rate the stop has separated.
// It is unique only with a damper, because the force then grows with the rate.
Real release_rate(const Stop& stop, const FrozenHinge& f, int k) {
    const Real start = max(f.gap[k], 0.0), sign = k == 0 ? 1 : -1;
    auto force = [&](Real v) {
        const Real g = (start + max(penetration_at_end(f, k, sign * v), 0.0)) / 2;
        return (g > 0 ? stop.force(g) : 0) + f.stop_damping[k] * v;
    };
    Real low = -1, high = 0;
    while (force(low) > 0) low *= 2;
    for (int i = 0; i < 200 && high - low > 1e-16 * fabs(low); i++) {
        const Real middle = (low + high) / 2;
        (force(middle) > 0 ? high : low) = middle;
    }
    return (low + high) / 2;
}

// Integral of a stop's force over the rate, separation ignored.
Real stop_integral(const Stop& stop, const FrozenHinge& f, int k, Real v) {
    const Real sign = k == 0 ? 1 : -1, start = max(f.gap[k], 0.0), end = penetration_at_end(f, k, sign * v);
    const Real damper = f.stop_damping[k] * v * v / 2;
    // rate at which the penetration at the end is zero
    const Real edge = -sign * f.w0 - 2 * f.gap[k] / f.h;
    const Real outside = start > 0 ? stop.force(start / 2) * (min(v, edge) - edge) : 0;
    const Real inside = end > 0 ? 4 / f.h * (stop.energy((start + end) / 2) - stop.energy(start / 2)) : 0;
    return damper + outside + inside;
}

}  // namespace

Ramp ramp_over(Real x0, Real x) {
    if (x - x0 < 1e-6) return {ramp(x), x < 1 ? half_pi * cos(half_pi * x) : 0};
    const Real mean = mean_ramp(x0, x);
    return {mean, (ramp(x) - mean) / (x - x0)};
}

Real ramp_over_integral(Real x0, Real x) {
    return x - x0 < 1e-6 ? ramp_integral(x) : ramp_integral(x0) + mean_ramp_integral(x0, x);
}

Real ramp_width(const Hinge& hinge) { return hinge.form == Form::regularised ? hinge.ramp_rate : stick_rate; }

// Capacities at the present plastic rotation; in the sense of the flow the mean capacity over it, for the elastic form the
// capacity at its end, because its moment M1 is that of the end of the step.
void set_capacity(const Hinge& hinge, const HingeState& s, Real flow, int* hint, FrozenHinge& f) {
    for (int k = 0; k < 2; k++) f.capacity[k] = present_capacity(hinge, s, k, k == 0 ? s.plastic : -s.plastic, hint[k]);
    if (flow == 0) return;
    const int k = flow > 0 ? 0 : 1;
    const Real u = k == 0 ? s.plastic : -s.plastic, ahead = fabs(flow);
    if (hinge.form != Form::elastic_plastic) {
        if (ahead > smallest_mean) f.capacity[k] = mean_capacity(hinge, s, k, u, ahead, hint[k]);
    } else {
        HingeState end = s;
        end.plastic += flow;
        end.accumulated += ahead;
        f.capacity[k] = present_capacity(hinge, end, k, u + ahead, hint[k]);
    }
}

Real rate_factor(const Hinge& hinge, Real rate) {
    const Real share = fabs(rate) / hinge.rate_reference;
    return share > 0 ? 1 + pow(share, 1 / hinge.rate_exponent) : 1;
}

void freeze_beside(const Hinge& hinge, Real q0, Real turn, FrozenHinge& f) {
    if (hinge.damping > 0) f.damper_weight = end_weight(f.h * hinge.damping / hinge.damped_inertia);
    for (int k = 0; k < 2; k++) {
        const Real sign = k == 0 ? 1 : -1;
        const Stop& stop = hinge.stop[k];
        f.gap[k] = sign * q0 - stop.rotation;
        const Real start = max(f.gap[k], 0.0), end = max(f.gap[k] + sign * turn, 0.0);
        const Real g = (start + end) / 2;
        if (g == 0) continue;
        f.touched[k] = start > 0 && end > 0 ? 1 : 2 * g / fabs(turn);
        f.stop_damping[k] = stop.damping * (stop.penetration > 0 ? step_polynomial(g / stop.penetration) : 1);
    }
}

FrozenHinge freeze(const Hinge& hinge, const HingeState& s, Span step, Real q0, Real w0, Real w1, int* hint) {
    FrozenHinge f;
    f.h = step.h;
    f.late = step.late;
    f.w0 = w0;
    f.m0 = s.moment;
    f.width = ramp_width(hinge);
    const Real mean_rate = (w0 + w1) / 2, turn = f.h * mean_rate;
    Real flow = turn;
    if (hinge.form == Form::elastic_plastic) {
        set_capacity(hinge, s, 0, hint, f);
        flow -= (clamped(f, elastic_moment(hinge, f, w1)) - s.moment) / hinge.stiffness;
    }
    set_capacity(hinge, s, flow, hint, f);
    const Real factor = rate_factor(hinge, mean_rate);
    for (Real& capacity : f.capacity) capacity *= factor;
    freeze_beside(hinge, q0, turn, f);
    return f;
}

Response law_response(const Hinge& hinge, const FrozenHinge& f, Real w) {
    const Real c = w >= 0 ? f.capacity[0] : f.capacity[1];
    if (hinge.form == Form::elastic_plastic) {
        const Real trial = elastic_moment(hinge, f, w), m1 = clamped(f, trial);
        return {f.h * mean_moment(f, m1), m1 == trial ? f.late * f.h * f.h * hinge.stiffness / 2 : 0};
    }
    if (hinge.form == Form::regularised) {
        const Ramp ramp = ramp_over(ramp_start(f, w), fabs(w) / f.width);
        const Real most = f.h * c;
        return {w < 0 ? -most * ramp.value : most * ramp.value, most * ramp.slope / f.width};
    }
    const Real x = w / f.width;
    if (fabs(x) >= 1) return {w > 0 ? f.h * c : -f.h * c, 0};
    return {f.h * c * x, f.h * c / f.width};
}

Response stop_response(const Hinge& hinge, const FrozenHinge& f, Real w) {
    Response r{0, 0};
    for (int k = 0; k < 2; k++) {
        if (f.touched[k] == 0) continue;
        const Real sign = k == 0 ? 1 : -1, v = sign * w, h = f.h * f.touched[k];
        const Real end = penetration_at_end(f, k, w), g = (max(f.gap[k], 0.0) + max(end, 0.0)) / 2;
        const Stop& stop = hinge.stop[k];
        const Real spring = g > 0 ? stop.force(g) : 0;
        const Real force = spring + f.stop_damping[k] * v;
        if (force <= 0) continue;
        r.impulse += sign * h * force;
        r.slope += h * f.stop_damping[k];
        if (end > 0) r.slope += h * f.h / 4 * stop.exponent * spring / g;
    }
    return r;
}

Response beside_response(const Hinge& hinge, const FrozenHinge& f, Real w) {
    const Response stop = stop_response(hinge, f, w);
    const Real damping = f.h * hinge.damping;
    return {stop.impulse + damping * damper_rate(f, w), stop.slope + damping * f.damper_weight};
}

Response respond(const Hinge& hinge, const FrozenHinge& f, Real w) {
    const Response law = law_response(hinge, f, w), beside = beside_response(hinge, f, w);
    return {law.impulse + beside.impulse, law.slope + beside.slope};
}

Real law_potential(const Hinge& hinge, const FrozenHinge& f, Real w) {
    const Real c = w >= 0 ? f.capacity[0] : f.capacity[1], x = fabs(w) / f.width;
    if (hinge.form == Form::elastic_plastic) {
        const Real trial = elastic_moment(hinge, f, w), m1 = clamped(f, trial);
        return f.h * (1 - f.late) * f.m0 * w + 2 * f.late * m1 * (trial - m1 / 2) / hinge.stiffness;
    }
    if (hinge.form == Form::regularised) return f.h * c * f.width * ramp_over_integral(ramp_start(f, w), x);
    return f.h * c * f.width * (x < 1 ? x * x / 2 : x - 0.5);
}

Real beside_potential(const Hinge& hinge, const FrozenHinge& f, Real w) {
    Real sum = f.h * hinge.damping * w * ((1 - f.damper_weight) * f.w0 + f.damper_weight * w / 2);
    for (int k = 0; k < 2; k++) {
        if (f.touched[k] == 0) continue;
        const Real v = k == 0 ? w : -w, let_go = f.stop_damping[k] > 0 ? release_rate(hinge.stop[k], f, k) : -infinity;
        if (v <= let_go) continue;
        sum += f.h * f.touched[k] * stop_integral(hinge.stop[k], f, k, v);
        if (f.stop_damping[k] > 0) sum -= f.h * f.touched[k] * stop_integral(hinge.stop[k], f, k, let_go);
    }
    return sum;
}

int kinks(const Hinge& hinge, const FrozenHinge& f, Real* rates) {
    int n = 0;
    if (hinge.form == Form::elastic_plastic) {
        const Real per_moment = 2 / (hinge.stiffness * f.h);
        rates[n++] = (f.capacity[0] - f.m0) * per_moment - f.w0;
        rates[n++] = (-f.capacity[1] - f.m0) * per_moment - f.w0;
    } else {
        rates[n++] = -f.width;
        rates[n++] = 0;
        rates[n++] = f.width;
        if (hinge.form == Form::regularised) rates[n++] = f.w0;
    }
    for (int k = 0; k < 2; k++) {
        if (f.touched[k] == 0) continue;
        const Real sign = k == 0 ? 1 : -1, start = max(f.gap[k], 0.0), damping = f.stop_damping[k];
        const Real stiffness = hinge.stop[k].stiffness, quarter = f.h / 4;
        // zero penetration at the end: gap + h (w0 + v)/2 = 0
        rates[n++] = -f.w0 - sign * 2 * f.gap[k] / f.h;
        // separation of a linear stop with penetration at the end, k (start + gap + h (w0 + v)/2)/2 + c v = 0, or without
        rates[n++] = -sign * stiffness * ((start + f.gap[k]) / 2 + quarter * sign * f.w0) / (stiffness * quarter + damping);
        if (damping > 0) rates[n++] = -sign * stiffness * start / (2 * damping);
    }
    return n;
}

Real commit(const Hinge& hinge, const FrozenHinge& f, HingeState& s, double t0, Real q0, Real w1, const Real* halt) {
    const Real mean_rate = (f.w0 + w1) / 2;
    Real turn = f.h * mean_rate;
    const Real impulse = law_response(hinge, f, w1).impulse, stop = stop_response(hinge, f, w1).impulse;
    const int sense = mean_rate >= 0 ? 0 : 1;
    Real flow = turn, arrest = t0 + f.h;
    bool flowed = false;
    s.capacity = f.capacity[sense];
    if (hinge.form == Form::elastic_plastic) {
        const Real m1 = clamped(f, elastic_moment(hinge, f, w1));
        flow = turn - (m1 - f.m0) / hinge.stiffness;
        s.dissipated += mean_moment(f, m1) * flow;
        s.damped += damped_by_weight(hinge, f, m1);
        s.moment = m1;
        flowed = m1 == f.capacity[0] || m1 == -f.capacity[1];
        if ((s.sliding || flowed) && f.w0 * w1 < 0) {
            // Plastic flow ends where the rate passes zero.  A step that ends at capacity misses the reversal; so do its two
            // halves, with the same motion, as long as the rotation over each of them is forward.
            if (flowed) s.overrun += f.h * w1 * w1 / fabs(f.w0 - w1) / 2;
            flowed = true;
            arrest = t0 + f.h * f.w0 / (f.w0 - w1);
        }
        s.sliding = flowed && f.w0 * w1 >= 0;
    } else {
        s.dissipated += impulse * mean_rate;
        s.moment = impulse / f.h;
        const bool slid = fabs(f.w0) > f.width;
        s.sliding = fabs(w1) > f.width && !(halt && *halt < f.h);
        flowed = slid || s.sliding;
        if (slid && !s.sliding && hinge.form == Form::set_valued && stop == 0) {
            // the hinge came to rest within the step, after the time t in which the capacity yields the impulse: C t = |P|
            const Real t = halt ? *halt : min(f.h, fabs(impulse) / s.capacity);
            arrest = t0 + t;
            turn = flow = f.w0 * t / 2;
        }
    }
    s.plastic += flow;
    s.accumulated += fabs(flow);
    if (flowed) s.episode += fabs(flow);
    if (flowed && counts(hinge, s)) s.rest_time = arrest;
    if (!s.sliding) s.episode = 0;
    s.peak[0] = max(s.peak[0], s.plastic);
    s.peak[1] = max(s.peak[1], -s.plastic);
    commit_beside(hinge, f, s, q0, turn, w1);
    return turn;
}

void commit_beside(const Hinge& hinge, const FrozenHinge& f, HingeState& s, Real q0, Real turn, Real w1) {
    const Real mean_rate = (f.w0 + w1) / 2, stop = stop_response(hinge, f, w1).impulse;
    s.damped += f.h * hinge.damping * damper_rate(f, w1) * mean_rate;
    // after separation the remaining energy of the spring is dissipated in the damper of the stop
    s.stop_dissipated += stop * mean_rate - (stop_energy(hinge, q0 + turn) - stop_energy(hinge, q0));
    s.total_moment = s.moment + hinge.damping * damper_rate(f, w1) + stop / f.h;
    s.rotation_max = max(s.rotation_max, fabs(q0 + turn));
    s.moment_max = max(s.moment_max, fabs(s.total_moment));
}

Real elastic_energy(const Hinge& hinge, const HingeState& s) {
    return hinge.form == Form::elastic_plastic ? s.moment * s.moment / (2 * hinge.stiffness) : 0;
}

bool turning(const Hinge& hinge, const HingeState& s) { return s.sliding && counts(hinge, s); }

Real stop_energy(const Hinge& hinge, Real q) {
    return hinge.stop[0].energy(q - hinge.stop[0].rotation) + hinge.stop[1].energy(-q - hinge.stop[1].rotation);
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::hinge
