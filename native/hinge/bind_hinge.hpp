// Builds a hinge from plain values that Python passes.
#pragma once

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <vector>

#include "common/binding.hpp"
#include "hinge/hinge.hpp"

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

using Doubles = std::vector<double>;

inline Curve make_curve(const Doubles& x, const Doubles& y) {
    require(!x.empty() && x.size() == y.size(), "a curve needs as many values as places, at least one");
    for (size_t i = 0; i < x.size(); i++) {
        require(std::isfinite(x[i]) && std::isfinite(y[i]), "places and values of a curve must be finite");
        require(i == 0 || x[i] > x[i - 1], "the places of a curve must increase");
    }
    return Curve(std::vector<Real>(x.begin(), x.end()), std::vector<Real>(y.begin(), y.end()));
}

// curves, stiffness, rate factor, damper and stops
inline Hinge make_hinge(const nanobind::dict& d, Form form, Softening softening) {
    require(form >= Form::set_valued && form <= Form::regularised, "a hinge has an unknown form");
    require(softening >= Softening::peak && softening <= Softening::accumulated, "a hinge softens over an unknown variable");
    Hinge h;
    h.form = form;
    h.softening = softening;
    auto number = [&](const char* key) { return entry<double>(d, key); };
    auto numbers = [&](const char* key) { return entry<Doubles>(d, key); };
    h.positive = make_curve(numbers("positive_rotation"), numbers("positive_moment"));
    h.negative = make_curve(numbers("negative_rotation"), numbers("negative_moment"));
    h.stiffness = number("elastic_stiffness");
    h.ramp_rate = number("regularisation_rate");
    h.rate_reference = number("rate_reference");
    h.rate_exponent = number("rate_exponent");
    h.damping = number("viscous_damping");
    const char* keys[2] = {"stop_positive", "stop_negative"};
    for (int k = 0; k < 2; k++) {
        const Doubles s = numbers(keys[k]);  // empty: no stop
        if (s.empty()) continue;
        require(s.size() == 5, "a stop has rotation, stiffness, exponent, damping, penetration");
        h.stop[k] = {s[0], s[1], s[2], s[3], s[4]};
    }
    return h;
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::hinge
