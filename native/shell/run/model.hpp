// The model of a run: constant once a state has been created from it.  SI units, world axes.
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
    double hardening_modulus;                           // slope after a single point [Pa]; not with a rate effect
    double rate_reference, rate_exponent, rate_time;    // reference infinite: no rate effect
    double rate_logarithm;                              // > 0: Johnson-Cook C instead of the power law
    bool rigid;                                         // elements do not deform; their nodes belong to rigid sets
    double failure_strain;                              // infinite: never
    bool fails_at_any_point;
};

struct Sheet {                       // elements of one material and thickness rule; becomes a Part
    Index material;
    int points;
    bool lobatto;
};

struct RigidSet {
    std::vector<Index> nodes;
    double added_mass;
    Vec3 added_at;                   // position of the added mass
    double added_inertia[6];         // xx, yy, zz, xy, yz, zx about that position
    unsigned fixed;                  // bits 0..5: x, y, z, rx, ry, rz held
    bool pinned;                     // x, y and z are held at `pin` instead of the centre of mass
    Vec3 pin;
};

struct SpotWeld {                    // tie of two sheets
    std::vector<Index> nodes;        // of both sheets
    std::vector<double> weight;      // of each node; the weights of one sheet add up to 1
    std::size_t first;               // number of nodes of the first sheet, which come first
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
    Shape shape;                     // edge: half plane; cylinder: with round ends; pole: infinite cylinder
    Vec3 point;                      // on the plane or its edge, on the axis, or the centre
    Vec3 axis;                       // unit: normal out of the solid, or along the cylinder
    Vec3 edge;                       // unit vector perpendicular to the axis, out of the solid beyond the edge
    double radius, length;           // [m]
    double friction, gap;            // gap: distance kept in addition to half the wall's thickness [m]
    double damping;                  // damping ratio of contacts of rigid sets
    double mass;                     // 0: fixed or driven [kg]
    Vec3 guide, velocity;            // with mass: unit vector of the guide, velocity at the start [m/s]
    Curve motion[3];                 // prescribed velocity x, y, z; empty: none [m/s]
    Vec3 turn_about, turn_axis;      // point on and unit vector of the fixed axis of a prescribed rotation
    Curve turning;                   // its rate [rad/s]; empty: none
    bool active;                     // present from the start of this model
    std::vector<Index> nodes;        // nodes that can have contact with it
};

struct ContactSettings {
    bool on = false;                 // whether walls have contact with each other
    double gap = 0.0;                // 0: half of both walls' thicknesses
    double stiffness = 0.1;          // share of the stability limit m / dt^2
    double friction = 0.0;           // between walls
    double damping = 0.0;            // damping ratio
};

struct Cut {                         // forces through a cut: corners of `elements` that lie on `nodes`
    std::vector<Index> elements, nodes;
};

struct Settings {
    double safety = 0.9;
    double scaled_step = 0.0;        // mass scaling: elements with a smaller stable step get added mass [s]
    double least_step = 1e-12;       // the run stops below this step [s]
    double damping = 0.0;            // mass-proportional [1/s]
    Vec3 gravity;
    bool thickness_update = true, warping_correction = false, viscous_hourglass = false;
    double hourglass_membrane = 0.01, hourglass_shear = 0.01, hourglass_bending = 0.01;
    bool stabilised = false;         // quadrilaterals are physically stabilised
    double drill_stiffness = 0.0;    // drilling stiffness of quadrilaterals as a share of G V
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
