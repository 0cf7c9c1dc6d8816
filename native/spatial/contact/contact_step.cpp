// Treatment of contacts within a step, in addition to that of every law.
#include <algorithm>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

// Length of a step that is used to evaluate the present state only [s].
constexpr double instant = 1e-12;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

// Normal rates count from those that are allowed.
void Stepper::allow_closing(double h) {
    const size_t first = contact_rows();
    for (size_t i = 0; i < contacts_.size(); i++) {
        allowed_[i] = contacts_.allowed(i, h, rate0_[first + 3 * i], unbounded_);
        bias_[first + 3 * i] -= allowed_[i];
    }
}

// After a pass: true rates again, and whether friction has used the impulses that the pass found.
bool Stepper::settle() {
    if (contacts_.size() == 0) return true;
    const size_t first = contact_rows();
    for (size_t i = 0; i < contacts_.size(); i++) w_[first + 3 * i] += allowed_[i];
    return contacts_.settle(&impulse_[first], &rate0_[first], &w_[first]);
}

void Stepper::commit_contacts(State& s, double h) {
    const size_t first = contact_rows();
    contacts_.commit(h, stage_.quasi_static, rows_.data() + first, impulse_.data() + first, rate0_.data() + first, w_.data() + first, s.contact);
}

// Projecting rates, with contacts as stiff as they were, pushes obstacles a little: x_ along the roots of their tangents.
void Stepper::push_obstacles(State& s, double h) {
    for (size_t i = 0; i < contacts_.size(); i++) {
        const size_t link = connections_.size() - contacts_.size() + i, first = at(start(link));
        const Tangent& t = tangent_[link];
        double impulse[3] = {};
        for (size_t k = 0; k < 3; k++) {
            for (size_t j = 0; j < 3; j++) impulse[j] += t.value[k] * t.vectors[3 * j + k] * x_[first + k];
        }
        contacts_.push(i, h, &rows_[first], impulse, s.contact);
    }
}

// Error that projection takes from a link's row of a law: overlap of closed contacts.
double Stepper::overlap(size_t link) const {
    if (!is(link, Kind::contact)) return 0;
    const size_t k = at(start(link));
    return error_[k] < -contacts_.closed_gap() && impulse_[k] < 0 ? error_[k] : 0;
}

// Whether the state after a step of length h, whose rows have just been located, approaches a closed contact.
void Stepper::see_contacts(State& s, double h) {
    s.contact.impact = false;
    if (contacts_.overlooked(s.pose)) s.contact.closing = h / 2;
    if (stage_.quasi_static || contacts_.size() == 0) return;
    rates(rows_, s.velocity.data(), x_.data());
    const size_t first = contact_rows();
    s.contact.impact = contacts_.impact_follows(&error_[first], &x_[first]);
}

void Stepper::look_for_impact(State& s) {
    if (contacts_.gather(s.pose, s.velocity, instant, 0, s.contact)) link_all();
    locate_all(s, s.pose, s.t, rows_, error_.data());
    set_mobilities(s.pose);
    const size_t first = contact_rows();
    for (size_t i = 0; i < contacts_.size(); i++) {
        contacts_.freeze(i, mobility(connections_.size() - contacts_.size() + i, rows_[first + 3 * i]));
    }
    see_contacts(s, 0);
}

}  // namespace crumple::spatial
