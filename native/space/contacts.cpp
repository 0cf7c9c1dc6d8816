#include "space/contacts.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::space {

namespace {

// Capsules whose centre lines are nearer than this share of their radii at the start are joined: contact between
// them has no direction.
constexpr double joined = 0.1;
// Contacts are looked for within this many times the way that the bodies go in a step.
constexpr double looked_ahead = 2;
// Slower approaches [m/s] are rest, whatever their energy: rounding must not bounce.
constexpr double least_approach = 1e-6;
// An impact that gains energy bounces by half as much in the next pass.
constexpr double less_bounce = 0.5, least_bounce = 0.1;
// Reach of a step in which nothing moves, in closed gaps: what forces may set going.
constexpr double least_reach = 1000;

size_t at(int i) { return static_cast<size_t>(i); }

Pose placed(const Pose* pose, int body) { return body < 0 ? Pose{} : pose[body]; }

Segment placed(const Capsule& c, const Pose* pose) {
    const Pose p = placed(pose, c.body);
    return {p.at(c.segment.first), p.at(c.segment.second), c.segment.radius};
}

Solid as_solid(const Segment& s) {
    const Vec3 along = s.second - s.first;
    const double length = norm(along);
    return {Shape::capsule, s.first, length > 0 ? (1 / length) * along : Vec3{1, 0, 0}, {}, s.radius, length, false};
}

// velocity of the second body relative to the first at a point
Vec3 relative(const int body[2], Vec3 point, const Pose* pose, const Twist* v) {
    Vec3 u;
    for (int side = 0; side < 2; side++) {
        if (body[side] < 0) continue;
        const Twist& t = v[body[side]];
        const Vec3 own = t.v + cross(t.w, point - pose[body[side]].x);
        u = side == 0 ? u - own : u + own;
    }
    return u;
}

}  // namespace

Contacts::Contacts(const ContactModel& model) : model_(model), placed_(model.capsules.size()) {
    for (size_t o = 0; o < model.obstacles.size(); o++) {
        for (const int c : model.obstacles[o].capsules) pairs_.push_back({static_cast<int>(o), -1, c});
    }
    obstacle_pairs_ = pairs_.size();
    for (const CapsulePair& p : model.pairs) pairs_.push_back({-1, std::min(p.solid, p.capsule), std::max(p.solid, p.capsule)});
    std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(obstacle_pairs_), pairs_.end(), in_order);
    for (size_t c = 0; c < model.capsules.size(); c++) order_.push_back(static_cast<int>(c));
}

Solid Contacts::solid_at(const Pair& pair, const Pose* pose) const {
    if (pair.obstacle < 0) return as_solid(placed(model_.capsules[at(pair.solid)], pose));
    const Obstacle& o = model_.obstacles[at(pair.obstacle)];
    if (o.body < 0) return o.solid;
    Solid s = o.solid;
    s.point = pose[o.body].at(s.point);
    s.direction = turned(pose[o.body].q, s.direction);
    s.edge = turned(pose[o.body].q, s.edge);
    return s;
}

void Contacts::begin(const std::vector<bool>& present, const Pose* pose) {
    for (Pair& pair : pairs_) {
        if (pair.obstacle >= 0) pair.present = present[at(pair.obstacle)];
        if (pair.present && !pair.seen) appear(pair, pose);
    }
}

void Contacts::appear(Pair& pair, const Pose* pose) {
    pair.seen = true;
    Touch touch[most_touches];
    const Solid solid = solid_at(pair, pose);
    const Segment segment = placed(model_.capsules[at(pair.capsule)], pose);
    const int n = touches(solid, segment, touch);
    for (int k = 0; k < n; k++) pair.offset = std::min(pair.offset, touch[k].gap);
    const double radii = solid.radius + segment.radius;
    if (pair.obstacle < 0 && pair.offset + radii < joined * radii) pair.present = false;
}

// Pairs of capsules whose boxes come within the margin, by sweeping along x.
void Contacts::sweep(double margin) {
    margin_ = margin;
    swept_ = placed_;
    near_.clear();
    auto low = [&](int c, int k) { return std::min(placed_[at(c)].first[k], placed_[at(c)].second[k]) - placed_[at(c)].radius; };
    auto high = [&](int c, int k) { return std::max(placed_[at(c)].first[k], placed_[at(c)].second[k]) + placed_[at(c)].radius; };
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
        const double x = low(a, 0), y = low(b, 0);
        return x != y ? x < y : a < b;
    });
    for (size_t i = 0; i < order_.size(); i++) {
        const int a = order_[i];
        for (size_t j = i + 1; j < order_.size() && low(order_[j], 0) <= high(a, 0) + margin; j++) {
            const int b = order_[j];
            if (low(b, 1) > high(a, 1) + margin || low(a, 1) > high(b, 1) + margin) continue;
            if (low(b, 2) > high(a, 2) + margin || low(a, 2) > high(b, 2) + margin) continue;
            const Pair wanted{-1, std::min(a, b), std::max(a, b)};
            const auto first = pairs_.begin() + static_cast<std::ptrdiff_t>(obstacle_pairs_);
            const auto found = std::lower_bound(first, pairs_.end(), wanted, in_order);
            if (found == pairs_.end() || in_order(wanted, *found) || !found->present) continue;
            near_.push_back(static_cast<size_t>(found - pairs_.begin()));
        }
    }
    std::sort(near_.begin(), near_.end());
}

