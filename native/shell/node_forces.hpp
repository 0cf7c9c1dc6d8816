// Contact forces on nodes, summed by one thread in a fixed order, and what contact knows of the sheets.
#pragma once
#include "aligned.hpp"
#include "lowering.hpp"
#include "penalty.hpp"

namespace crumple::shell {

// What every kind of contact reads: constants of the run.
struct Sheets {
    const Model& model;
    std::vector<double> mass, half;  // [node] mass [kg], half the mean thickness of its elements [m]; 0 beside walls
    double step;                     // time step of the penalty [s]

    Sheets(const Model& model, const Masses& masses, double step);
    double half_of(std::size_t element) const { return 0.5 * model.thickness[element]; }
    void corners(const double* position, int stride, std::size_t element, Vec3 (&x)[4]) const {
        for (std::size_t c = 0; c < 4; c++) x[c] = read3(position + std::size_t(stride) * model.quads[4 * element + c]);
    }
};

class NodeForces {
public:
    explicit NodeForces(std::size_t nodes = 0) : force_(4 * nodes, 0.0) {}

    void clear() {
        for (Index n : touched_)
            for (std::size_t i = 0; i < 4; i++) force_[4 * n + i] = 0.0;
        touched_.clear();
    }
    void add(Index n, Vec3 f) {
        add3(&force_[4 * n], f);
        if (force_[4 * n + 3] == 0.0) {
            force_[4 * n + 3] = 1.0;     // the unused fourth number marks a touched node
            touched_.push_back(n);
        }
    }
    // Power on the nodes [W].
    double power(const Motions& m) const {
        double sum = 0.0;
        for (Index n : touched_) sum += dot(read3(&force_[4 * n]), velocity_of(m, n));
        return sum;
    }
    const double* data() const { return force_.data(); }
    std::size_t touched() const { return touched_.size(); }
    void save(std::vector<double>& out) const;
    void restore(const double*& in);

private:
    aligned_vector<double> force_;   // [node][4]
    std::vector<Index> touched_;
};

}  // namespace crumple::shell
