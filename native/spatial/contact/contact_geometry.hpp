// Where a capsule touches a convex solid: gap, normal and point, in world axes.
//
// A capsule is a segment with a radius; a sphere is one whose ends are the same point.  Every sphere around a point x(s) of the
// segment must stay outside the solid, a condition on the motion.  The signed distance d(x) of a point from a convex solid
// is convex, so along the segment it has one valley, and these points bear the capsule:
//   its ends; the lowest point of the valley, where that lies lower than all others; and its breaks, where it passes a
//   corner of the solid: an edge, the ends of a cylinder or of another capsule, the rim of a cylinder's flat end.
// A capsule across an edge or a pole rests on one point; one that lies flat along a solid on the two points that bound
// their common length, so that it does not rock.  Breaks are seen before they touch, as ends are.
#pragma once

#include "spatial/model/math.hpp"

namespace crumple::spatial {

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
    int slot = 0;      // which point it is: ends (0, 1), lowest (2), breaks (3 to 6)
};

constexpr int most_touches = 7;

Distance distance(const Solid& solid, Vec3 x);
// a lower bound of the gap, cheap
double least_gap(const Solid& solid, const Segment& segment);
// points of contact; returns how many
int touches(const Solid& solid, const Segment& segment, Touch* out);
// two unit vectors that make right-handed axes with the unit vector n
void tangents(Vec3 n, Vec3& first, Vec3& second);

}  // namespace crumple::spatial
