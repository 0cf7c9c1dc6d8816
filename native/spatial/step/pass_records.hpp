// The passes of a run that are stored for followers, or are those of the run that is followed (run/step_record.hpp).
#pragma once

#include <vector>

#include "spatial/run/step_record.hpp"
#include "spatial/solve/newton.hpp"

namespace crumple::spatial {

class PassRecords {
public:
    // `keep` stores the solutions of the passes from now on, `follow` uses those of another run; null ends either
    void keep(std::vector<Pass>* passes) { kept_ = passes; }
    void follow(const std::vector<Pass>* passes) { followed_ = passes, next_ = 0; }
    bool following() const { return followed_ != nullptr; }
    // solves a pass by a single Newton step from the leader's solution
    bool solve(Problem& problem, NewtonSolver& newton) const;
    // after a pass: stores it, and returns whether no further one is needed, which the leader decides if there is one
    bool settled(const Problem& problem, bool settled);

private:
    std::vector<Pass>* kept_ = nullptr;
    const std::vector<Pass>* followed_ = nullptr;
    size_t next_ = 0;  // index of the next pass to follow
};

}  // namespace crumple::spatial
