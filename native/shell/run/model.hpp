// What is computed: frozen once a state is made of it.  SI units, world axes.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "shell/element/part.hpp"
#include "common/vectors.hpp"

namespace crumple::shell {

using Index = std::uint32_t;

// Piecewise linear function of time, constant outside its range.
struct Curve {
    std::vector<double> time, value;
    double at(double t) const;
};

struct Material {
    double density, youngs_modulus, poissons_ratio;
    std::vector<double> plastic_strain, yield_stress;   // empty: elastic; constant beyond the last point
    double hardening_modulus;                           // slope behind a single point [Pa]; not with a rate effect
    double rate_reference, rate_exponent, rate_time;    // reference infinite: no rate effect
    double rate_logarithm;                              // above 0: Johnson-Cook C in place of the power law
    bool rigid;                                         // elements do not deform; their nodes belong to rigid sets
    double failure_strain;                              // infinite: never
    bool fails_at_any_point;
};

struct Sheet {                       // a part before lowering
    Index material;
    int points;
    bool lobatto;
};

struct RigidSet {
    std::vector<Index> nodes;
    double added_mass;
    Vec3 added_at;                   // where the added mass sits
    double added_inertia[6];         // xx, yy, zz, xy, yz, zx about its own centre
    unsigned fixed;                  // bits 0..5: x, y, z, rx, ry, rz held
    bool pinned;                     // x, y and z are held at `pin` instead of the centre of mass
    Vec3 pin;
};

struct SpotWeld {                    // tie of two sheets
    std::vector<Index> nodes;        // of both sheets
    std::vector<double> weight;      // of each; those of one sheet add up to 1
    std::size_t first;               // so many nodes are the first sheet's
    double normal_strength, shear_strength;      // [N]; infinite: does not fail
};

struct Load {                        // nodal force or moment
    Index node;
    int dof;                         // 0..5
    Curve value;
};

struct Motion {                      // prescribed velocity of a node or a rigid set's centre of mass
    bool rigid;
    Index target;
    int dof;
    Curve velocity;
};

enum class Shape : int { plane, edge, cylinder, pole, sphere };

struct Obstacle {                    // rigid
    Shape shape;                     // edge: a plane that ends; cylinder: with round ends; pole: without end
    Vec3 point;                      // on the plane or its edge, on the axis, or the centre
    Vec3 axis;                       // unit: normal out of the solid, or along the cylinder
    Vec3 edge;                       // unit and across the axis: out of the solid beyond the edge
    double radius, length;           // [m]
    double friction, gap;            // gap: kept beside half the wall's thickness [m]
    double damping;                  // of rigid sets, share of critical
    double mass;                     // 0: fixed or driven [kg]
    Vec3 guide, velocity;            // of a mass: unit vector of its way, velocity at the start [m/s]
    Curve motion[3];                 // prescribed velocity x, y, z; empty: none [m/s]
    Vec3 turn_about, turn_axis;      // fixed axis of a prescribed turn, unit
    Curve turning;                   // its rate [rad/s]; empty: none
    bool active;                     // there from the start of this model
    std::vector<Index> nodes;        // that can touch it
};

struct ContactSettings {
    bool on = false;                 // of walls with walls
    double gap = 0.0;                // 0: the thickness of the two walls, half each
    double stiffness = 0.1;          // share of the stability limit m / dt^2
    double friction = 0.0;           // of walls
    double damping = 0.0;            // share of critical
};

struct Cut {                         // forces through a cut: corners of `elements` that lie on `nodes`
    std::vector<Index> elements, nodes;
};

struct Settings {
    double safety = 0.9;
    double scaled_step = 0.0;        // elements below this stable step get mass [s]
    double least_step = 1e-12;       // below it the run stops [s]
    double damping = 0.0;            // mass-proportional [1/s]
    Vec3 gravity;
    bool thickness_update = true, warping_correction = false, viscous_hourglass = false;
    double hourglass_membrane = 0.01, hourglass_shear = 0.01, hourglass_bending = 0.01;
    bool stabilised = false;         // quadrilaterals are physically stabilised
    double drill_stiffness = 0.0;    // share of G V that holds the drill of quadrilaterals
};

struct Model {
    // nodes
    std::vector<double> position, velocity, spin;        // (n, 3)
    std::vector<double> added_mass, added_inertia;       // (n)
    std::vector<std::uint8_t> fixed;                     // (n) bits 0..5
    // elements; a triangle repeats its third node
    std::vector<Index> quads;                            // (m, 4)
    std::vector<double> thickness;                       // (m)
    std::vector<Index> sheet_of;                         // (m)
    std::vector<Material> materials;
    std::vector<Sheet> sheets;
    std::vector<RigidSet> rigid_sets;
    std::vector<SpotWeld> spot_welds;
    std::vector<Load> loads;
    std::vector<Motion> motions;
    std::vector<Obstacle> obstacles;
    std::vector<Cut> cuts;
    ContactSettings contact;
    Settings settings;

    std::size_t nodes() const { return position.size() / 3; }
    std::size_t elements() const { return thickness.size(); }
    bool triangle(std::size_t e) const { return quads[4 * e + 2] == quads[4 * e + 3]; }
    int corners(std::size_t e) const { return triangle(e) ? 3 : 4; }
};

// Throws std::invalid_argument naming the first node, element or set that cannot be computed.
void check(const Model& model);

// Area of an element [m2].
double area_of(const Model& model, std::size_t element);

}  // namespace crumple::shell
