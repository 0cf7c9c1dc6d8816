#include "spatial/contact/contact_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// The minimum counts if it is lower than the ends and breaks by at least the first value, and farther from the ends than the second,
// as shares of the segment's length.
constexpr double flatness = 1e-7, narrow = 1e-3;
constexpr int most_breaks = 4;
// slope to a plane from which on a segment is not treated as sliding over its edge
constexpr double steep = 1;
// halvings of the interval: the position of the minimum to 1e-12 of the length, at which its depth is exact
constexpr int halvings = 40;
// a shorter segment is a sphere, a shorter distance has no direction [m]
constexpr double nothing = 1e-12;

Distance from_axis(Vec3 radial, Vec3 direction, double radius) {
    const double rho = norm(radial);
    if (rho > nothing) return {rho - radius, (1 / rho) * radial};
    Vec3 first, second;
    tangents(direction, first, second);
    return {-radius, first};
}

// Distance from the intersection of two solids with perpendicular normals.
Distance of_corner(const Distance& a, const Distance& b) {
    if (a.value > 0 && b.value > 0) {
        const double d = std::hypot(a.value, b.value);
        return {d, (a.value / d) * a.normal + (b.value / d) * b.normal};
    }
    return a.value >= b.value ? a : b;
}

struct Lowest {
    double s;
    Distance distance;
};

class Profile {
public:
    Profile(const Solid& solid, const Segment& segment)
        : solid_(solid), from_(segment.first), along_(segment.second - segment.first) {}
    Vec3 at(double s) const { return from_ + s * along_; }
    Distance operator()(double s) const { return distance(solid_, at(s)); }
    double slope(const Distance& d) const { return dot(d.normal, along_); }
    double length() const { return norm(along_); }

    Lowest lowest() const {
        double lo = 0, hi = 1;
        Distance below = (*this)(0), above = (*this)(1);
        if (slope(below) >= 0) return {0, below};
        if (slope(above) <= 0) return {1, above};
        for (int k = 0; k < halvings; k++) {
            const double s = (lo + hi) / 2;
            const Distance d = (*this)(s);
            const bool rising = slope(d) >= 0;
            (rising ? hi : lo) = s;
            (rising ? above : below) = d;
        }
        // at a kink of the distance the normal lies between those of both sides, perpendicular to the segment
        const double a = -slope(below), b = slope(above), s = (lo + hi) / 2;
        Vec3 normal = above.normal;
        if (a > 0 && b > 0) normal = (b / (a + b)) * below.normal + (a / (a + b)) * above.normal;
        const double size = norm(normal);
        if (size > nothing) {
            normal = (1 / size) * normal;
        } else {
            // the segment passes straight through an axis: any direction perpendicular to the segment
            Vec3 second;
            tangents((1 / length()) * along_, normal, second);
        }
        return {s, {(*this)(s).value, normal}};
    }

    // coordinates at which the segment passes corners of the solid, in a fixed order; infinite if it does not
    int breaks(double* s) const {
        const Vec3 r = from_ - solid_.point;
        if (solid_.shape == Shape::plane) {
            s[0] = -dot(solid_.edge, r) / dot(solid_.edge, along_);
            return 1;
        }
        if (solid_.shape == Shape::sphere || solid_.length == 0) return 0;
        const Vec3 axis = solid_.direction;
        const double z = dot(axis, r), slope = dot(axis, along_);
        s[0] = -z / slope;
        s[1] = (solid_.length - z) / slope;
        if (solid_.shape == Shape::capsule) return 2;
        const Vec3 out = r - z * axis, away = along_ - slope * axis;
        const double a = dot(away, away), b = dot(out, away), c = dot(out, out) - solid_.radius * solid_.radius;
        const double root = std::sqrt(std::max(b * b - a * c, 0.0));
        s[2] = (-b - root) / a;
        s[3] = (-b + root) / a;
        return 4;
    }

