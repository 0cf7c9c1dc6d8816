// Loads and stores of records of four doubles: whole records, transposed 4 by 4 in registers.
#pragma once
#include <utility>

#include "shell/simd/pack.hpp"

namespace crumple::shell {
namespace {

CRUMPLE_INLINE Quad load(const double* p) { return *reinterpret_cast<const Quad*>(p); }
CRUMPLE_INLINE void store(double* p, Quad q) { *reinterpret_cast<Quad*>(p) = q; }

#if defined(__AVX2__)

// within each group of four lanes; 0, 1: even or odd lanes of a and b interleaved; 2, 3: low or high pairs
template <int which, int... i> CRUMPLE_INLINE Real shuffle_(Real a, Real b, std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(a, b, (which < 2 ? (i % 2 ? lanes + i - 1 + which : i + which)
                                                    : (i % 4 < 2 ? i + 2 * (which - 2) : lanes + i - 2 + 2 * (which - 2)))...);
}
template <int which> CRUMPLE_INLINE Real shuffle(Real a, Real b) {
    return shuffle_<which>(a, b, std::make_integer_sequence<int, lanes>());
}

// the records of node[0], node[4] ... side by side in one register
CRUMPLE_INLINE Real row(const double* p, int stride, const std::uint32_t* node) {
    auto record = [&](int i) { return load(p + std::size_t(stride) * node[i]); };
#if defined(__AVX512F__)
    return __builtin_shufflevector(record(0), record(4), 0, 1, 2, 3, 4, 5, 6, 7);
#else
    return record(0);
#endif
}
CRUMPLE_INLINE void put_row(Real t, double* p, int stride) {
#if defined(__AVX512F__)
    store(p, __builtin_shufflevector(t, t, 0, 1, 2, 3));
    store(p + 4 * stride, __builtin_shufflevector(t, t, 4, 5, 6, 7));
#else
    (void)stride;
    store(p, t);
#endif
}

CRUMPLE_INLINE Vec gather(const double* p, int stride, const std::uint32_t* node) {
    Real r0 = row(p, stride, node), r1 = row(p, stride, node + 1);
    Real r2 = row(p, stride, node + 2), r3 = row(p, stride, node + 3);
    Real a = shuffle<0>(r0, r1), b = shuffle<1>(r0, r1), c = shuffle<0>(r2, r3), d = shuffle<1>(r2, r3);
    return {shuffle<2>(a, c), shuffle<2>(b, d), shuffle<3>(a, c)};
}
CRUMPLE_INLINE void scatter(Vec v, double* p, int stride) {
    Real zero{}, a = shuffle<0>(v.x, v.y), b = shuffle<1>(v.x, v.y), c = shuffle<0>(v.z, zero), d = shuffle<1>(v.z, zero);
    put_row(shuffle<2>(a, c), p, stride);
    put_row(shuffle<2>(b, d), p + stride, stride);
    put_row(shuffle<3>(a, c), p + 2 * stride, stride);
    put_row(shuffle<3>(b, d), p + 3 * stride, stride);
}

#else

CRUMPLE_INLINE Vec gather(const double* p, int stride, const std::uint32_t* node) {
    const double *a = p + std::size_t(stride) * node[0], *b = p + std::size_t(stride) * node[1];
    return {Real{a[0], b[0]}, Real{a[1], b[1]}, Real{a[2], b[2]}};
}
CRUMPLE_INLINE void scatter(Vec v, double* p, int stride) {
    for (int i = 0; i < lanes; i++, p += stride) {
        p[0] = v.x[i];
        p[1] = v.y[i];
        p[2] = v.z[i];
        p[3] = 0.0;
    }
}

#endif

}  // namespace
}  // namespace crumple::shell
