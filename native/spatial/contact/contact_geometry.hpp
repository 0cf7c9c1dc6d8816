// Contact geometry of a capsule and a convex solid: gaps, normals and points, in world axes.
//
// A capsule is a segment with a radius; a sphere is a capsule whose ends coincide.  Every sphere around a point x(s) of the segment
// must stay outside the solid.  The signed distance d(x) of a point from a convex solid is convex, so along the segment it has a
// single minimum, and contact is enforced at these points:
//   the ends of the segment; the minimum, if it is lower than all other points; and the breaks, where the segment passes a corner of
//   the solid: an edge, the ends of a cylinder or of another capsule, the rim of a cylinder's flat end.
// A capsule across an edge or a pole rests on one point; a capsule that lies flat along a solid rests on the two points that bound
// their common length, so that it does not rock.  Breaks, like ends, are found before they are in contact.
#pragma once

#include "spatial/model/math.hpp"

namespace crumple::spatial {

struct Segment {
    Vec3 first, second;
    double radius = 0;
};

enum class Shape { plane, cylinder, sphere, capsule };

// A convex solid.  Plane: the half-space behind `point` with the outward normal `direction`; with an `edge` (perpendicular to the
// normal) also behind `point` in that direction, a wedge of 90 degrees whose corner passes through `point`.  Cylinder: about the axis
// `direction` through `point`, infinite, or from `point` to `point` + `length` `direction` with flat ends.  Sphere about `point`.
// Capsule: from `point` to `point` + `length` `direction`.  Directions are unit vectors.
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
    int slot = 0;      // kind of point: ends (0, 1), minimum (2), breaks (3 to 6)
};

constexpr int most_touches = 7;

Distance distance(const Solid& solid, Vec3 x);
// lower bounds of the gap that are fast to compute: with a solid, and of two capsules by the spheres around them
double least_gap(const Solid& solid, const Segment& segment);
double least_gap(const Segment& first, const Segment& second);
// points of contact; returns their number
int touches(const Solid& solid, const Segment& segment, Touch* out);
// two unit vectors that form a right-handed system with the unit vector n
void tangents(Vec3 n, Vec3& first, Vec3& second);

}  // namespace crumple::spatial
