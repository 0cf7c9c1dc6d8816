// Eigenvalues and eigenvectors of small symmetric matrices by Jacobi rotations.
#pragma once

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

// a (n x n, n <= 4, symmetric; destroyed), columns of v its eigenvectors
inline void eigenvectors(int n, double* a, double* value, double* v) {
    std::fill(v, v + n * n, 0.0);
    for (int i = 0; i < n; i++) v[i * (n + 1)] = 1;
    for (int sweep = 0; sweep < 20 && n > 1; sweep++) {
        bool diagonal = true;
        for (int p = 0; p < n; p++) {
            for (int q = p + 1; q < n; q++) {
                const double apq = a[p * n + q];
                // relative to these two diagonal entries only: the normal stiffness of a contact is 1e16 times that of its friction
                if (std::fabs(apq) <= 1e-16 * std::max(std::fabs(a[p * n + p]), std::fabs(a[q * n + q]))) continue;
                diagonal = false;
                const double theta = (a[q * n + q] - a[p * n + p]) / (2 * apq);
                const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < n; k++) {
                    const double x = a[k * n + p], y = a[k * n + q];
                    a[k * n + p] = c * x - s * y;
                    a[k * n + q] = s * x + c * y;
                }
                for (int k = 0; k < n; k++) {
                    const double x = a[p * n + k], y = a[q * n + k];
                    a[p * n + k] = c * x - s * y;
                    a[q * n + k] = s * x + c * y;
                }
                for (int k = 0; k < n; k++) {
                    const double x = v[k * n + p], y = v[k * n + q];
                    v[k * n + p] = c * x - s * y;
                    v[k * n + q] = s * x + c * y;
                }
            }
        }
        if (diagonal) break;
    }
    for (int i = 0; i < n; i++) value[i] = a[i * (n + 1)];
}

}  // namespace crumple::spatial