    // Contact at a break.  A segment that falls beyond the straight edge of a plane touches it with its point closest to the edge, at
    // right angles, as between two edges: while it slides, the point at the break moves along it, so that the gap there does not change
    // at the rate of the body's point.
    Lowest at_break(double s) const {
        const Distance d = (*this)(s);
        if (solid_.shape != Shape::plane) return {s, d};
        const double pass = dot(solid_.edge, along_), fall = -slope(d) / pass, size = std::hypot(1.0, fall);
        const double place = s + fall * d.value / (pass * size * size);
        if (!(fall > 0 && fall < steep && place >= 0 && place <= 1)) return {s, d};
        return {place, {d.value / size, (1 / size) * (d.normal + fall * solid_.edge)}};
    }

private:
    const Solid& solid_;
    Vec3 from_, along_;
};

}  // namespace

void tangents(Vec3 n, Vec3& first, Vec3& second) {
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    const Vec3 far = x <= y && x <= z ? Vec3{1, 0, 0} : (y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
    const Vec3 t = cross(n, far);
    first = (1 / norm(t)) * t;
    second = cross(n, first);
}

Distance distance(const Solid& solid, Vec3 x) {
    const Vec3 r = x - solid.point;
    const double along = dot(solid.direction, r);
    switch (solid.shape) {
        case Shape::plane: {
            const Distance face{along, solid.direction};
            return solid.has_edge ? of_corner(face, {dot(solid.edge, r), solid.edge}) : face;
        }
        case Shape::cylinder: {
            const Distance side = from_axis(r - along * solid.direction, solid.direction, solid.radius);
            if (solid.length == 0) return side;
            const double middle = solid.length / 2;
            const Vec3 out = along >= middle ? solid.direction : -solid.direction;
            return of_corner(side, {std::fabs(along - middle) - middle, out});
        }
        case Shape::sphere: return from_axis(r, {0, 0, 1}, solid.radius);
        case Shape::capsule: {
            const double t = std::clamp(along, 0.0, solid.length);
            return from_axis(r - t * solid.direction, solid.direction, solid.radius);
        }
    }
    return {};
}

double least_gap(const Solid& solid, const Segment& segment) {
    const Vec3 middle = 0.5 * (segment.first + segment.second);
    return distance(solid, middle).value - norm(segment.second - segment.first) / 2 - segment.radius;
}

double least_gap(const Segment& first, const Segment& second) {
    const double apart = norm(second.first + second.second - first.first - first.second);
    return (apart - norm(first.second - first.first) - norm(second.second - second.first)) / 2 - first.radius - second.radius;
}

int touches(const Solid& solid, const Segment& segment, Touch* out) {
    const Profile profile(solid, segment);
    int n = 0;
    auto add = [&](int slot, double s, const Distance& d) {
        const double gap = d.value - segment.radius;
        out[n++] = {gap, d.normal, profile.at(s) - (segment.radius + gap / 2) * d.normal, slot};
    };
    add(0, 0, profile(0));
    if (profile.length() < nothing) return n;
    add(1, 1, profile(1));
    if (solid.shape == Shape::plane && !solid.has_edge) return n;
    double least = std::min(out[0].gap, out[1].gap), place[most_breaks];
    const int breaks = profile.breaks(place);
    const Lowest lowest = profile.lowest();
    const int valley = n;
    for (int k = 0; k < breaks; k++) {
        if (!(place[k] > narrow && place[k] < 1 - narrow)) continue;
        const Lowest touch = profile.at_break(place[k]);
        add(3 + k, touch.s, touch.distance);
        least = std::min(least, out[n - 1].gap);
    }
    if (lowest.distance.value - segment.radius < least - flatness * profile.length()) {
        add(2, lowest.s, lowest.distance);
        std::rotate(out + valley, out + n - 1, out + n);
    }
    return n;
}

}  // namespace crumple::spatial
