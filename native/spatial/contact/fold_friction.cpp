#include "spatial/contact/fold_friction.hpp"

#include <cmath>

namespace crumple::spatial {

void slide_at_folds(const Fold* folds, const Segment& segment, const Pose& pose, Vec3 point, Row* out) {
    const Vec3 normal = out[0].t, axis = pose.at(segment.second) - pose.at(segment.first);
    const Vec3 flat = axis - dot(axis, normal) * normal;
    const double length = norm(flat);
    if (!(length > 0)) return;
    const Vec3 way = (1 / length) * flat;
    for (int k = 0; k < 2; k++) {
        if (!(folds[k].half_length > 0)) continue;
        const Vec3 from = point - pose.at(folds[k].middle);
        const double share = 1 - std::fabs(dot(way, from)) / folds[k].half_length;
        if (!(share > 0)) continue;
        // from the wall towards the axis
        const Vec3 lever = -share * dot(from, normal) * normal;
        for (int i = 1; i < 3; i++) out[i].mb = out[i].mb + dot(out[i].t, way) * cross(lever, way);
    }
}

}  // namespace crumple::spatial
