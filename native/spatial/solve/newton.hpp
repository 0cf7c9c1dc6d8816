// Newton's method for the end velocities of a step, on the convex potential of its problem with all laws frozen.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "spatial/solve/central_path.hpp"
#include "spatial/solve/problem.hpp"

namespace crumple::spatial {

// Tolerance of the rates of held rows and of stiff laws relative to the speed; the rest is projected out at the end of the step.
constexpr double rate_tolerance = 1e-10;

class NewtonSolver {
public:
    explicit NewtonSolver(Problem& problem);

    // the links of the problem have changed
    void relinked();
    // Before a step; `warm`: it follows on a pass that was solved, and may start from it; `rubs`: friction follows the normal impulses.
    void begin(bool warm, bool rubs);
    // begins the search for locked hinges with such rates
    void start_from(const std::vector<double>& rates);
    // Newton's method starts from the rates w, but hinges that were locked in the last pass start with the rates of that pass.
    void keep_locked();
    // false if the equations of the pass do not converge
    bool solve();
    // a single Newton step; false if its result is not finite
    bool solve_linear();
    // whether contacts took the load in turns in the last pass: its friction is then that of normal impulses found before
    bool took_turns() const { return in_turns_; }
    std::int64_t solves() const { return solves_; }
    // body at the link with the largest imbalance in the last iteration; -1: the ground
    int stuck_body() const { return stuck_body_; }

private:
    friend class CentralPath;
    // law of a hinge at the rates where it was last evaluated in this pass
    struct Evaluated {
        double w[most_components] = {NAN}, impulse[most_components], tangent[most_components * most_components];
    };
    bool solve_laws();
    void forget_laws();
    const Evaluated& evaluate(size_t link, const double* w);
    double finest_tolerance() const;
    int most_iterations() const;
    int most_full_steps(bool path) const;
    bool narrow_ramps();
    void widen(double width, bool& narrowest);
    bool descend(int limit, bool full_steps, int found = 0);
    void solve_once();
    void take();
    void tangent_of(size_t link, double* offset, double* tangent);
    void linearise(size_t link);
    bool balanced(double& slope);
    void take_full_step();
    bool reverses(size_t link);
    void stop_reversing(size_t link);
    double search(double slope_end);
    bool settled(double& slope);
    void read_unknowns(size_t link, const double* x, double* w, double* impulse) const;
    // friction.cpp
    size_t contact_link(size_t contact) const;
    void answer_to_friction(size_t contact, double tolerance, std::vector<double>& applied, std::vector<double>& x);
    void follow_friction();
    void move_with_friction(size_t n, const std::vector<double>& change);
    bool friction_holds(double& slope);
    bool press_together(double& slope);
    bool slides(size_t contact, const std::vector<double>& rates) const;

    Problem& p_;
    CentralPath path_;
    std::vector<Twist> next_;
    std::vector<Evaluated> evaluated_;          // per link
    std::vector<double> overload_, worst_near_;
    std::vector<Twist> answer_;                           // to friction: velocities, rates, impulses and unknowns per sliding contact
    std::vector<double> answer_rates_;
    std::vector<std::vector<double>> applied_, answers_;
    bool solved_ = false;                       // whether w holds the solution of the last pass
    bool rubs_ = true;                          // friction follows the normal impulses
    int followed_ = 0;                          // times that they did so in this solution
    std::vector<bool> pressed_;                 // contacts that were pressed in one of them
    bool in_turns_ = false;                     // contacts took the load in turns, and do not together
    bool presses_ = true;                       // they did so together before in this step
    int cycled_ = 0, left_out_ = 0;             // passes in a row in which full Newton steps cycled, and passes since that left them out
    double tolerance_ = 0;                      // relative tolerance of impulses at the present width of the ramps
    double energy_ = 0;                         // kinetic energy of the free motion [J]
    std::int64_t solves_ = 0, last_solve_ = 0;  // number of solves, and the number at which the present step is abandoned
    int stuck_body_ = -1;
};

}  // namespace crumple::spatial
