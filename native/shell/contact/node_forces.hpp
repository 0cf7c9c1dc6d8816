// Contact forces on nodes, summed in a fixed order, and the sheet data that all kinds of contact read.
#pragma once
#include "shell/run/lowering.hpp"
#include "shell/run/saved.hpp"
#include "shell/contact/penalty.hpp"
#include "common/team.hpp"

namespace crumple::shell {

// Constants of the run that every kind of contact reads.
struct Sheets {
    const Model& model;
    std::vector<double> mass, half;  // [node] mass [kg], half the mean thickness of its elements [m]; 0 for nodes without elements
    double step;                     // time step of the penalty [s]

    Sheets(const Model& model, const Masses& masses, double step);
    double half_of(std::size_t element) const { return 0.5 * model.thickness[element]; }
    void corners(const double* position, int stride, std::size_t element, Vec3 (&x)[4]) const {
        for (std::size_t c = 0; c < 4; c++) x[c] = read3(position + std::size_t(stride) * model.quads[4 * element + c]);
    }
};

// Contact forces on nodes, stored separately for the member of the team that owns the node.
class FoundForces {
public:
    // Discards all forces; nodes are distributed among `members` in chunks, see share_of.
    void clear(std::size_t nodes, int members) {
        chunks_ = (nodes + node_chunk - 1) / node_chunk;
        for (std::vector<Found>& f : found_) f.clear();
        found_.resize(std::size_t(members));
        deepest = 0.0;
    }
    void add(Index n, Vec3 force) {
        // the member whose share contains the node's chunk
        const std::size_t owner = ((n / node_chunk + 1) * found_.size() - 1) / chunks_;
        found_[owner].push_back({n, force});
    }
    struct Found {
        Index node;
        Vec3 force;
    };
    const std::vector<Found>& of(const Member& owner) const { return found_[std::size_t(owner.index)]; }

    double deepest = 0.0;            // largest penetration relative to the gap

private:
    std::vector<std::vector<Found>> found_;      // [member]
    std::size_t chunks_ = 0;
};

class NodeForces {
public:
    explicit NodeForces(std::size_t nodes = 0) : force_(4 * nodes, 0.0), touched_((nodes + node_chunk - 1) / node_chunk) {}

    std::size_t chunks() const { return touched_.size(); }
    void clear(Range chunks) {
        for (std::size_t c = chunks.first; c < chunks.last; c++) {
            for (Index n : touched_[c]) std::fill_n(&force_[4 * n], 4, 0.0);
            touched_[c].clear();
        }
    }
    // Must be called by the member that owns the node's chunk.
    void add(Index n, Vec3 f) {
        add3(&force_[4 * n], f);
        if (force_[4 * n + 3] == 0.0) {
            force_[4 * n + 3] = 1.0;     // the unused fourth number marks a touched node
            touched_[n / std::size_t(node_chunk)].push_back(n);
        }
    }
    // Power of the forces on the nodes of a chunk [W].
    double power(const Motions& m, std::size_t chunk) const {
        double sum = 0.0;
        for (Index n : touched_[chunk]) sum += dot(read3(&force_[4 * n]), velocity_of(m, n));
        return sum;
    }
    const double* data() const { return force_.data(); }
    std::size_t touched() const {
        std::size_t count = 0;
        for (const std::vector<Index>& chunk : touched_) count += chunk.size();
        return count;
    }
    void save(std::vector<double>& out) const;
    void restore(Saved& in);

private:
    aligned_vector<double> force_;               // [node][4]
    std::vector<std::vector<Index>> touched_;    // [chunk of nodes]
};

}  // namespace crumple::shell
