// Variation of loads and drives within a step that the step does not resolve.  Derivation in docs/theory/time_functions.md.
//
// A step represents a load by its mean over the step, so that its impulse grows linearly, and interpolates the rate of a drive
// linearly.  The deviation from these chords is unresolved: a pulse within the step, or a motion there and back.
// Steps are shortened until the deviation is below the accuracy; a shortened step preferably ends at the kink with the largest
// deviation.  Within a step of the smallest length a drive may pass from one rate to another at any time: what remains unresolved
// there is a motion there and back, beyond the rates at both ends.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace crumple {

// Largest deviation of a function from its chord over an interval, and the kink inside with the largest deviation; -1 if there
// is none.
struct OffChord {
    double size = 0, kink = -1;
};

// A piecewise linear function of time, constant outside its range.
class Samples {
public:
    Samples(std::vector<double> times, std::vector<double> values);
    bool constant() const { return constant_; }
    bool same(const Samples& other) const { return times_ == other.times_ && values_ == other.values_; }
    // largest magnitudes of the value and of the integral from the first sample
    double largest() const;
    double largest_integral() const;
    OffChord value_off_chord(double from, double to) const;
    // by how far values lie outside the range of those at both ends
    OffChord value_off_ends(double from, double to) const;
    OffChord integral_off_chord(double from, double to) const;

private:
    double at(double t) const;
    size_t next(double t) const;  // first sample after t

    std::vector<double> times_, values_;
    bool constant_ = true;
};

// Limit of the step length by all loads and drives of a run.
class StepBound {
public:
    // Loads with the same function of time are counted once; returns the number of the function, -1 if it is constant.
    int add_load(std::vector<double> times, std::vector<double> values);
    void add_drive(std::vector<double> times, std::vector<double> values);
    struct Step {
        double h = 0, unresolved = 0;  // length [s]; unresolved action relative to the allowed one
    };
    bool empty() const { return loads_.empty() && drives_.empty(); }
    // Longest step from t, between `least` and h, whose halves each leave no more than the accuracy unresolved.
    // `speed`: kinetic norm that a unit impulse of a load causes, relative to the speed that counts as large.
    Step dynamic(double t, double h, double accuracy, double least, const std::function<double(size_t)>& speed) const;
    // the same for quasi-static stages, where the value of loads and the displacement of drives are compared
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
