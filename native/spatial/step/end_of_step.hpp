// The end of a step: positions, states of the laws, and energies.
#pragma once

#include <vector>

#include "spatial/step/contact_step.hpp"

namespace crumple::spatial {

class EndOfStep {
public:
    EndOfStep(Problem& problem, ContactStep& contact) : p_(problem), contact_(contact), direction_(problem.model.bodies.size()) {}

    // false if the held rows cannot be satisfied, or a value is not finite; `search` as in `ContactStep::see`
    bool commit(State& s, double h, bool search);

private:
    void work_on_links(State& s, double h);
    void turn_hinges(State& s);
    void follow_forces(State& s, double h);
    void work_of_loads(State& s, double h);
    bool project_positions(State& s, double h);
    bool meets() const;
    bool project_rates(State& s, double h);
    double largest_held(const std::vector<double>& rate) const;
    double largest_speed() const;
    void show_forces(State& s, double h);
    bool drives_obstacle(size_t joint) const;
    double inertial_energy(size_t body) const;
    double stand_in_energy(size_t joint) const;

    Problem& p_;
    ContactStep& contact_;
    std::vector<Twist> direction_;
    std::vector<double> work_, left_;
};

}  // namespace crumple::spatial
