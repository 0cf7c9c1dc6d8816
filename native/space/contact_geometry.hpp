// Where a capsule touches a convex solid: gap, normal and point, in world axes.
//
// A capsule is a segment with a radius; a sphere is one whose ends are the same point.  The signed distance d(x) of a
// point from a convex solid is convex, so along the segment x(s) it has one valley.  Points of contact are
//   the ends of the segment, and
//   the ends of the valley {s : d(x(s)) <= min d + flatness * length} where they lie inside the segment,
// each a condition that the motion must meet: the sphere around x(s) stays outside the solid.  A capsule across an
// edge or a pole has a narrow valley, one point; one that lies flat along a solid has a wide one, two points, and
// does not rock; one that lies flat on a plane is held by its ends.
#pragma once

#include "space/math.hpp"

namespace crumple::space {

struct Segment {
    Vec3 first, second;
    double radius = 0;
};

enum class Shape { plane, cylinder, sphere, capsule };

// A convex solid.  Plane: behind `point` against the outward normal `direction`; with an `edge` (at right angles to the
// normal) also behind `point` against that, a wedge of 90 degrees whose corner runs through `point`.  Cylinder: about
// `direction` through `point`, without end, or from `point` to `point` + `length` `direction` with flat ends.  Sphere about
// `point`.  Capsule: from `point` to `point` + `length` `direction`.  Directions are unit vectors.
struct Solid {
    Shape shape = Shape::plane;
    Vec3 point, direction, edge;
    double radius = 0, length = 0;
    bool has_edge = false;
};

struct Distance {
    double value = 0;  // negative inside
    Vec3 normal;       // unit, out of the solid
};

// One point of contact; `point` lies on the normal, midway between both surfaces.
struct Touch {
    double gap = 0;    // between the surfaces; negative: overlap
    Vec3 normal;       // unit, out of the solid towards the capsule
    Vec3 point;
    int slot = 0;      // which of the four it is: ends of the segment, ends of the valley
};

constexpr int most_touches = 4;

Distance distance(const Solid& solid, Vec3 x);
// a lower bound of the gap, cheap
double least_gap(const Solid& solid, const Segment& segment);
// points of contact; returns how many
int touches(const Solid& solid, const Segment& segment, Touch* out);
// two unit vectors that make right-handed axes with the unit vector n
void tangents(Vec3 n, Vec3& first, Vec3& second);

}  // namespace crumple::space
