// Small dense solver for constraint forces: the matrix is symmetric positive semi-definite, singular if constraints are redundant.
#pragma once

#include "hinge/real.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

using namespace hinge;

// Solves a x = b in place (b becomes x) by LDL^T factorisation.  A redundant row (pivot below 1e-12 of its diagonal) gets x = 0.
inline void solve_symmetric(Real* a, Real* b, int n) {
    for (int j = 0; j < n; j++) {
        Real pivot = a[j * n + j];
        const Real threshold = 1e-12 * pivot;
        for (int k = 0; k < j; k++) pivot -= a[j * n + k] * a[j * n + k] * a[k * n + k];
        if (!(pivot > threshold)) pivot = 0;
        a[j * n + j] = pivot;
        for (int i = j + 1; i < n; i++) {
            Real s = a[i * n + j];
            for (int k = 0; k < j; k++) s -= a[i * n + k] * a[j * n + k] * a[k * n + k];
            a[i * n + j] = pivot > 0 ? s / pivot : 0;
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) b[i] -= a[i * n + k] * b[k];
    }
    for (int i = 0; i < n; i++) b[i] = a[i * n + i] > 0 ? b[i] / a[i * n + i] : 0;
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) b[i] -= a[k * n + i] * b[k];
    }
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
