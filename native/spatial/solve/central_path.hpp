// Path following (interior-point method) for steps in which many hinges lock and slide at once.
#pragma once

#include <vector>

#include "spatial/solve/central_hinge.hpp"
#include "spatial/solve/problem.hpp"

namespace crumple::spatial {

class NewtonSolver;

class CentralPath {
public:
    explicit CentralPath(Problem& problem);

    // whether there are rigid hinges, all with smooth surfaces
    bool exists() const { return exists_; }
    void relinked() { on_.assign(p_.connections.size(), 0); }
    // forgets the points of the last path of this step
    void forget() { kept_mu_ = 0; }
    // follows the path to its end and completes the solution with full Newton steps on the laws; false if either fails
    bool follow(NewtonSolver& newton, bool together);
    // whether a link is linearised on the path, and its linearisation there
    bool on(size_t link) const { return on_[link] != 0; }
    void linearise(size_t link, const double* w, double* impulse, double* slope, double* offset, double* tangent);

private:
    double enter(bool warm);
    double step(NewtonSolver& newton, bool together, double& least);
    void leave();

    Problem& p_;
    bool exists_ = false;
    std::vector<char> on_;                                     // per link
    std::vector<CentralPoint> point_, next_point_, kept_point_;  // per hinge
    std::vector<PathTangent> tangent_;                         // per hinge, at its present point
    std::vector<double> share_;                                // per hinge: share of the step to the next point
    double mu_ = 0, kept_mu_ = 0;                              // mu of the present and of the kept points [rad/s]; 0: none kept
};

}  // namespace crumple::spatial
