#include "spatial/run/ahead.hpp"

namespace crumple::spatial {

namespace {

// A step longer than this multiple of the one that showed the accelerations is not guessed: those of a step that was cut short, at a closing
// contact say, may be of forces that act for no longer, and over the whole step would move bodies by any distance.
constexpr double far_ahead = 10;

// twice the energy, with an inertia of a bar of the model's length
double energy_of(const Model& model, const Body& body, const Twist& v) {
    return body.mass * (dot(v.v, v.v) + model.length * model.length / 12 * dot(v.w, v.w));
}

}  // namespace

void Ahead::see_half(const std::vector<Twist>& before, const std::vector<Twist>& after, double length,
                     const std::vector<double>& rates) {
    acceleration_.resize(before.size());
    for (size_t i = 0; i < before.size(); i++) acceleration_[i] = (1 / length) * (after[i] - before[i]);
    rates_ = rates;
    length_ = 2 * length;
    known_ = true;
}

void Ahead::see_step(const std::vector<Twist>& before, const std::vector<Twist>& after, double length,
                     const std::vector<double>& rates) {
    if (!known_) return;
    rates_ = rates;
    // the mean of the step, and as much again as it differs from the mean of the first half, is that of the second half
    for (size_t i = 0; i < before.size(); i++) acceleration_[i] = (2 / length) * (after[i] - before[i]) - acceleration_[i];
}

bool Ahead::guess(const std::vector<Twist>& now, double length) {
    guessed_ = known_ && length <= far_ahead * length_;
    if (!guessed_) return false;
    end_.resize(now.size());
    for (size_t i = 0; i < now.size(); i++) end_[i] = now[i] + length * acceleration_[i];
    return good_;
}

void Ahead::compare(const Model& model, const std::vector<Twist>& before, const std::vector<Twist>& found) {
    known_ = false;
    if (!guessed_) return;
    guessed_ = false;
    double missed = 0, gained = 0;
    for (size_t i = 0; i < found.size(); i++) {
        missed += energy_of(model, model.bodies[i], found[i] - end_[i]);
        gained += energy_of(model, model.bodies[i], found[i] - before[i]);
    }
    good_ = missed <= gained;
}

}  // namespace crumple::spatial
