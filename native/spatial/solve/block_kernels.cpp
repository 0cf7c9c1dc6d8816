// CRUMPLE_BLOCKS: the name of this build's table of functions.
#include "spatial/solve/block_kernels.hpp"

#include <algorithm>
#include <cmath>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace crumple::spatial {

namespace {

// Sizes of the most common blocks at compile time: six rows of joints, three of contacts.
template <int N>
struct Fixed {
    operator int() const { return N; }
};

// Share of the diagonal below which a pivot is rounding; smaller pivots are raised to it, and refinement corrects the solution.
constexpr double rounding = 2.2e-16;

template <class Use>
inline void with_size(int n, Use use) {
    if (n == 6) {
        use(Fixed<6>());
    } else if (n == 3) {
        use(Fixed<3>());
    } else {
        use(n);
    }
}

// The same of diagonal blocks: joints without laws and with one to four, and contacts.
template <class Use>
inline void with_rows(int held, int n, Use use) {
    if (n == 3 && held == 0) return use(Fixed<0>(), Fixed<3>());
    if (n != 6) return use(held, n);
    switch (held) {
        case 2: return use(Fixed<2>(), Fixed<6>());
        case 3: return use(Fixed<3>(), Fixed<6>());
        case 4: return use(Fixed<4>(), Fixed<6>());
        case 5: return use(Fixed<5>(), Fixed<6>());
        case 6: return use(Fixed<6>(), Fixed<6>());
        default: return use(held, n);
    }
}

#if defined(__AVX2__)
// Two rows of six, as they lie in memory.
struct TwoRows {
    __m256d front, across, back;
};

inline TwoRows load(const double* a) { return {_mm256_loadu_pd(a), _mm256_loadu_pd(a + 4), _mm256_loadu_pd(a + 8)}; }

inline void store(double* a, const TwoRows& r) {
    _mm256_storeu_pd(a, r.front);
    _mm256_storeu_pd(a + 4, r.across);
    _mm256_storeu_pd(a + 8, r.back);
}

// the row a (six) times two factors
inline TwoRows products(const double* a, double first, double second) {
    const __m256d even = _mm256_set1_pd(first), odd = _mm256_set1_pd(second), front = _mm256_loadu_pd(a), back = _mm256_loadu_pd(a + 2);
    const __m256d across = _mm256_permute2f128_pd(back, front, 0x21);
    return {_mm256_mul_pd(even, front), _mm256_mul_pd(_mm256_blend_pd(even, odd, 0xC), across), _mm256_mul_pd(odd, back)};
}

inline TwoRows operator+(const TwoRows& a, const TwoRows& b) {
    return {_mm256_add_pd(a.front, b.front), _mm256_add_pd(a.across, b.across), _mm256_add_pd(a.back, b.back)};
}

inline TwoRows operator-(const TwoRows& a, const TwoRows& b) {
    return {_mm256_sub_pd(a.front, b.front), _mm256_sub_pd(a.across, b.across), _mm256_sub_pd(a.back, b.back)};
}

inline TwoRows operator*(double factor, const TwoRows& a) {
    const __m256d f = _mm256_set1_pd(factor);
    return {_mm256_mul_pd(f, a.front), _mm256_mul_pd(f, a.across), _mm256_mul_pd(f, a.back)};
}

// For six rows and columns, the sums stay in nine registers.  Unrolled, the loops would need more registers than there are, so the compiler
// is not told that they usually have six iterations.
__attribute__((noinline)) void subtract_six(double* target, const double* a, const double* end, const double* b) {
    TwoRows r0 = load(target), r2 = load(target + 12), r4 = load(target + 24);
    for (; a != end; a += 6, b += 6) {
        r0 = r0 - products(a, b[0], b[1]);
        r2 = r2 - products(a, b[2], b[3]);
        r4 = r4 - products(a, b[4], b[5]);
    }
    store(target, r0);
    store(target + 12, r2);
    store(target + 24, r4);
}

__attribute__((noinline)) void add_six(double* block, const double* p, const double* q, const double* end, double sign) {
    const __m256d zero = _mm256_setzero_pd();
    TwoRows r0{zero, zero, zero}, r2 = r0, r4 = r0;
    for (; q != end; p += 1, q += 6) {
        r0 = r0 + products(q, p[0], p[6]);
        r2 = r2 + products(q, p[12], p[18]);
        r4 = r4 + products(q, p[24], p[30]);
    }
    store(block, load(block) + sign * r0);
    store(block + 12, load(block + 12) + sign * r2);
    store(block + 24, load(block + 24) + sign * r4);
}
#endif

template <class N, class M, class K>
inline void subtract(double* target, const double* a, const double* b, N n, M m, K k) {
    for (int j = 0; j < m; j++) {
        double row[most_block];
        for (int i = 0; i < n; i++) row[i] = target[j * n + i];
        for (int l = 0; l < k; l++) {
            for (int i = 0; i < n; i++) row[i] -= b[l * m + j] * a[l * n + i];
        }
        for (int i = 0; i < n; i++) target[j * n + i] = row[i];
    }
}

void subtract_product(double* target, const double* a, const double* b, int n, int m, int k) {
#if defined(__AVX2__)
    if (n == 6 && m == 6) return subtract_six(target, a, a + 6 * k, b);
#endif
    with_size(n, [&](auto l) {
        with_size(m, [&](auto j) { with_size(k, [&](auto i) { subtract(target, a, b, l, j, i); }); });
    });
}

template <class N, class M>
inline void add(double* block, const double* p, const double* q, double sign, N n, M m) {
    for (int i = 0; i < n; i++) {
        double row[most_block] = {};
        for (int k = 0; k < 6; k++) {
            for (int j = 0; j < m; j++) row[j] += p[6 * i + k] * q[most_block * k + j];
        }
        for (int j = 0; j < m; j++) block[i * m + j] += sign * row[j];
    }
}

void add_product(double* block, const double* p, const double* q, double sign, int n, int m) {
#if defined(__AVX2__)
    if (n == 6 && m == 6) return add_six(block, p, q, q + 36, sign);
#endif
    if (n == 6 && m == 6) {
        add(block, p, q, sign, Fixed<6>(), Fixed<6>());
    } else {
        add(block, p, q, sign, n, m);
    }
}

template <class N, class K, class H>
inline void solve_all(double* b, const double* lower, const double* reciprocal, N n, K k, H held) {
    for (int j = 0; j < held; j++) {
        double row[most_block];
        for (int i = 0; i < n; i++) row[i] = b[j * n + i];
        for (int l = 0; l < j; l++) {
            for (int i = 0; i < n; i++) row[i] -= lower[j * k + l] * b[l * n + i];
        }
        for (int i = 0; i < n; i++) b[j * n + i] = row[i] * reciprocal[j];
    }
    double laws[most_block][most_block];
    for (int j = held; j < k; j++) {
        double* row = laws[j - held];
        for (int i = 0; i < n; i++) row[i] = b[j * n + i];
        for (int l = 0; l < held; l++) {
            for (int i = 0; i < n; i++) row[i] -= lower[j * k + l] * b[l * n + i];
        }
    }
    for (int j = held; j < k; j++) {
        double row[most_block] = {};
        for (int l = held; l < k; l++) {
            for (int i = 0; i < n; i++) row[i] += lower[j * k + l] * laws[l - held][i];
        }
        for (int i = 0; i < n; i++) b[j * n + i] = row[i];
    }
}

void solve_rows(double* b, const double* lower, const double* reciprocal, int held, int n, int k) {
    with_size(n, [&](auto m) { with_rows(held, k, [&](auto h, auto i) { solve_all(b, lower, reciprocal, m, i, h); }); });
}

// Both keep what they change in registers, which may not be where the other arrays are.
void carry_forward(double* other, const double* b, const double* own, int n, int k) {
    with_size(n, [&](auto m) {
        double sum[most_block];
        for (int i = 0; i < m; i++) sum[i] = other[i];
        for (int l = 0; l < k; l++) {
            for (int i = 0; i < m; i++) sum[i] -= b[l * m + i] * own[l];
        }
        for (int i = 0; i < m; i++) other[i] = sum[i];
    });
}

void carry_back(double* own, const double* b, const double* other, int n, int k) {
    with_size(n, [&](auto m) {
        with_size(k, [&](auto j) {
            double sum[most_block] = {};
            for (int i = 0; i < m; i++) {
                for (int l = 0; l < j; l++) sum[l] += b[l * m + i] * other[i];
            }
            for (int l = 0; l < j; l++) own[l] -= sum[l];
        });
    });
}

// W from the part S that the held rows leave of the laws, in its place; `wide`: distance of its rows.
template <class N, class M>
inline void invert_laws(double* s, const double* root, N n, M wide) {
    double product[most_laws][most_laws], g[most_laws][most_laws];
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) {
            product[i][k] = 0;
            for (int j = 0; j < n; j++) product[i][k] += s[i * wide + j] * root[j * n + k];
        }
    }
    for (int l = 0; l < n; l++) {
        for (int k = 0; k <= l; k++) {
            g[l][k] = l == k ? 1 : 0;
            for (int i = 0; i < n; i++) g[l][k] += root[i * n + l] * product[i][k];
        }
    }
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < j; k++) g[j][j] -= g[j][k] * g[j][k];
        const double reciprocal = 1 / std::sqrt(std::max(g[j][j], 1.0));
        for (int i = j + 1; i < n; i++) {
            for (int k = 0; k < j; k++) g[i][j] -= g[i][k] * g[j][k];
            g[i][j] *= reciprocal;
        }
        // row j of W
        for (int i = 0; i < n; i++) {
            double w = root[i * n + j];
            for (int k = 0; k < j; k++) w -= g[j][k] * s[k * wide + i];
            s[j * wide + i] = w * reciprocal;
        }
    }
}

