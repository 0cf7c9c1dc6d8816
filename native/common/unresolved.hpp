// Action of loads and drives within a step that the step does not resolve.  Derivation in docs/theory/time_functions.md.
//
// A step takes a load by its mean over the step, so the impulse in between as a straight line, and the rate of a drive as
// a straight line.  What lies off these chords is unresolved: a pulse that comes and goes, a motion out and back.
// Steps are kept so short that it stays below the accuracy; where that asks for a shorter step, it ends at the kink that
// lies farthest off the chord.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace crumple {

// How far a function leaves its chord over an interval, and the kink inside at which it is farthest; below the
// interval's start where it has none.
struct OffChord {
    double size = 0, kink = -1;
};

// A piecewise linear function of time, constant outside its range.
class Samples {
public:
    Samples(std::vector<double> times, std::vector<double> values);
    bool constant() const { return constant_; }
    bool same(const Samples& other) const { return times_ == other.times_ && values_ == other.values_; }
    // largest magnitudes of the value, and of the integral from the start
    double largest() const;
    double largest_integral() const;
    OffChord value_off_chord(double from, double to) const;
    OffChord integral_off_chord(double from, double to) const;

private:
    double at(double t) const;
    size_t next(double t) const;  // first sample after t

    std::vector<double> times_, values_;
    bool constant_ = true;
};

// Bound of the step by all loads and drives of a run.
class StepBound {
public:
    // Loads of one function of time are one: its number, -1 for a constant.
    int add_load(std::vector<double> times, std::vector<double> values);
    void add_drive(std::vector<double> times, std::vector<double> values);
    struct Step {
        double h = 0, unresolved = 0;  // length [s], and what it leaves unresolved over what it may
    };
    bool empty() const { return loads_.empty() && drives_.empty(); }
    // Longest step from t, at most h, whose halves leave no more than the accuracy unresolved; not below `least`.
    // `speed`: of what a unit impulse of a load moves, over the speed that counts as large.
    Step dynamic(double t, double h, double accuracy, double least, const std::function<double(size_t)>& speed) const;
    // the same where inertia is neglected: loads are resolved by value and drives by displacement
    Step quasi_static(double t, double h, double accuracy, double least) const;

private:
    struct Function {
        Samples samples;
        double largest = 0, largest_integral = 0;
    };
    using Measure = std::function<OffChord(double from, double to)>;
    static Step longest(double t, double h, double least, const Measure& unresolved);

    std::vector<Function> loads_, drives_;
};

}  // namespace crumple
