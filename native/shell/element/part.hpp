// Constants of a group of elements with the same material, thickness rule, hourglass control and options.
#pragma once
#include "shell/simd/layout.hpp"

namespace crumple::shell {

enum class Law : int { elastic, linear, general };   // no yield | linear hardening | table, rate or both
enum class Formulation : int { one_point, stabilised, triangle };
enum class Rate : int { none, power, logarithm };    // Cowper-Symonds | Johnson-Cook

struct Part {
    double youngs_modulus, poissons_ratio, density;
    double plane_modulus;        // E / (1 - nu^2)
    double shear_modulus;        // G
    double transverse_modulus;   // 5/6 G
    double pressure_ratio;       // R = (1 + nu) / (3 (1 - nu)): rate of return of the mean stress relative to the deviator
    double bulk_compliance;      // (1 - 2 nu) / E: elastic change of volume per in-plane trace of stress
    double inverse_3g;           // 1 / (3 G)
    Formulation formulation;
    Law law;
    bool rigid;                  // its nodes belong to a rigid body, so its elements have no strain
    double yield_stress, hardening;              // Law::linear: Y = yield_stress + hardening * plastic strain
    int table_size;                              // Law::general
    const double* table_strain;
    const double* table_stress;
    Rate rate;
    double inverse_rate_reference, rate_exponent, rate_time;   // exponent: 1/q, or C of the logarithm
    bool fails, fails_at_any_point;
    double failure_strain;
    int points;
    double z[max_points], weight[max_points];    // in units of the thickness, z in [-1/2, 1/2] mirrored, weights sum to 1
    double second_moment;        // sum of weight z^2
    double half_compliance, half_shear_compliance;             // 1 / (2 E), 1 / (2 G) [1/Pa]
    bool viscous_hourglass;
    double hourglass_membrane, hourglass_shear, hourglass_bending;
    double hourglass_moduli[3];  // of stiffness, in that order [Pa]: see hourglass.hpp
    bool thickness_update, warping_correction;
    double drill_stiffness;      // drilling stiffness as a share of G V; 0: none
    bool extra() const { return formulation == Formulation::stabilised || drill_stiffness > 0.0; }
};

}  // namespace crumple::shell