// Way [m] within which points of contact are looked for: as far as bodies go in the step, and some more.
double Contacts::look_ahead(const Pose* pose, const Twist* velocity, double h) {
    double way = 0, obstacles_way = 0, gone = swept_.empty() ? INFINITY : 0;
    for (size_t c = 0; c < placed_.size(); c++) {
        const Capsule& capsule = model_.capsules[c];
        placed_[c] = placed(capsule, pose);
        const Twist v = capsule.body < 0 ? Twist{} : velocity[capsule.body];
        const double arm = std::max(norm(capsule.segment.first), norm(capsule.segment.second)) + capsule.segment.radius;
        way = std::max(way, h * (norm(v.v) + norm(v.w) * arm));
        if (swept_.empty()) continue;
        gone = std::max({gone, norm(placed_[c].first - swept_[c].first), norm(placed_[c].second - swept_[c].second)});
    }
    for (const Obstacle& o : model_.obstacles) {
        if (o.body >= 0) obstacles_way = std::max(obstacles_way, h * norm(velocity[o.body].v));
    }
    const double reach = looked_ahead * (way + std::max(way, obstacles_way)) + least_reach * closed_gap_;
    if (obstacle_pairs_ < pairs_.size() && reach + 2 * gone > margin_) sweep(2 * reach);
    return reach;
}

bool Contacts::gather(const Pose* pose, const Twist* velocity, double h, double share, const ContactState& state) {
    h_ = h;
    share_ = share;
    restitution_share_ = 1;
    before_.swap(active_);
    active_.clear();
    const double reach = look_ahead(pose, velocity, h);
    for (size_t p = 0; p < obstacle_pairs_; p++) find(p, pose, velocity, reach);
    for (const size_t p : near_) find(p, pose, velocity, reach);
    // what the last step's forces would give
    auto held = state.held.begin();
    overlap_ = 0;
    for (Active& c : active_) {
        while (held != state.held.end() && held->key < c.key) ++held;
        if (held != state.held.end() && held->key == c.key) c.normal_impulse = h * held->force;
        overlap_ = std::max(overlap_, -c.gap);
    }
    if (active_.size() != before_.size()) return true;
    for (size_t i = 0; i < active_.size(); i++) {
        if (active_[i].key != before_[i].key) return true;
    }
    return false;
}

void Contacts::find(size_t p, const Pose* pose, const Twist* velocity, double reach) {
    const Pair& pair = pairs_[p];
    if (!pair.present) return;
    const Solid solid = solid_at(pair, pose);
    const Segment& segment = placed_[at(pair.capsule)];
    if (least_gap(solid, segment) - pair.offset > reach) return;
    Touch touch[most_touches];
    const int n = touches(solid, segment, touch);
    for (int k = 0; k < n; k++) {
        const double gap = touch[k].gap - pair.offset;
        if (gap > reach) continue;
        Active c{};
        c.key = static_cast<int64_t>(p) * most_touches + touch[k].slot;
        c.pair = p;
        c.body[0] = pair.obstacle < 0 ? model_.capsules[at(pair.solid)].body : model_.obstacles[at(pair.obstacle)].body;
        c.body[1] = model_.capsules[at(pair.capsule)].body;
        c.gap = gap;
        c.normal = touch[k].normal;
        c.point = touch[k].point;
        c.rate = dot(c.normal, relative(c.body, c.point, pose, velocity));
        active_.push_back(c);
    }
}

// Point and normal at other poses; false, and as they were, where the point is lost or has passed through.
bool Contacts::aim(Active& c, const Pose* pose) const {
    const Pair& pair = pairs_[c.pair];
    Touch touch[most_touches];
    const int n = touches(solid_at(pair, pose), placed(model_.capsules[at(pair.capsule)], pose), touch);
    const int slot = static_cast<int>(c.key % most_touches);
    for (int k = 0; k < n; k++) {
        if (touch[k].slot != slot || dot(touch[k].normal, c.normal) <= 0) continue;
        c.normal = touch[k].normal;
        c.point = touch[k].point;
        return true;
    }
    return false;
}

void Contacts::place(const Pose* middle, const Pose* end, const Twist* predicted) {
    for (Active& c : active_) {
        aim(c, middle);
        Vec3 axes[3] = {c.normal, {}, {}};
        tangents(c.normal, axes[1], axes[2]);
        const Vec3 centre[2] = {placed(middle, c.body[0]).x, placed(middle, c.body[1]).x};
        for (int k = 0; k < 3; k++) {
            c.row[k] = {axes[k], cross(c.point - centre[0], axes[k]), cross(c.point - centre[1], axes[k])};
        }
        const Vec3 at_middle = relative(c.body, c.point, middle, predicted);
        Active later = c;
        c.bias = {};
        if (!aim(later, end)) continue;
        const Vec3 at_end = relative(c.body, later.point, end, predicted);
        // the tangents as they are, turned into the plane of the end
        Vec3 first = axes[1] - dot(axes[1], later.normal) * later.normal;
        first = (1 / norm(first)) * first;
        const Vec3 second = cross(later.normal, first);
        c.bias = {dot(later.normal, at_end) - dot(axes[0], at_middle), dot(first, at_end) - dot(axes[1], at_middle),
                  dot(second, at_end) - dot(axes[2], at_middle)};
    }
}

