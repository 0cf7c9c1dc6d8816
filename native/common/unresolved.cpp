#include "common/unresolved.hpp"

#include <algorithm>
#include <cmath>

namespace crumple {

namespace {

// A step that is too long is shortened to a share of its length between these two, repeatedly if necessary.
constexpr double least_share = 0.1, most_share = 0.9;

}  // namespace

Samples::Samples(std::vector<double> times, std::vector<double> values) : times_(std::move(times)), values_(std::move(values)) {
    for (const double v : values_) constant_ = constant_ && v == values_.front();
}

size_t Samples::next(double t) const {
    return static_cast<size_t>(std::upper_bound(times_.begin(), times_.end(), t) - times_.begin());
}

double Samples::at(double t) const {
    const size_t k = next(t);
    if (k == 0) return values_.front();
    if (k == times_.size()) return values_.back();
    return values_[k - 1] + (values_[k] - values_[k - 1]) * (t - times_[k - 1]) / (times_[k] - times_[k - 1]);
}

double Samples::largest() const {
    double most = 0;
    for (const double v : values_) most = std::max(most, std::fabs(v));
    return most;
}

double Samples::largest_integral() const {
    double sum = 0, most = 0;
    for (size_t k = 1; k < times_.size(); k++) {
        sum += (times_[k] - times_[k - 1]) * (values_[k] + values_[k - 1]) / 2;
        most = std::max(most, std::fabs(sum));
    }
    return most;
}

OffChord Samples::value_off_chord(double from, double to) const {
    OffChord out;
    const double start = at(from), slope = (at(to) - start) / (to - from);
    for (size_t k = next(from); k < times_.size() && times_[k] < to; k++) {
        const double off = std::fabs(values_[k] - start - slope * (times_[k] - from));
        if (off > out.size) out = {off, times_[k]};
    }
    return out;
}

OffChord Samples::value_off_ends(double from, double to) const {
    OffChord out;
    const double start = at(from), end = at(to), low = std::min(start, end), high = std::max(start, end);
    for (size_t k = next(from); k < times_.size() && times_[k] < to; k++) {
        const double off = std::max(low - values_[k], values_[k] - high);
        if (off > out.size) out = {off, times_[k]};
    }
    return out;
}

// The integral is a parabola over each piece; its deviation from the chord has an extremum where the value passes its mean.
// The size is the range of the deviation, from its minimum to its maximum: it bounds the error of the impulse over any part
// of the interval.
OffChord Samples::integral_off_chord(double from, double to) const {
    const size_t first = next(from);
    auto over_pieces = [&](const auto& take) {
        double t = from, v = at(from);
        for (size_t k = first; k < times_.size() && times_[k] < to; k++) {
            take(t, v, times_[k], values_[k], true);
            t = times_[k];
            v = values_[k];
        }
        take(t, v, to, at(to), false);
    };
    double sum = 0;
    over_pieces([&](double t0, double v0, double t1, double v1, bool) { sum += (t1 - t0) * (v0 + v1) / 2; });
    const double mean = sum / (to - from);
    double off = 0, low = 0, high = 0, farthest = -1;
    OffChord out;
    auto see = [&](double d) { low = std::min(low, d), high = std::max(high, d); };
    over_pieces([&](double t0, double v0, double t1, double v1, bool kink) {
        const double a = v0 - mean, b = v1 - mean;
        if (a * b < 0) see(off + a * a / (a - b) * (t1 - t0) / 2);
        off += (a + b) / 2 * (t1 - t0);
        see(off);
        if (kink && std::fabs(off) > farthest) farthest = std::fabs(off), out.kink = t1;
    });
    out.size = high - low;
    return out;
}

int StepBound::add_load(std::vector<double> times, std::vector<double> values) {
    const Samples samples(std::move(times), std::move(values));
    if (samples.constant()) return -1;
    for (size_t k = 0; k < loads_.size(); k++) {
        if (loads_[k].samples.same(samples)) return static_cast<int>(k);
    }
    loads_.push_back({samples, samples.largest(), samples.largest_integral()});
    return static_cast<int>(loads_.size()) - 1;
}

void StepBound::add_drive(std::vector<double> times, std::vector<double> values) {
    const Samples samples(std::move(times), std::move(values));
    if (!samples.constant()) drives_.push_back({samples, samples.largest(), samples.largest_integral()});
}

// `unresolved` is relative to what is allowed.  For a smooth function it is proportional to the square of the step length.
StepBound::Step StepBound::longest(double t, double h, double least, const Measure& unresolved) {
    for (;;) {
        const OffChord first = unresolved(t, t + h / 2), second = unresolved(t + h / 2, t + h);
        const OffChord& worst = first.size > second.size ? first : second;
        if (!(worst.size > 1) || h <= least) return {h, worst.size};
        const double to_kink = worst.kink - t, share = most_share / std::sqrt(worst.size);
        h = to_kink >= least_share * h && to_kink <= most_share * h ? to_kink : h * std::clamp(share, least_share, most_share);
        h = std::max(h, least);
    }
}

StepBound::Step StepBound::dynamic(double t, double h, double accuracy, double least, const std::function<double(size_t)>& speed) const {
    return longest(t, h, least, [&](double from, double to) {
        OffChord sum, worst;
        auto count = [&](OffChord off, double unit) {
            off.size *= unit / accuracy;
            if (off.size > worst.size) worst = off;
            return off.size;
        };
        for (size_t k = 0; k < loads_.size(); k++) {
            const OffChord off = loads_[k].samples.integral_off_chord(from, to);
            if (off.size > 0) sum.size += count(off, speed(k));
        }
        const bool smallest = to - from <= least / 2;
        for (const Function& f : drives_) {
            count(smallest ? f.samples.value_off_ends(from, to) : f.samples.value_off_chord(from, to), 1 / f.largest);
        }
        return OffChord{std::max(sum.size, worst.size), worst.kink};
    });
}

StepBound::Step StepBound::quasi_static(double t, double h, double accuracy, double least) const {
    return longest(t, h, least, [&](double from, double to) {
        OffChord worst;
        auto count = [&](OffChord off, double unit) {
            off.size *= unit / accuracy;
            if (off.size > worst.size) worst = off;
        };
        for (const Function& f : loads_) count(f.samples.value_off_chord(from, to), 1 / f.largest);
        for (const Function& f : drives_) count(f.samples.integral_off_chord(from, to), 1 / f.largest_integral);
        return worst;
    });
}

}  // namespace crumple
