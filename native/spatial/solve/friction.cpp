// Friction limits of a Newton step: mu N with the normal impulse N that the step finds.
//
// With its limits frozen the problem is convex.  Its solution answers to a change of the limits by
//     dN = R dL,   R from the linearised problem: one solve with the factors of the last Newton step for each sliding contact,
// so N_found + R dL = L + dL is one linear system of the size of the number of sliding contacts, and all unknowns follow linearly.
// Where contacts go on sliding in their directions this is Newton's method on the coupled problem.
#include <algorithm>
#include <cmath>

#include "spatial/solve/newton.hpp"

namespace crumple::spatial {

namespace {

// Times that friction follows normal impulses in a solution before contacts that take the load in turns are pressed together, and solutions
// in search of those that stay so; more do not find them if many contacts lie flush, of which some stick below the rate of creep.
constexpr int most_followed = 2, most_searched = 10;

size_t at(int i) { return static_cast<size_t>(i); }

// Solves a x = b by elimination without exchanges, with pivots as if they were positive; false if one vanishes.  A negative pivot says
// that the normal impulse grows by more than the friction that it causes (Painleve's paradox): the contact sticks or opens, what lies
// between is unstable, and Newton's method would go there.  With the positive pivot it goes as far away from it.
bool solve_dense(std::vector<double>& a, std::vector<double>& b) {
    const size_t n = b.size();
    for (size_t k = 0; k < n; k++) {
        if (!(std::fabs(a[k * n + k]) > 1e-9)) return false;
        for (size_t i = k + 1; i < n; i++) {
            const double f = a[i * n + k] / a[k * n + k];
            for (size_t j = k; j < n; j++) a[i * n + j] -= f * a[k * n + j];
            b[i] -= f * b[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        b[k] /= std::fabs(a[k * n + k]);
        for (size_t j = k + 1; j < n; j++) b[k] -= a[k * n + j] / a[k * n + k] * b[j];
    }
    return true;
}

}  // namespace

// Whether friction agrees with the normal impulses, in a solution for given limits; if not, the limits change.
bool NewtonSolver::friction_holds(double& slope) {
    const double* impulse = p_.impulse.data() + p_.contact_rows();
    if (in_turns_ || p_.contacts.limits_hold(impulse)) return true;
    if (followed_ == 0) pressed_.assign(p_.contacts.size(), false);
    for (size_t i = 0; i < pressed_.size(); i++) {
        if (impulse[p_.contacts.rows() * i] < 0) pressed_[i] = true;
    }
    if (++followed_ <= most_followed) {
        follow_friction();
        return balanced(slope) && p_.contacts.limits_hold(impulse);
    }
    // if they do not press together, a solution for the limits of before will do, as after the last pass
    std::vector<double> limits;
    for (size_t i = 0; i < p_.contacts.size(); i++) limits.push_back(p_.contacts.normal(i));
    const bool searched = presses_;
    presses_ = searched && press_together(slope);
    in_turns_ = !presses_;
    for (size_t i = 0; in_turns_ && i < limits.size(); i++) p_.contacts.set_normal(i, limits[i]);
    return presses_ || !searched;
}

// Contacts may take the load in turns, because each is pressed while the friction of another is missing: then all that took part are closed.
// False if friction does not agree with the normal impulses then either.
bool NewtonSolver::press_together(double& slope) {
    const double* impulse = p_.impulse.data() + p_.contact_rows();
    for (int k = 0; k < most_searched; k++) {
        take();
        for (size_t i = 0; i < pressed_.size(); i++) {
            double& rate = p_.w[at(p_.start(contact_link(i)))];
            if (pressed_[i]) rate = std::min(rate, -rate_tolerance * p_.speed);
        }
        solve_once();
        follow_friction();
        for (size_t i = 0; i < pressed_.size(); i++) stop_reversing(contact_link(i));
        if (balanced(slope) && p_.contacts.limits_hold(impulse)) return true;
    }
    return false;
}

bool NewtonSolver::slides(size_t contact, const std::vector<double>& rates) const {
    const double* w = &rates[at(p_.start(contact_link(contact)))];
    return std::hypot(w[1], w[2]) > p_.contacts.frozen(contact).width;
}

size_t NewtonSolver::contact_link(size_t contact) const { return p_.connections.size() - p_.contacts.size() + contact; }

// Unknowns by which the linearised problem answers to an impulse per normal impulse of a sliding contact, and that impulse.
void NewtonSolver::answer_to_friction(size_t contact, double tolerance, std::vector<double>& applied, std::vector<double>& x) {
    const size_t first = at(p_.start(contact_link(contact)));
    const double *w = &p_.w_next[first], slip = std::hypot(w[1], w[2]), mu = p_.contacts.friction(contact);
    applied.assign(p_.x.size(), 0.0);
    for (size_t k = 1; k < 3; k++) applied[first + k] = mu * w[k] / slip;
    answer_.assign(p_.velocity.size(), Twist{});
    p_.system.push(p_.rows, applied.data(), true, answer_.data());
    x.resize(p_.x.size());
    p_.system.rates(answer_.data(), x.data());
    p_.system.solve(x.data(), tolerance, answer_.data());
}

// Sets the friction limits to those that the linearised problem finds, and moves the solution with them.
void NewtonSolver::follow_friction() {
    std::vector<size_t> sliding;
    std::vector<double> left;
    double largest = 0;
    for (size_t i = 0; i < p_.contacts.size(); i++) {
        if (p_.contacts.friction(i) == 0) continue;
        const size_t first = at(p_.start(contact_link(i)));
        const double found = -p_.impulse[first];
        if (slides(i, p_.w_next)) {
            sliding.push_back(i);
            left.push_back(found - p_.contacts.normal(i));
            largest = std::max(largest, std::fabs(left.back()));
        } else {
            p_.contacts.set_normal(i, std::max(found, 0.0));
        }
    }
    const size_t n = sliding.size();
    if (largest == 0) return;
    const double tolerance = rate_tolerance * p_.speed / largest;
    applied_.resize(std::max(applied_.size(), n));
    answers_.resize(applied_.size());
    std::vector<double> matrix(n * n), change = left;
    for (size_t j = 0; j < n; j++) {
        answer_to_friction(sliding[j], tolerance, applied_[j], answers_[j]);
        for (size_t i = 0; i < n; i++) {
            const size_t link = contact_link(sliding[i]);
            matrix[i * n + j] = (i == j ? 1 : 0) + answers_[j][at(p_.start(link))];
        }
    }
    if (!solve_dense(matrix, change)) change = left;
    for (size_t j = 0; j < n; j++) {
        const double before = p_.contacts.normal(sliding[j]);
        change[j] = std::max(change[j], -before);
        p_.contacts.set_normal(sliding[j], before + change[j]);
    }
    move_with_friction(n, change);
}

// Adds the answers to changes of the normal impulses of friction to velocities, rates and impulses.
void NewtonSolver::move_with_friction(size_t n, const std::vector<double>& change) {
    std::vector<double>& applied = applied_[0];
    std::vector<double>& x = answers_[0];
    for (size_t k = 0; k < x.size(); k++) {
        applied[k] *= change[0];
        x[k] *= change[0];
        for (size_t j = 1; j < n; j++) {
            applied[k] += change[j] * applied_[j][k];
            x[k] += change[j] * answers_[j][k];
        }
    }
    answer_.assign(p_.velocity.size(), Twist{});
    p_.system.push(p_.rows, applied.data(), true, answer_.data());
    p_.system.push(x.data(), answer_.data());
    for (size_t i = 0; i < next_.size(); i++) next_[i] = next_[i] + answer_[i];
    answer_rates_.resize(x.size());
    p_.rates(p_.rows, answer_.data(), answer_rates_.data());
    for (size_t c = 0; c < p_.connections.size(); c++) {
        const Link& link = p_.system.links()[c];
        const size_t first = at(p_.start(c));
        for (int i = 0; i < link.held; i++) p_.impulse[first + at(i)] += x[first + at(i)];
        read_unknowns(c, &x[first + at(link.held)], &answer_rates_[first + at(link.held)], &applied[first + at(link.held)]);
        for (int j = 0; j < link.laws; j++) {
            p_.w_next[first + at(link.held + j)] += answer_rates_[first + at(link.held + j)];
            p_.impulse[first + at(link.held + j)] += applied[first + at(link.held + j)];
        }
    }
}

}  // namespace crumple::spatial
