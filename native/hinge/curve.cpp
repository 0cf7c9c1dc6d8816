#include "hinge/curve.hpp"

#include <algorithm>

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// Share of a step below which its overlap with a further piece of a function of time is attributed to rounding of the times.
constexpr double sliver = 1e-12;

}  // namespace

Curve::Curve(std::vector<Real> x, std::vector<Real> y) : x_(std::move(x)), y_(std::move(y)), area_(x_.size(), 0.0) {
    integrate();
}

void Curve::integrate() {
    for (size_t i = 1; i < x_.size(); i++) area_[i] = area_[i - 1] + (x_[i] - x_[i - 1]) * (y_[i] + y_[i - 1]) / 2;
}

size_t Curve::piece(Real v, int& hint) const {
    int i = min(hint, static_cast<int>(x_.size()) - 2);
    while (v < x_[static_cast<size_t>(i)]) i--;
    while (v >= x_[static_cast<size_t>(i + 1)]) i++;
    hint = i;
    return static_cast<size_t>(i);
}

Real Curve::at(Real v, int& hint) const {
    if (v <= x_.front()) return y_.front();
    if (v >= x_.back()) return y_.back();
    const size_t k = piece(v, hint);
    return y_[k] + (y_[k + 1] - y_[k]) * (v - x_[k]) / (x_[k + 1] - x_[k]);
}

Real Curve::integral(Real v, int& hint) const {
    if (v <= x_.front()) return (v - x_.front()) * y_.front();
    if (v >= x_.back()) return area_.back() + (v - x_.back()) * y_.back();
    const size_t k = piece(v, hint);
    const Real d = v - x_[k];
    return area_[k] + d * (y_[k] + (y_[k + 1] - y_[k]) * d / (x_[k + 1] - x_[k]) / 2);
}

// index of the piece that contains t: -1 before the first point, the index of the last point from there on
int Curve::piece_at(double t) const {
    auto before = [](double a, const Real& b) { return a < value(b); };
    return static_cast<int>(std::upper_bound(x_.begin(), x_.end(), t, before) - x_.begin()) - 1;
}

Real Curve::at_time(double t) const {
    int hint = max(piece_at(t), 0);
    return at(t, hint);
}

Real Curve::integral_to(double t) const {
    int hint = max(piece_at(t), 0);
    return integral(t, hint);
}

// Within one piece the value at the middle, else the sum of the areas of the pieces: the difference of two integrals from the
// first point would lose digits in short steps.
Real Curve::mean(double t, double h) const {
    int first = piece_at(t), last = piece_at(t + h);
    // a step that starts or ends at a point of the curve may overlap the neighbouring piece by rounding
    if (last > first && t + h - x_[static_cast<size_t>(last)] <= sliver * h) last--;
    if (last > first && x_[static_cast<size_t>(first + 1)] - t <= sliver * h) first++;
    if (first == last) return at_time(t + h / 2);
    Real sum = 0, from = t, y = at_time(t);
    for (int k = first + 1; k <= last; k++) {
        const auto i = static_cast<size_t>(k);
        sum += (x_[i] - from) * (y + y_[i]) / 2;
        from = x_[i];
        y = y_[i];
    }
    sum += (t + h - from) * (y + at_time(t + h)) / 2;
    return sum / h;
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::hinge
