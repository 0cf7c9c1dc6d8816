// A joint between two bodies: the directions of its relative motion, and the drift of the held ones.
//
// Held and hinged directions are rows: rate = t.(v_b - v_a) + m_b.w_b - m_a.w_a, (t, m_b) acting on body b as a force and
// a moment at its centre does.  They refer to the frame in the middle between the joint's axes on both bodies: with the
// relative rotation as a unit quaternion (c, s), the rate of 2 s_k is w_rel along the middle frame's axis k wherever
// the held components of s are zero.  So one form serves every set of held rotations, at any angle of the free ones.
#pragma once

#include "spatial/model/math.hpp"

namespace crumple::spatial {

constexpr int most_rows = 6;

struct Row {
    Vec3 t, ma, mb;
};

struct Joint {
    int body[2] = {-1, -1};      // first, second; -1 is the ground
    Vec3 arm[2];                 // from the bodies' centres, in their frames (in the world for the ground)
    Quat axes;                   // of the joint at the start, when both bodies' frames are the world's
    bool cross = false;          // universal joint, see `directions`
    bool slotted = false;        // its points part: rows of translation then stay with the first body
    int held = 0, laws = 0;      // rows: held freedoms first, then those of a hinge
    int freedom[most_rows] = {}; // 0..2 translations, 3..5 rotations
    int hinge = -1;
    int drive[6] = {-1, -1, -1, -1, -1, -1};  // of every freedom
    bool driven = false;
    int rows() const { return held + laws; }
};

// Where a driven joint should be: displacement and rate of every freedom.
struct Target {
    double place[6] = {}, rate[6] = {};
};

struct JointGeometry {
    Row row[most_rows];
    double error[most_rows];     // held: displacement; hinged: relative rotation or slip
    Vec3 point;                  // where forces act, world
    Vec3 axes[3];                // middle frame in the world
};

// `before`: hinged rotations last found, so that a single rotation counts beyond half a turn; may be null
void locate(const Joint& joint, const Pose& a, const Pose& b, const Target* target, const double* before, JointGeometry& out);
// rate along a row for the motion of both bodies
inline double rate(const Row& row, const Twist& a, const Twist& b) {
    return dot(row.t, b.v - a.v) + dot(row.mb, b.w) - dot(row.ma, a.w);
}
// rate that a driven row should have
double target_rate(const Joint& joint, const Pose& a, const JointGeometry& g, const Target& target, int row);

}  // namespace crumple::spatial