void Contacts::rates(const Active& c, const Twist* v, double* w) const {
    const Twist a = c.body[0] < 0 ? Twist{} : v[c.body[0]], b = c.body[1] < 0 ? Twist{} : v[c.body[1]];
    for (int k = 0; k < 3; k++) w[k] = rate(c.row[k], a, b);
}

void Contacts::freeze(const System& system) {
    impact_ = false;
    for (Active& c : active_) {
        const Row& n = c.row[0];
        c.inverse_mass = 0;
        for (int side = 0; side < 2; side++) {
            if (c.body[side] < 0) continue;
            const Twist p{side == 0 ? n.ma : n.mb, n.t}, v = system.mobility(at(c.body[side]), p);
            c.inverse_mass += dot(p.v, v.v) + dot(p.w, v.w);
        }
        ContactMotion m;
        m.h = h_;
        m.share = share_;
        m.gap = c.gap;
        m.rate = c.rate;
        m.bias = c.bias;
        m.closed_gap = closed_gap_;
        m.rest_rate = std::max(least_approach, std::sqrt(2 * c.inverse_mass * negligible_energy_));
        m.normal_impulse = c.normal_impulse;
        m.inverse_mass = c.inverse_mass;
        m.restitution_share = restitution_share_;
        c.frozen = space::freeze(law(pairs_[c.pair]), m);
        if (m.gap <= m.closed_gap && m.rate < -m.rest_rate) impact_ = true;
    }
}

bool Contacts::settle(const double* impulse, const Twist* start, const Twist* end) {
    double largest = 0, change = 0, work = 0, scale = 0;
    for (size_t i = 0; i < active_.size(); i++) {
        Active& c = active_[i];
        double w0[3], w1[3];
        rates(c, start, w0);
        rates(c, end, w1);
        for (int k = 0; k < 3; k++) {
            c.impulse[k] = impulse[3 * i + at(k)];
            const double part = c.impulse[k] * (w0[k] + w1[k]) / 2;
            work += part;
            scale += std::fabs(part);
        }
        const double found = -c.impulse[0];
        largest = std::max(largest, found);
        if (law(pairs_[c.pair]).friction > 0) change = std::max(change, std::fabs(found - c.normal_impulse));
        c.normal_impulse = found;
    }
    if (impact_ && work < -1e-12 * scale && restitution_share_ > 0) {
        restitution_share_ = restitution_share_ < least_bounce ? 0 : less_bounce * restitution_share_;
        return false;
    }
    return change <= settled_change * largest;
}

void Contacts::commit(const Twist* start, const Twist* end, ContactState& state) {
    state.held.clear();
    state.force.assign(model_.obstacles.size(), Vec3{});
    state.impulse.resize(model_.obstacles.size());
    for (const Active& c : active_) {
        double w0[3], w1[3];
        rates(c, start, w0);
        rates(c, end, w1);
        state.dissipated += c.impulse[0] * (w0[0] + w1[0]) / 2;
        for (int k = 1; k < 3; k++) state.friction += c.impulse[k] * (w0[k] + w1[k]) / 2;
        if (c.impulse[0] < 0) state.held.push_back({c.key, -c.impulse[0] / h_});
        const int obstacle = pairs_[c.pair].obstacle;
        if (obstacle < 0) continue;
        Vec3 sum;
        for (int k = 0; k < 3; k++) sum = sum + c.impulse[k] * c.row[k].t;
        state.impulse[at(obstacle)] = state.impulse[at(obstacle)] + sum;
        state.force[at(obstacle)] = state.force[at(obstacle)] + (1 / h_) * sum;
    }
}

double Contacts::first_closing(const Twist* start, const Twist* end) const {
    double first = h_;
    for (const Active& c : active_) {
        if (c.gap <= closed_gap_ || c.impulse[0] >= 0) continue;
        double w0[3], w1[3];
        rates(c, start, w0);
        rates(c, end, w1);
        // the motion without the contact's impulse, its rate linear in time
        const double free = w1[0] + c.impulse[0] * c.inverse_mass, fastest = std::min(w0[0], free);
        if (fastest * fastest / (2 * c.inverse_mass) <= negligible_energy_ || fastest > -least_approach) continue;
        const double quarter = w0[0] * w0[0] - 2 * c.gap * (free - w0[0]) / h_;
        const double t = quarter > 0 ? 2 * c.gap / (-w0[0] + std::sqrt(quarter)) : h_ / 2;
        first = std::min(first, t > 0 && t < 0.98 * h_ ? t : 0.9 * h_);
    }
    return first;
}

}  // namespace crumple::space
