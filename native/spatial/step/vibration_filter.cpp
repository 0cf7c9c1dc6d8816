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
    // with the weight s of the end elastic laws have the tangent s h^2 K/2 for the end rates of a step
    const double scale = std::sqrt(2 / p_.elastic_weight(h)) / (2 * pi * frequency * h);
    p_.assemble();
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (p_.system.links()[c].laws > 0) set_tangent(c, scale);
    }
    p_.system.factor();
}

// Tangent of a link's laws without dampers and stops.
void VibrationFilter::set_tangent(size_t link, double scale) {
    const Link& l = p_.system.links()[link];
    const int n = l.laws, first = p_.start(link) + l.held;
    const SpatialHinge* hinge = p_.hinge_of(link);
    if (!hinge) return;
    double tangent[most_components * most_components], root[most_components], vectors[most_components * most_components];
    law(*hinge, p_.frozen[at(p_.hinge_index(link))], &p_.w[at(first)], nullptr, tangent, nullptr);
    eigenvectors(n, tangent, root, vectors);
    for (int k = 0; k < n; k++) root[k] = scale * std::sqrt(std::max(root[k], 0.0));
    p_.system.set_tangent(link, vectors, root);
}

void VibrationFilter::apply(std::vector<Twist>& change, double tolerance) {
    p_.system.rates(change.data(), p_.x.data());
    p_.system.solve(p_.x.data(), tolerance, change.data());
}

double VibrationFilter::along(size_t hinge, int component, const std::vector<Twist>& change) const {
    const size_t link = p_.hinge_link[hinge];
    const Link& l = p_.system.links()[link];
    const Twist a = l.body[0] < 0 ? Twist{} : change[at(l.body[0])], b = l.body[1] < 0 ? Twist{} : change[at(l.body[1])];
    return rate(p_.rows[at(p_.start(link) + l.held + component)], a, b);
}

}  // namespace crumple::spatial
