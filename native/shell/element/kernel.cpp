// The element and node stages, compiled once for each instruction set (CRUMPLE_KERNELS names the build).
#include "shell/element/kernel.hpp"

#include <algorithm>

#include "shell/element/element.hpp"
#include "shell/simd/transpose.hpp"

namespace crumple::shell {
namespace {

template <Formulation kind, Law law, int points>
inline void run_block(const ElementStage& stage, const Part& part, std::size_t block, double* out, Real& stiffest) {
    constexpr int corners = kind == Formulation::triangle ? 3 : 4;
    Vec x[4], v[4], w[4];
    for (int c = 0; c < corners; c++) {
        const std::uint32_t* node = stage.nodes + lanes * (4 * block + c);
        x[c] = gather(stage.position, position_record, node);
        v[c] = gather(stage.velocity, velocity_record, node);
        w[c] = gather(stage.velocity + 4, velocity_record, node);
    }
    // the frame of a triangle is that of a quadrilateral whose last side has no length
    if constexpr (corners == 3) {
        x[3] = x[2];
        v[3] = v[2];
        w[3] = w[2];
    }
    Real* slots = reinterpret_cast<Real*>(stage.state + stage.offset[block]);
    const CornerForces forces = update_block<kind, law, points>(part, {x, v, w, stage.dt}, slots, stiffest);
    for (int c = 0; c < corners; c++) {
        scatter(forces.force[c], out + corner_record * c, 4 * corner_record);
        scatter(forces.moment[c], out + corner_record * c + 4, 4 * corner_record);
    }
}

template <Formulation kind, int points>
inline void run_any_law(const ElementStage& stage, const Part& part, std::size_t block, double* out, Real& stiffest) {
    switch (part.law) {
        case Law::elastic: return run_block<kind, Law::elastic, points>(stage, part, block, out, stiffest);
        case Law::linear: return run_block<kind, Law::linear, points>(stage, part, block, out, stiffest);
        case Law::general: return run_block<kind, Law::general, points>(stage, part, block, out, stiffest);
    }
}

template <Formulation kind>
inline void run_any_points(const ElementStage& stage, const Part& part, std::size_t block, double* out, Real& stiffest) {
    if (part.points == 5)
        run_any_law<kind, 5>(stage, part, block, out, stiffest);
    else
        run_any_law<kind, 0>(stage, part, block, out, stiffest);
}

inline void run_any_shape(const ElementStage& stage, const Part& part, std::size_t block, double* out, Real& stiffest) {
    // the buffer of corner forces is reused by other blocks, so it must be cleared
    if (part.rigid) {
        std::fill_n(out, 4 * corner_record * lanes, 0.0);
        return;
    }
    switch (part.formulation) {
        case Formulation::one_point: return run_any_points<Formulation::one_point>(stage, part, block, out, stiffest);
        case Formulation::stabilised: return run_any_points<Formulation::stabilised>(stage, part, block, out, stiffest);
        // triangles are few: no unrolling over the points
        case Formulation::triangle: return run_any_law<Formulation::triangle, 0>(stage, part, block, out, stiffest);
    }
}

// Prefetches the next block's state while the present one is computed.
inline void prefetch(const double* next, std::size_t size) {
    for (std::size_t i = 0; i < size; i += 8) __builtin_prefetch(next + i, 1);
}

ElementReport run_elements(const ElementStage& stage, std::size_t first, std::size_t last) {
    ElementReport report;
    Real stiffest_of_all{};
    double* out = stage.corner;
    for (std::size_t block = first; block < last; block++, out += 4 * corner_record * lanes) {
        const Part& part = stage.parts[stage.part_of[block]];
        if (stage.from_memory) prefetch(stage.state + stage.offset[block + 1], stage.offset[block + 1] - stage.offset[block]);
        Real stiffest{};
        run_any_shape(stage, part, block, out, stiffest);
        // written so that NaN counts as beyond the limit
        const Mask fine = stiffest <= stage.frequency_limit;
        if (report.bad_block < 0 && any(~fine)) report.bad_block = std::int64_t(block);
        stiffest_of_all = larger(stiffest, stiffest_of_all);
    }
    for (int i = 0; i < lanes; i++)
        if (stiffest_of_all[i] > report.frequency) report.frequency = stiffest_of_all[i];
    return report;
}

void run_sums(const SumStage& stage, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; i++) {
        Quad force{}, moment{};
        for (std::uint32_t j = stage.first[i]; j < stage.first[i + 1]; j++) {
            const double* corner = stage.corner + std::size_t(corner_record) * stage.corner_of[j];
            force += load(corner);
            moment += load(corner + 4);
        }
        store(stage.sum + corner_record * i, force);
        store(stage.sum + corner_record * i + 4, moment);
    }
}

// velocity and position of one free node; returns the work of damping per mass-proportional coefficient [J s]
inline void run_node(const NodeStage& s, std::size_t i, Quad gravity, double& damped) {
    Quad force{}, moment{};
    for (std::uint32_t j = s.first[i]; j < s.first[i + 1]; j++) {
        const double* sum = s.sum + std::size_t(corner_record) * s.sum_of[j];
        force += load(sum);
        moment += load(sum + 4);
    }
    if (s.contact) force -= load(s.contact + 4 * i);
    double* velocity = s.velocity + velocity_record * i;
    const double* inverse_mass = s.inverse_mass + velocity_record * i;
    const Quad im = load(inverse_mass), ii = load(inverse_mass + 4);
    const Quad v_old = load(velocity), w_old = load(velocity + 4);
    // gravity acts on free degrees of freedom with mass only
    Quad v = v_old - s.kick * (im * force) + s.kick * (im > 0.0 ? gravity : Quad{});
    Quad w = w_old - s.kick * (ii * moment);
    if (s.damping > 0.0) {
        const double a = 0.5 * s.kick * s.damping, shrink = 1.0 / (1.0 + a);
        v = shrink * (v - a * v_old);
        w = shrink * (w - a * w_old);
        const Quad vm = 0.5 * (v + v_old), wm = 0.5 * (w + w_old);
        const Quad e = (im > 0.0 ? vm * vm / im : Quad{}) + (ii > 0.0 ? wm * wm / ii : Quad{});
        damped += s.damping * s.kick * (e[0] + e[1] + e[2]);
    }
    store(velocity, v);
    store(velocity + 4, w);
    double* position = s.position + position_record * i;
    store(position, load(position) + s.drift * v);
}

double run_nodes(const NodeStage& stage, std::size_t first, std::size_t last) {
    const Quad gravity = {stage.gravity[0], stage.gravity[1], stage.gravity[2], 0.0};
    double farthest = 0.0;
    for (std::size_t i = first; i < last; i++) {
        if (stage.kind[i] != 0) continue;
        run_node(stage, i, gravity, stage.damping_work[i / node_chunk]);
        if (!stage.seen) continue;
        const Quad way = load(stage.position + position_record * i) - load(stage.seen + position_record * i), square = way * way;
        farthest = std::max(farthest, square[0] + square[1] + square[2]);
    }
    return farthest;
}

}  // namespace

extern const Kernels CRUMPLE_KERNELS;
const Kernels CRUMPLE_KERNELS = {CRUMPLE_KERNELS_NAME, lanes, run_elements, run_sums, run_nodes};

}  // namespace crumple::shell
