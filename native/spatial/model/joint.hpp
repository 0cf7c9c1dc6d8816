// A joint between two bodies: the directions of its relative motion, and the drift of the held directions.
//
// Each held or hinged direction is a row: rate = t.(v_b - v_a) + m_b.w_b - m_a.w_a, where (t, m_b) are the force and the moment at
// the centre of body b for a unit impulse along the row.  The rows refer to the frame halfway between the joint's axes on both bodies:
// with the relative rotation as a unit quaternion (c, s), the rate of 2 s_k is w_rel along axis k of the middle frame if the held
// components of s are zero.  One formulation thus covers every set of held rotations, at any angle of the free ones.
#pragma once

#include "hinge/curve.hpp"
#include "spatial/model/math.hpp"

namespace crumple::spatial {

constexpr int most_rows = 6;

struct Row {
    Vec3 t, ma, mb;
};

// A held translation follows a rotation of the joint: over the angle from the first to the second body about an axis of the middle frame,
// the second body is displaced by the integral of `slope` [m/rad] from its first point on.
struct Cam {
    int freedom = -1, about = -1;  // the translation, 0..2, and the rotation, 3..5; -1: none
    hinge::Curve slope;
};

struct Joint {
    int body[2] = {-1, -1};      // first, second; -1 is the ground
    Vec3 arm[2];                 // from the bodies' centres, in their frames (in the world for the ground)
    Quat axes;                   // of the joint at the start, when the frames of both bodies are aligned with the world axes
    bool cross = false;          // universal joint, see `directions`
    bool slotted = false;        // its points move apart: the rows of translation are then fixed to the first body
    int held = 0, laws = 0;      // numbers of rows: held freedoms first, then those of a hinge
    int freedom[most_rows] = {}; // 0..2 translations, 3..5 rotations
    int hinge = -1;
    int drive[6] = {-1, -1, -1, -1, -1, -1};  // index of the drive of every freedom, -1: none
    bool driven = false;
    Cam cam;
    int rows() const { return held + laws; }
};

// Prescribed displacement and rate of every freedom of a driven joint.
struct Target {
    double place[6] = {}, rate[6] = {};
};

struct JointGeometry {
    Row row[most_rows];
    double error[most_rows];     // held rows: displacement (drift); hinged rows: relative rotation or slip
    Vec3 point;                  // point of action of the forces, world axes
    Vec3 axes[3];                // axes of the middle frame, world axes
};

// `before`: hinged rotations found last, so that a single rotation can be counted beyond 180 degrees; may be null
void locate(const Joint& joint, const Pose& a, const Pose& b, const Target* target, const double* before, JointGeometry& out);
// rate along a row from the motion of both bodies
inline double rate(const Row& row, const Twist& a, const Twist& b) {
    return dot(row.t, b.v - a.v) + dot(row.mb, b.w) - dot(row.ma, a.w);
}
// prescribed rate of a driven row
double target_rate(const Joint& joint, const Pose& a, const JointGeometry& g, const Target& target, int row);

}  // namespace crumple::spatial
