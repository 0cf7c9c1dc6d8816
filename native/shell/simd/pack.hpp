// Vector types with the register width of the instruction set, and 3-vectors of them.
//
// Everything is in an unnamed namespace: each instruction set compiles its own copy, and the linker
// must not merge them.
#pragma once
#include <cstdint>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define CRUMPLE_INLINE inline __attribute__((always_inline))

namespace crumple::shell {
namespace {

#if defined(__AVX512F__)
constexpr int lanes = 8;
#elif defined(__AVX2__)
constexpr int lanes = 4;
#else
constexpr int lanes = 2;
#endif

template <int n> using pack __attribute__((vector_size(n * sizeof(double)))) = double;
using Real = pack<lanes>;
using Quad = pack<4>;
using Mask = decltype(Real{} < Real{});

CRUMPLE_INLINE Real root(Real a) {
#if defined(__AVX512F__)
    return Real(_mm512_sqrt_pd(__m512d(a)));
#elif defined(__AVX2__)
    return Real(_mm256_sqrt_pd(__m256d(a)));
#elif defined(__SSE2__)
    return Real(_mm_sqrt_pd(__m128d(a)));
#else
    Real r{};
    for (int i = 0; i < lanes; i++) r[i] = __builtin_sqrt(a[i]);
    return r;
#endif
}

CRUMPLE_INLINE bool any(Mask m) {
#if defined(__AVX512DQ__)
    return _mm512_movepi64_mask(__m512i(m)) != 0;
#elif defined(__AVX2__)
    return _mm256_movemask_pd(__m256d(m)) != 0;
#elif defined(__SSE2__)
    return _mm_movemask_pd(__m128d(m)) != 0;
#else
    bool r = false;
    for (int i = 0; i < lanes; i++) r |= m[i] != 0;
    return r;
#endif
}

CRUMPLE_INLINE Real all(double a) { return Real{} + a; }
CRUMPLE_INLINE Real larger(Real a, Real b) { return a > b ? a : b; }
CRUMPLE_INLINE Real magnitude(Real a) { return a < 0.0 ? -a : a; }

struct Vec {
    Real x, y, z;
};
CRUMPLE_INLINE Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
CRUMPLE_INLINE Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
CRUMPLE_INLINE Vec operator*(Real s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
CRUMPLE_INLINE Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
CRUMPLE_INLINE Real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
CRUMPLE_INLINE Vec cross(Vec a, Vec b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace
}  // namespace crumple::shell
