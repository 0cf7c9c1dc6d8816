// A Newton step: linearisation of the laws, solution of the linear problem, and what is left of the imbalance.
#include <algorithm>
#include <cmath>

#include "common/pause.hpp"
#include "spatial/model/eigen.hpp"
#include "spatial/solve/newton.hpp"

namespace crumple::spatial {

namespace {

constexpr double energy_rounding = 1e-14;  // energy that a Newton iteration could still change, over the kinetic energy: rounding
constexpr double no_energy = 1e-60;  // [J]: speeds that decay by friction would otherwise end below the smallest number

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

bool NewtonSolver::solve_linear() {
    forget_laws();
    solve_once();
    if (p_.contacts.rows() == 3 && p_.contacts.size() > 0) follow_friction();
    take();
    double sum = 0;
    for (const Twist& v : p_.velocity) sum += dot(v.w, v.w) + dot(v.v, v.v);
    solved_ = std::isfinite(sum);
    return solved_;
}

// After a change of what is frozen.
void NewtonSolver::forget_laws() {
    for (Evaluated& e : evaluated_) e.w[0] = NAN;
}

// Impulse and tangent of a law.  An iteration compares with them what the one before it has found, and begins with the same rates.
const NewtonSolver::Evaluated& NewtonSolver::evaluate(size_t link, const double* w) {
    Evaluated& e = evaluated_[link];
    const int n = p_.system.links()[link].laws;
    // the normal impulses of friction change within a pass
    if (std::equal(w, w + n, e.w) && !p_.is_contact(link)) return e;
    p_.respond(link, w, e.impulse, e.tangent);
    std::copy(w, w + n, e.w);
    return e;
}

// Linearisation of a law, or of its point on the central path, as impulse = offset + tangent w.
void NewtonSolver::tangent_of(size_t link, double* offset, double* tangent) {
    const Link& l = p_.system.links()[link];
    const int n = l.laws;
    const double* w = &p_.w[at(p_.start(link) + l.held)];
    double impulse[most_components] = {}, slope[most_components * most_components] = {};
    std::fill(offset, offset + n, 0.0);
    std::fill(tangent, tangent + n * n, 0.0);
    if (path_.on(link)) {
        path_.linearise(link, w, impulse, slope, offset, tangent);
    } else {
        const Evaluated& law = evaluate(link, w);
        std::copy_n(law.impulse, n, impulse);
        std::copy_n(law.tangent, n * n, slope);
    }
    for (int i = 0; i < n; i++) {
        offset[i] += impulse[i];
        for (int j = 0; j < n; j++) {
            offset[i] -= slope[i * n + j] * w[j];
            tangent[i * n + j] += slope[i * n + j];
        }
    }
}

// Stores the tangent and the offset of a law.
void NewtonSolver::linearise(size_t link) {
    const int n = p_.system.links()[link].laws;
    Problem::Tangent& t = p_.tangent[link];
    double matrix[most_components * most_components];
    tangent_of(link, t.offset, matrix);
    eigenvectors(n, matrix, t.root, t.vectors);
    for (int k = 0; k < n; k++) t.root[k] = std::sqrt(std::max(t.root[k], 0.0));
    p_.system.set_tangent(link, t.vectors, t.root);
}

// solves for velocities, rates and impulses with the tangent of every law at p_.w
void NewtonSolver::solve_once() {
    pause();
    const std::vector<Link>& links = p_.system.links();
    for (size_t c = 0; c < links.size(); c++) {
        if (links[c].laws == 0) continue;
        linearise(c);
        std::copy_n(p_.tangent[c].offset, links[c].laws, &p_.impulse[at(p_.start(c) + links[c].held)]);
    }
    next_ = p_.free;
    p_.system.push(p_.rows, p_.impulse.data(), true, next_.data());
    p_.system.factor();
    solves_++;
    p_.system.rates(next_.data(), p_.x.data());
    for (size_t k = 0; k < p_.x.size(); k++) p_.x[k] += p_.bias[k];
    for (size_t c = 0; c < links.size(); c++) {
        for (int i = 0; i < links[c].held; i++) p_.x[at(p_.start(c) + i)] -= p_.target[at(p_.start(c) + i)];
    }
    p_.system.solve(p_.x.data(), rate_tolerance * p_.speed, next_.data());
    p_.rates(p_.rows, next_.data(), p_.w_next.data());
    for (size_t c = 0; c < links.size(); c++) {
        const int first = p_.start(c), held = links[c].held, n = links[c].laws;
        for (int i = 0; i < held; i++) p_.impulse[at(first + i)] = p_.x[at(first + i)];
        for (int j = 0; j < n; j++) p_.w_next[at(first + held + j)] += p_.bias[at(first + held + j)];
        read_unknowns(c, &p_.x[at(first + held)], &p_.w_next[at(first + held)], &p_.impulse[at(first + held)]);
    }
}

// Adds the impulses x of a link's laws, and takes the rates w of stiff directions from them, which preserves the digits of a locked hinge.
void NewtonSolver::read_unknowns(size_t link, const double* x, double* w, double* impulse) const {
    const Problem::Tangent& t = p_.tangent[link];
    const int n = p_.system.links()[link].laws;
    double along[most_components];
    for (int k = 0; k < n; k++) {
        double direction[most_components], force = 0;
        along[k] = 0;
        for (int j = 0; j < n; j++) {
            direction[j] = t.vectors[j * n + k];
            along[k] += direction[j] * w[j];
            force += direction[j] * x[j];
        }
        const double stiffness = t.root[k] * t.root[k];
        if (stiffness * p_.system.mobility_along(link, direction) > 1) along[k] = force / stiffness;
    }
    for (int j = 0; j < n; j++) {
        impulse[j] += x[j];
        w[j] = 0;
        for (int k = 0; k < n; k++) w[j] += t.vectors[j * n + k] * along[k];
    }
}

// Whether the nonlinear impulses agree with their linearisation at the new rates; `slope`: of the potential along the step.
bool NewtonSolver::balanced(double& slope) {
    const std::vector<Link>& links = p_.system.links();
    bool all = true;
    double moved = 0, furthest = 0;
    slope = 0;
    // friction at a contact with a small normal impulse is compared with the strongest contact
    double struck = 0;
    for (size_t i = 0; i < p_.contacts.size(); i++) struck = std::max(struck, -p_.impulse[p_.contact_rows() + p_.contacts.rows() * i]);
    for (size_t c = 0; c < links.size(); c++) {
        const int first = p_.start(c) + links[c].held, n = links[c].laws;
        if (n == 0) continue;
        const double* p = evaluate(c, &p_.w_next[at(first)]).impulse;
        for (int k = 0; k < n; k++) {
            const double left = p[k] - p_.impulse[at(first + k)];
            double scale = std::fabs(p[k]);
            if (p_.hinge_of(c)) scale += impulse_scale(*p_.hinge_of(c), p_.frozen[at(p_.hinge_index(c))], &p_.w_next[at(first)], k);
            if (p_.is_contact(c)) scale += struck;
            if (!(std::fabs(left) <= tolerance_ * scale)) all = false;
            const double step = left * (p_.w_next[at(first + k)] - p_.w[at(first + k)]);
            if (std::fabs(step) > furthest) {
                furthest = std::fabs(step);
                stuck_body_ = links[c].body[links[c].body[1] >= 0 ? 1 : 0];
            }
            slope += step;
            moved += std::fabs(step);
        }
    }
    return all || moved <= energy_rounding * energy_ + no_energy;
}

}  // namespace crumple::spatial
