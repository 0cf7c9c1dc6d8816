// Treatment of contacts within a step, in addition to what all laws have in common.
#include <algorithm>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

// Length of a step that is used to evaluate the present state only [s].
constexpr double instant = 1e-12;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

// Shifts the normal rates by the allowed rates.
void Stepper::allow_closing(double h) {
    const size_t first = contact_rows();
    for (size_t i = 0; i < contacts_.size(); i++) {
        allowed_[i] = contacts_.allowed(i, h, rate0_[first + contacts_.rows() * i], unbounded_);
        bias_[first + contacts_.rows() * i] -= allowed_[i];
    }
}

// After a pass: restores the true rates; returns whether friction has used the normal impulses that the pass found.
bool Stepper::settle() {
    if (contacts_.size() == 0) return true;
    const size_t first = contact_rows();
    for (size_t i = 0; i < contacts_.size(); i++) w_[first + contacts_.rows() * i] += allowed_[i];
    return contacts_.settle(&impulse_[first], &rate0_[first], &w_[first]);
}

// Sets the tangential rates of a contact that would reverse its slip to zero first.
void Stepper::stop_reversing(size_t link) {
    const double *w = &w_[at(start(link))], width = contacts_.frozen(at(connections_[link].index)).width;
    double* next = &w_next_[at(start(link))];
    if (contacts_.rows() == 3 && std::hypot(w[1], w[2]) > width && w[1] * next[1] + w[2] * next[2] < 0) next[1] = next[2] = 0;
}

void Stepper::commit_contacts(State& s, double h) {
    const size_t first = contact_rows();
    contacts_.commit(h, stage_.quasi_static, rows_.data() + first, impulse_.data() + first, rate0_.data() + first, w_.data() + first, s.contact);
}

// Adds the impulses on obstacles from the projection of the rates, in which contacts keep their tangents: x_ is their unknown along the
// roots of the tangents.
void Stepper::push_obstacles(State& s, double h) {
    for (size_t i = 0; i < contacts_.size(); i++) {
        const size_t link = connections_.size() - contacts_.size() + i, first = at(start(link));
        const Tangent& t = tangent_[link];
        const size_t n = contacts_.rows();
        double impulse[3] = {};
        for (size_t k = 0; k < n; k++) {
            for (size_t j = 0; j < n; j++) impulse[j] += t.value[k] * t.vectors[n * j + k] * x_[first + k];
        }
        contacts_.push(i, h, &rows_[first], impulse, s.contact);
    }
}

// Error of a link's law row that the projection corrects: the overlap of a closed contact.
double Stepper::overlap(size_t link) const {
    if (!is(link, Kind::contact) || contacts_.crushes(at(connections_[link].index))) return 0;
    const size_t k = at(start(link));
    return error_[k] < -contacts_.closed_gap() && impulse_[k] < 0 ? error_[k] : 0;
}

// Sets whether the state after a step of length h, whose rows have just been located, approaches a closed contact (impact).
void Stepper::see_contacts(State& s, double h) {
    s.contact.impact = false;
    if (contacts_.overlooked(s.pose, s.contact)) s.contact.closing = h / 2;
    if (contacts_.size() > 0) contacts_.crush(&error_[contact_rows()], s.contact);
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
        contacts_.freeze(i, mobility(connections_.size() - contacts_.size() + i, rows_[first + contacts_.rows() * i]), 0);
    }
    see_contacts(s, 0);
}

}  // namespace crumple::spatial