template <class H, class N>
inline void factor_rows(double* a, double* reciprocal, const double* before, const char* redundant, H held, N n) {
    for (int j = 0; j < held; j++) {
        double pivot = a[j * n + j];
        for (int k = 0; k < j; k++) pivot -= a[j * n + k] * a[j * n + k];
        if (redundant[j]) {
            reciprocal[j] = 0;
            for (int i = j; i < n; i++) a[i * n + j] = 0;
            continue;
        }
        a[j * n + j] = std::sqrt(std::max(pivot, rounding * before[j * n + j]));
        reciprocal[j] = 1 / a[j * n + j];
        for (int i = j + 1; i < n; i++) {
            double s = a[i * n + j];
            for (int k = 0; k < j; k++) s -= a[i * n + k] * a[j * n + k];
            a[i * n + j] = s * reciprocal[j];
        }
    }
    for (int i = held; i < n; i++) {
        for (int j = held; j <= i; j++) {
            for (int k = 0; k < held; k++) a[i * n + j] -= a[i * n + k] * a[j * n + k];
            a[j * n + i] = a[i * n + j];
        }
    }
}

void factor_diagonal(double* a, double* reciprocal, const double* before, const double* root, const char* redundant, BlockRows rows) {
    with_rows(rows.held, rows.all, [&](auto held, auto n) {
        factor_rows(a, reciprocal, before, redundant, held, n);
        double* laws = a + held * (n + 1);
        if (n - held == 3) {
            invert_laws(laws, root, Fixed<3>(), n);
        } else {
            invert_laws(laws, root, n - held, n);
        }
    });
}

