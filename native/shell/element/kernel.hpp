// Interface between the stepper and one build of the kernels (one instruction set).
#pragma once
#include <cstddef>
#include <cstdint>

#include "shell/element/part.hpp"

namespace crumple::shell {

// All elements, grouped in blocks of `lanes`; the last block of a part is padded with copies of an element.
struct ElementStage {
    const double* position;
    const double* velocity;
    const std::uint32_t* nodes;      // [block][corner][lane]
    const std::uint32_t* part_of;    // [block]
    const std::size_t* offset;       // [block] into state
    const Part* parts;
    double* state;
    double* corner;                  // [block of the chunk][lane][corner][corner_record]
    double dt;
    bool from_memory;                // the state does not fit into the caches
    double frequency_limit;          // squared frequency [1/s2] above which a step is refused
};

struct ElementReport {
    double frequency = 0.0;          // largest squared frequency 4/dt^2 of any element [1/s2]
    std::int64_t bad_block = -1;     // first block whose state is not finite or whose frequency is above the limit
};

// Sums of a chunk's corner forces.
struct SumStage {
    const double* corner;            // of the chunk
    const std::uint32_t* first;      // CSR of corners per sum
    const std::uint32_t* corner_of;
    double* sum;                     // [sum][corner_record]
};

// Free nodes; driven nodes and those of rigid bodies and spot welds are handled separately.
struct NodeStage {
    double* position;
    double* velocity;
    const double* inverse_mass;      // [node][velocity_record]; 0 for a fixed degree of freedom
    const double* sum;               // [sum][corner_record] force and moment of a chunk's elements
    const double* contact;           // [node][4] force, or null
    const double* seen;              // [node][position_record] positions when contact last checked all candidates, or null
    const std::uint8_t* kind;        // 0: free
    const std::uint32_t* first;      // CSR of sums per node
    const std::uint32_t* sum_of;
    double* damping_work;            // [chunk]; used when damping > 0
    double kick, drift;              // time steps of velocity and position [s]
    double damping;                  // mass-proportional [1/s]
    double gravity[3];
};
constexpr int node_chunk = 64;       // nodes per chunk: the sums of a chunk do not depend on the number of threads

struct Kernels {
    const char* name;
    int lanes;
    ElementReport (*elements)(const ElementStage&, std::size_t first, std::size_t last);
    void (*sums)(const SumStage&, std::size_t first, std::size_t last);
    // Returns the square of the largest displacement from `seen`.
    double (*nodes)(const NodeStage&, std::size_t first, std::size_t last);
};

// The build named by the environment variable CRUMPLE_ISA, else the best that this processor supports.
const Kernels& choose_kernels(const char* name);

}  // namespace crumple::shell
