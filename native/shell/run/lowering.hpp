// Conversion of a model to the data of the kernels: parts with their constants, blocks of lanes, lumped masses, corners per node.
#pragma once
#include "common/aligned.hpp"
#include "shell/element/kernel.hpp"
#include "shell/run/model.hpp"

namespace crumple::shell {

// Elements per chunk: their corner forces fit into the first-level cache, and a mesh of a few thousand elements has enough
// chunks for an even distribution among threads.  A multiple of any number of lanes.
constexpr std::size_t elements_per_chunk = 128;

// Blocks are processed in chunks.  The forces at the corners of a chunk's elements are summed per node while they are in the cache; a
// node that belongs to several chunks has a sum in each.  The elements of a chunk depend neither on the number of threads nor on the
// number of lanes, so that the order of summation does not either.
struct Chunks {
    std::vector<std::uint32_t> block;            // [chunk] first block; one more entry: their number
    std::vector<std::uint32_t> sums;             // [chunk] first sum; one more entry: their number
    std::vector<std::uint32_t> first, corner_of; // CSR: corner records, counted from the chunk's first, of each sum
    std::vector<std::uint32_t> kept;             // [chunk] first corner that a cut reads; one more entry
    std::vector<std::uint32_t> kept_corner;      // corner record of each, counted from the chunk's first
    std::size_t count() const { return block.size() - 1; }
};

struct Blocks {
    int lanes = 0;
    std::vector<Part> parts;
    aligned_vector<std::uint32_t> nodes;         // [block][corner][lane]
    std::vector<std::uint32_t> part_of;          // [block]
    std::vector<std::size_t> offset;             // [block]; one more entry: the size of the state
    std::vector<std::int64_t> element_of;        // [block][lane]; -1 for a copy that pads a block
    std::vector<std::size_t> place_of;           // [element] -> block * lanes + lane
    std::vector<std::uint32_t> first, sum_of;    // CSR: sums of each node
    std::vector<std::vector<std::uint32_t>> cut_corners; // [cut]: kept corner of each element and each of its cut nodes
    Chunks chunks;
    std::size_t count() const { return part_of.size(); }
    // index into the state of one slot of one element
    std::size_t slot(std::size_t element, int slot) const {
        const std::size_t place = place_of[element], block = place / std::size_t(lanes);
        return offset[block] + std::size_t(slot) * std::size_t(lanes) + place % std::size_t(lanes);
    }
    const Part& part(std::size_t element) const { return parts[part_of[place_of[element] / std::size_t(lanes)]]; }
    std::size_t corner(std::size_t element, int c) const { return 4 * place_of[element] + std::size_t(c); }
};

struct Masses {
    std::vector<double> mass, inertia;           // [node]; isotropic rotary inertia [kg m2]
    std::vector<double> scale;                   // [element] factor on the density from mass scaling
    std::vector<double> loose;                   // [element] factor on the squared frequency of the ends of strips
    double added = 0.0;                          // mass added by scaling [kg]
    double structure = 0.0;                      // mass of the elements without the added mass [kg]
};

Part part_of(const Model& model, const Sheet& sheet, bool triangle);
Blocks block_up(const Model& model, int lanes);
Masses lump(const Model& model);
// Stable time step of an element in its initial shape and with its own density [s], without safety factor.
double first_stable_step(const Model& model, std::size_t element);
// Points z in [-1/2, 1/2] and weights that sum to 1.
void thickness_rule(int points, bool lobatto, double* z, double* weight);

}  // namespace crumple::shell
