#include "planar/directions.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

using Numbers = std::vector<Real*>;

void add(Numbers& all, Vec2& v) {
    all.push_back(&v.x);
    all.push_back(&v.y);
}

void add(Numbers& all, Twist& t) {
    all.push_back(&t.w);
    add(all, t.v);
}

void add(Numbers& all, Curve& curve) {
    for (auto* column : {&curve.places(), &curve.values()}) {
        for (Real& x : *column) all.push_back(&x);
    }
}

std::vector<Curve*> curves(Model& m) {
    std::vector<Curve*> all;
    for (Hinge& h : m.hinges) all.insert(all.end(), {&h.positive, &h.negative});
    for (Load& l : m.loads) all.push_back(&l.value);
    for (Drive& d : m.drives) all.push_back(&d.rate);
    return all;
}

// every number of a model, in a fixed order
Numbers numbers(Model& m) {
    Numbers all;
    for (int i = 0; i < m.tree.bodies(); i++) {
        Body& b = m.tree.body(i);
        add(all, b.anchor);
        add(all, b.centre);
        all.insert(all.end(), {&b.mass, &b.inertia});
    }
    for (Hinge& h : m.hinges) {
        all.insert(all.end(), {&h.scale, &h.stiffness, &h.ramp_rate, &h.rate_reference, &h.rate_exponent, &h.damping});
        for (Stop& s : h.stop) all.insert(all.end(), {&s.rotation, &s.stiffness, &s.exponent, &s.damping, &s.penetration});
    }
    for (Load& l : m.loads) {
        add(all, l.point);
        add(all, l.direction);
        all.push_back(&l.scale);
    }
    for (Drive& d : m.drives) {
        add(all, d.point);
        add(all, d.direction);
        all.push_back(&d.start);
    }
    for (Hold& h : m.holds) {
        add(all, h.point);
        add(all, h.direction);
    }
    for (Weld& w : m.welds) {
        add(all, w.point);
        add(all, w.other_point);
    }
    add(all, m.gravity);
    for (Real& q : m.q0) all.push_back(&q);
    for (Curve* curve : curves(m)) add(all, *curve);
    return all;
}

}  // namespace

bool set_directions(Model& model, const std::vector<Model*>& up, const std::vector<Model*>& down,
                    const std::vector<double>& width) {
    const Numbers base = numbers(model);
    for (size_t k = 0; k < up.size(); k++) {
        const Numbers above = numbers(*up[k]), below = numbers(*down[k]);
        if (above.size() != base.size() || below.size() != base.size()) return false;
        for (size_t i = 0; i < base.size(); i++) {
            // two infinities, or two NaNs (damper chosen by the solver), do not differ
            const double difference = above[i]->v - below[i]->v;
            base[i]->d[k] = std::isfinite(difference) ? difference / width[k] : 0;
        }
    }
    for (Curve* curve : curves(model)) curve->integrate();
    return true;
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