void forward(double* own, const double* lower, const double* reciprocal, BlockRows rows) {
    with_rows(rows.held, rows.all, [&](auto held, auto n) {
        double x[most_block], laws[most_block] = {};
        for (int j = 0; j < held; j++) {
            x[j] = own[j];
            for (int l = 0; l < j; l++) x[j] -= lower[j * n + l] * x[l];
            x[j] *= reciprocal[j];
        }
        for (int j = held; j < n; j++) {
            x[j] = own[j];
            for (int l = 0; l < held; l++) x[j] -= lower[j * n + l] * x[l];
        }
        for (int j = held; j < n; j++) {
            for (int l = held; l < n; l++) laws[j] += lower[j * n + l] * x[l];
        }
        for (int j = 0; j < held; j++) own[j] = x[j];
        for (int j = held; j < n; j++) own[j] = laws[j];
    });
}

void backward(double* own, const double* lower, const double* reciprocal, BlockRows rows) {
    with_rows(rows.held, rows.all, [&](auto held, auto n) {
        double x[most_block] = {};
        for (int l = held; l < n; l++) {
            for (int j = held; j < n; j++) x[j] += lower[l * n + j] * own[l];
        }
        for (int j = held - 1; j >= 0; j--) {
            x[j] = own[j];
            for (int l = j + 1; l < n; l++) x[j] -= lower[l * n + j] * x[l];
            x[j] *= reciprocal[j];
        }
        for (int j = 0; j < n; j++) own[j] = x[j];
    });
}

}  // namespace

extern const BlockKernels CRUMPLE_BLOCKS;
const BlockKernels CRUMPLE_BLOCKS = {subtract_product, add_product, solve_rows,      carry_forward,
                                    carry_back,       factor_diagonal, forward,   backward};

}  // namespace crumple::spatial
