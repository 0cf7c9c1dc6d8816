#include "spatial/step/contact_step.hpp"

#include <algorithm>

namespace crumple::spatial {

namespace {

// Rate, relative to the speed, that is never reached in an impact; larger values cost digits.
constexpr double unreached = 1e3;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

void ContactStep::begin(const State& s) {
    unbounded_ = s.contact.impact ? -unreached * p_.speed : 0;
    allowed_.assign(p_.contacts.size(), 0.0);
}

void ContactStep::allow_closing(double h) {
    const size_t first = p_.contact_rows();
    for (size_t i = 0; i < p_.contacts.size(); i++) {
        allowed_[i] = p_.contacts.allowed(i, h, p_.rate0[first + p_.contacts.rows() * i], unbounded_);
        p_.bias[first + p_.contacts.rows() * i] -= allowed_[i];
    }
}

bool ContactStep::settle(bool any_limits) {
    if (p_.contacts.size() == 0) return true;
    const size_t first = p_.contact_rows();
    for (size_t i = 0; i < p_.contacts.size(); i++) p_.w[first + p_.contacts.rows() * i] += allowed_[i];
    return p_.contacts.settle(&p_.impulse[first], &p_.rate0[first], &p_.w[first], any_limits);
}

void ContactStep::commit(State& s, double h) {
    const size_t first = p_.contact_rows();
    p_.contacts.commit(h, p_.stage.quasi_static, p_.rows.data() + first, p_.impulse.data() + first, p_.rate0.data() + first, p_.w.data() + first, s.contact);
}

void ContactStep::push_obstacles(State& s, double h) {
    for (size_t i = 0; i < p_.contacts.size(); i++) {
        const size_t link = p_.connections.size() - p_.contacts.size() + i, first = at(p_.start(link));
        p_.contacts.push(i, h, &p_.rows[first], &p_.x[first], s.contact);
    }
}

double ContactStep::overlap(size_t link) const {
    if (!p_.is_contact(link) || p_.contacts.crushes(at(p_.connections[link].index))) return 0;
    const size_t k = at(p_.start(link));
    return p_.error[k] < -p_.contacts.closed_gap() && p_.impulse[k] < 0 ? p_.error[k] : 0;
}

void ContactStep::see(State& s, double h, bool search) {
    s.contact.impact = false;
    if (search && p_.contacts.overlooked(s.pose, s.contact)) s.contact.closing = h / 2;
    if (p_.contacts.size() > 0) p_.contacts.crush(&p_.error[p_.contact_rows()], s.contact);
    if (p_.stage.quasi_static || p_.contacts.size() == 0) return;
    p_.rates(p_.rows, s.velocity.data(), p_.x.data());
    const size_t first = p_.contact_rows();
    s.contact.impact = p_.contacts.impact_follows(&p_.error[first], &p_.x[first]);
}

}  // namespace crumple::spatial
