#include "spatial/step/vibration_filter.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/model/eigen.hpp"

namespace crumple::spatial {

namespace {

constexpr double pi = 3.14159265358979323846;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

void VibrationFilter::prepare(double frequency, double h) {
    // elastic laws have the tangent h^2 K/4 for the end rates of a step
    const double scale = 2 / (2 * pi * frequency * h);
    for (size_t c = 0; c < p_.connections.size(); c++) {
        const int first = p_.start(c);
        for (int i = 0; i < p_.system.links()[c].held; i++) p_.system.row(first + i) = p_.rows[at(first + i)];
        if (p_.system.links()[c].laws > 0) set_row(c, scale);
    }
    p_.system.factor();
}

// The rows of a link's laws times the roots of its tangent, without dampers and stops.
void VibrationFilter::set_row(size_t link, double scale) {
    const Link& l = p_.system.links()[link];
    const int n = l.laws, first = p_.start(link) + l.held;
    Problem::Tangent kept = p_.tangent[link];
    if (const SpatialHinge* hinge = p_.hinge_of(link)) {
        double tangent[most_components * most_components];
        law(*hinge, p_.frozen[at(p_.hinge_index(link))], &p_.w[at(first)], nullptr, tangent, nullptr);
        eigenvectors(n, tangent, kept.value, kept.vectors);
        for (int k = 0; k < n; k++) kept.value[k] = scale * std::sqrt(std::max(kept.value[k], 0.0));
    }
    p_.set_law_rows(link, kept);
}

void VibrationFilter::apply(std::vector<Twist>& change, double tolerance) {
    p_.system.rates(change.data(), p_.x.data());
    p_.system.solve(p_.x.data(), tolerance);
    p_.system.push(p_.x.data(), change.data());
}

double VibrationFilter::along(size_t hinge, int component, const std::vector<Twist>& change) const {
    const size_t link = p_.hinge_link[hinge];
    const Link& l = p_.system.links()[link];
    const Twist a = l.body[0] < 0 ? Twist{} : change[at(l.body[0])], b = l.body[1] < 0 ? Twist{} : change[at(l.body[1])];
    return rate(p_.rows[at(p_.start(link) + l.held + component)], a, b);
}

}  // namespace crumple::spatial
