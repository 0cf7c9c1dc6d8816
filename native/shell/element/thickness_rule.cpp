// Gauss-Legendre and Gauss-Lobatto rules through the thickness; the points are computed by Newton's method on Legendre polynomials.
#include <cmath>

#include "shell/run/lowering.hpp"

namespace crumple::shell {

constexpr double pi = 3.14159265358979323846;

struct Legendre {
    double value, before;        // P_n and P_{n-1}
};

static Legendre legendre(int n, double x) {
    double p0 = 1.0, p1 = x;
    if (n == 0) return {1.0, 0.0};
    for (int k = 2; k <= n; k++) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
    }
    return {p1, p0};
}

// roots of P_n
static void gauss(int n, double* z, double* weight) {
    for (int i = 0; i < n; i++) {
        double x = -std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 100; step++) {
            const Legendre p = legendre(n, x);
            slope = n * (x * p.value - p.before) / (x * x - 1.0);
            x -= p.value / slope;
            if (std::abs(p.value / slope) < 1e-16) break;
        }
        if (2 * i + 1 == n) x = 0.0;
        z[i] = 0.5 * x;
        weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
}

// ends and roots of P'_{n-1}
static void lobatto(int n, double* z, double* weight) {
    const int m = n - 1;
    for (int i = 0; i < n; i++) {
        double x = -std::cos(pi * i / m);
        if (i > 0 && i < m)
            for (int step = 0; step < 100; step++) {
                const Legendre p = legendre(m, x);
                const double slope = m * (x * p.value - p.before) / (x * x - 1.0);
                const double curvature = (2.0 * x * slope - m * (m + 1.0) * p.value) / (1.0 - x * x);
                const double change = slope / curvature;
                x -= change;
                if (std::abs(change) < 1e-16) break;
            }
        if (2 * i == m) x = 0.0;
        const double p = legendre(m, x).value;
        z[i] = 0.5 * x;
        weight[i] = 1.0 / (n * m * p * p);
    }
}

void thickness_rule(int points, bool use_lobatto, double* z, double* weight) {
    if (use_lobatto)
        lobatto(points, z, weight);
    else
        gauss(points, z, weight);
    // make both halves identical to the last bit, so that a flat sheet has no spurious bending
    for (int i = 0; i < points / 2; i++) {
        z[points - 1 - i] = -z[i];
        weight[points - 1 - i] = weight[i];
    }
}

}  // namespace crumple::shell
