// Friction along a member near a fold.
//
// The wall that an obstacle strikes moves, in the middle of the fold, with the mean of the walls on both sides, and at the ends of the
// fold with those beside it.  A capsule knows one side only.  Along the member, its rate at a point of contact is therefore that of its
// axis there (both sides share it, where they fold alike) plus the share |s|/H of the turning of the wall about the axis; s is the
// distance along the member from the middle of the fold, H half of its length.  Across the member nothing changes.
#pragma once

#include "spatial/contact/contact_geometry.hpp"
#include "spatial/model/joint.hpp"

namespace crumple::spatial {

// A fold at an end of a capsule: its middle on the member's axis, relative to the body's centre, in its frame, and half of its length
// along the member [m]; none if that is 0.
struct Fold {
    Vec3 middle;
    double half_length = 0;
};

// Changes the tangential rows (1 and 2) of a contact at `point`; `out` has three.  `folds` are two, of a capsule with this segment.
void slide_at_folds(const Fold* folds, const Segment& segment, const Pose& pose, Vec3 point, Row* out);

}  // namespace crumple::spatial
