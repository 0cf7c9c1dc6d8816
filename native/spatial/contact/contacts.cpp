#include "spatial/contact/contacts.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Capsules whose centre lines are closer than this share of their radii at the start count as joined: contact between them has no
// defined direction.
constexpr double joined = 0.1;
// Contacts are searched within `looked_ahead` times the displacement of the bodies in a step, and kept up to `kept` times that
// distance, so that a step and its two halves have the same contacts.
constexpr double looked_ahead = 2, kept = 4;
// Search distance, in closed gaps, of a step in which nothing moves: forces may start a motion.
constexpr double least_reach = 1000;
// Slower approaches [m/s] count as rest, whatever their energy, because rounding must not cause a rebound.
constexpr double least_approach = 1e-6;
// Restitution of an impact that gains energy is halved in the next pass, and finally set to zero.
constexpr double less_bounce = 0.5, least_bounce = 0.1;
// Share of the friction limit above which a point counts as sliding.
constexpr double slides = 0.999;
// Upper bound of the rate without a contact's impulse relative to the rates with it.  The rate without impulse is estimated with the
// mobility of both bodies alone; locked bodies yield much less to an impulse, and then the closing time follows from their rates.
constexpr double implausible = 1e3;
// Relative gain of energy that is attributed to rounding.
constexpr double rounding = 1e-9;

size_t at(int i) { return static_cast<size_t>(i); }

Pose placed(const std::vector<Pose>& pose, int body) { return body < 0 ? Pose{} : pose[at(body)]; }

Segment placed(const Capsule& c, const std::vector<Pose>& pose) {
    const Pose p = placed(pose, c.body);
    return {p.at(c.segment.first), p.at(c.segment.second), c.segment.radius};
}

Solid as_solid(const Segment& s) {
    const Vec3 along = s.second - s.first;
    const double length = norm(along);
    return {Shape::capsule, s.first, length > 0 ? (1 / length) * along : Vec3{1, 0, 0}, {}, s.radius, length, false};
}

}  // namespace

Contacts::Contacts(const ContactModel& model) : model_(model), placed_(model.capsules.size()) {
    bool rubs = !model.pairs.empty() && model.between.friction > 0;
    for (const Obstacle& o : model.obstacles) rubs = rubs || o.law.friction > 0;
    rows_ = rubs ? 3 : 1;
    for (size_t o = 0; o < model.obstacles.size(); o++) {
        const Obstacle& obstacle = model.obstacles[o];
        const bool curved = obstacle.solid.shape != Shape::plane || obstacle.solid.has_edge;
        for (size_t c = 0; c < obstacle.capsules.size(); c++) {
            pairs_.push_back({static_cast<int>(o), -1, obstacle.capsules[c], obstacle.ends[c], curved});
        }
    }
    obstacle_pairs_ = pairs_.size();
    for (const CapsulePair& p : model.pairs) pairs_.push_back({-1, std::min(p.first, p.second), std::max(p.first, p.second)});
    std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(obstacle_pairs_), pairs_.end(), in_order);
    for (size_t c = 0; c < model.capsules.size(); c++) order_.push_back(static_cast<int>(c));
}

Solid Contacts::solid_at(const Pair& pair, const std::vector<Pose>& pose) const {
    if (pair.obstacle < 0) return as_solid(placed(model_.capsules[at(pair.solid)], pose));
    const Obstacle& o = model_.obstacles[at(pair.obstacle)];
    if (o.body < 0) return o.solid;
    const Pose& p = pose[at(o.body)];
    Solid s = o.solid;
    s.point = p.at(s.point);
    s.direction = turned(p.q, s.direction);
    s.edge = turned(p.q, s.edge);
    return s;
}

// Points of contact of a pair, without the ends that the obstacle meets at another capsule; their number.
int Contacts::points(const Pair& pair, const Solid& solid, const Segment& segment, Touch* touch) const {
    const int n = touches(solid, segment, touch);
    if (pair.ends == both_ends) return n;
    return static_cast<int>(std::remove_if(touch, touch + n, [&](const Touch& t) { return t.slot < 2 && !(pair.ends >> t.slot & 1); }) - touch);
}

void Contacts::begin(const std::vector<bool>& present, const std::vector<Pose>& pose) {
    for (Pair& pair : pairs_) {
        if (pair.obstacle >= 0) {
            pair.present = present[at(pair.obstacle)];
            pair.seen = pair.seen && pair.present;
        }
        if (pair.present && !pair.seen) appear(pair, pose);
    }
}

void Contacts::appear(Pair& pair, const std::vector<Pose>& pose) {
    pair.seen = true;
    pair.offset = 0;
    Touch touch[most_touches];
    const Solid solid = solid_at(pair, pose);
    const Segment segment = placed(model_.capsules[at(pair.capsule)], pose);
    const int n = points(pair, solid, segment, touch);
    for (int k = 0; k < n; k++) pair.offset = std::min(pair.offset, touch[k].gap);
    const double radii = solid.radius + segment.radius;
    if (pair.obstacle < 0 && pair.offset + radii < joined * radii) pair.present = false;
}

// Finds pairs of capsules whose boxes are within the margin of each other, by sweep and prune along x.
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
    const auto first = pairs_.begin() + static_cast<std::ptrdiff_t>(obstacle_pairs_);
    for (size_t i = 0; i < order_.size(); i++) {
        const int a = order_[i];
        for (size_t j = i + 1; j < order_.size() && low(order_[j], 0) <= high(a, 0) + margin; j++) {
            const int b = order_[j];
            if (low(b, 1) > high(a, 1) + margin || low(a, 1) > high(b, 1) + margin) continue;
            if (low(b, 2) > high(a, 2) + margin || low(a, 2) > high(b, 2) + margin) continue;
            const Pair wanted{-1, std::min(a, b), std::max(a, b)};
            const auto found = std::lower_bound(first, pairs_.end(), wanted, in_order);
            if (found == pairs_.end() || in_order(wanted, *found) || !found->present) continue;
            near_.push_back(static_cast<size_t>(found - pairs_.begin()));
        }
    }
    std::sort(near_.begin(), near_.end());
}

// Distance [m] within which points of contact are searched: the displacement of the bodies in the step, with a margin.
double Contacts::look_ahead(const std::vector<Pose>& pose, const std::vector<Twist>& velocity, double h, double gain) {
    double way = 0, obstacles_way = 0, gone = swept_.empty() ? INFINITY : 0;
    for (size_t c = 0; c < placed_.size(); c++) {
        const Capsule& capsule = model_.capsules[c];
        placed_[c] = placed(capsule, pose);
        if (capsule.body < 0) continue;
        const Twist& v = velocity[at(capsule.body)];
        const double arm = std::max(norm(capsule.segment.first), norm(capsule.segment.second)) + capsule.segment.radius;
        way = std::max(way, h * (norm(v.v) + norm(v.w) * arm));
        if (swept_.empty()) continue;
        gone = std::max({gone, norm(placed_[c].first - swept_[c].first), norm(placed_[c].second - swept_[c].second)});
    }
    for (const Obstacle& o : model_.obstacles) {
        if (o.body < 0) continue;
        const Twist& v = velocity[at(o.body)];
        obstacles_way = std::max(obstacles_way, h * (norm(v.v) + norm(v.w) * (norm(o.solid.point) + o.solid.radius + o.solid.length)));
    }
    const double reach = looked_ahead * (way + std::max(way, obstacles_way) + h * gain) + least_reach * closed_gap_;
    if (obstacle_pairs_ < pairs_.size() && kept * reach + 2 * gone > margin_) sweep(2 * kept * reach);
    return reach;
}

bool Contacts::gather(const std::vector<Pose>& pose, const std::vector<Twist>& velocity, double h, double gain,
                      const ContactState& state) {
    restitution_share_ = 1;
    before_.swap(active_);
    active_.clear();
    const double reach = look_ahead(pose, velocity, h, gain);
    for (size_t p = 0; p < obstacle_pairs_; p++) find(p, pose, reach, state);
    for (const size_t p : near_) find(p, pose, reach, state);
    // normal impulses that the forces of the last step would give
    auto held = state.held.begin();
    for (Active& c : active_) {
        while (held != state.held.end() && held->key < c.key) ++held;
        if (held != state.held.end() && held->key == c.key) c.normal_impulse = h * held->force;
    }
    if (active_.size() != before_.size()) return true;
    for (size_t i = 0; i < active_.size(); i++) {
        if (active_[i].key != before_[i].key) return true;
    }
    return false;
}

bool Contacts::among(const std::vector<Active>& contacts, int64_t key) {
    const auto found = std::lower_bound(contacts.begin(), contacts.end(), key, [](const Active& a, int64_t k) { return a.key < k; });
    return found != contacts.end() && found->key == key;
}

bool Contacts::overlooked(const std::vector<Pose>& pose, const ContactState& state) const {
    std::vector<Segment> now;
    for (const Capsule& capsule : model_.capsules) now.push_back(placed(capsule, pose));
    auto overlaps = [&](size_t p) {
        const Pair& pair = pairs_[p];
        if (!pair.present) return false;
        const double closed = largest_offset(p, state);
        const Segment& segment = now[at(pair.capsule)];
        if (pair.obstacle < 0 && least_gap(now[at(pair.solid)], segment) - closed > -closed_gap_) return false;
        const Solid solid = pair.obstacle < 0 ? as_solid(now[at(pair.solid)]) : solid_at(pair, pose);
        if (least_gap(solid, segment) - closed > -closed_gap_) return false;
        Touch touch[most_touches];
        const int n = points(pair, solid, segment, touch);
        double known = 0, unknown = 0;
        for (int k = 0; k < n; k++) {
            const bool is_known = among(active_, static_cast<int64_t>(p) * most_touches + touch[k].slot);
            double& least = is_known ? known : unknown;
            least = std::min(least, touch[k].gap - offset(p, touch[k].slot, state));
        }
        return unknown < known - closed_gap_;
    };
    for (size_t p = 0; p < obstacle_pairs_; p++) {
        if (overlaps(p)) return true;
    }
    return std::any_of(near_.begin(), near_.end(), overlaps);
}

void Contacts::find(size_t p, const std::vector<Pose>& pose, double reach, const ContactState& state) {
    const Pair& pair = pairs_[p];
    if (!pair.present) return;
    const double closed = largest_offset(p, state);
    const Segment& segment = placed_[at(pair.capsule)];
    if (pair.obstacle < 0 && least_gap(placed_[at(pair.solid)], segment) - closed > kept * reach) return;
    const Solid solid = pair.obstacle < 0 ? as_solid(placed_[at(pair.solid)]) : solid_at(pair, pose);
    if (least_gap(solid, segment) - closed > kept * reach) return;
    Touch touch[most_touches];
    const int n = points(pair, solid, segment, touch);
    for (int k = 0; k < n; k++) {
        const double own = offset(p, touch[k].slot, state), gap = touch[k].gap - own;
        const int64_t key = static_cast<int64_t>(p) * most_touches + touch[k].slot;
        if (gap > reach && (gap > kept * reach || !among(before_, key))) continue;
        Active c{};
        c.key = key;
        c.pair = p;
        c.body[0] = pair.obstacle < 0 ? model_.capsules[at(pair.solid)].body : model_.obstacles[at(pair.obstacle)].body;
        c.body[1] = model_.capsules[at(pair.capsule)].body;
        c.gap = gap;
        c.offset = own;
        c.normal = touch[k].normal;
        c.point = touch[k].point;
        Vec3 second;
        tangents(c.normal, c.tangent, second);
        active_.push_back(c);
    }
}

// If the point of contact is lost or has passed through the solid, it stays at its position at the start of the step.
void Contacts::locate(size_t i, const std::vector<Pose>& pose, Row* out, double* gap) const {
    const Active& c = active_[i];
    const Pair& pair = pairs_[c.pair];
    Touch touch[most_touches];
    const int n = points(pair, solid_at(pair, pose), placed(model_.capsules[at(pair.capsule)], pose), touch);
    const int slot = static_cast<int>(c.key % most_touches);
    Vec3 axes[3] = {c.normal, c.tangent, {}}, point = c.point;
    *gap = c.gap;
    for (int k = 0; k < n; k++) {
        if (touch[k].slot != slot || dot(touch[k].normal, c.normal) <= 0) continue;
        axes[0] = touch[k].normal;
        point = touch[k].point;
        *gap = touch[k].gap - c.offset;
    }
    // the tangents at the start, projected onto this plane
    const Vec3 along = c.tangent - dot(c.tangent, axes[0]) * axes[0];
    axes[1] = (1 / norm(along)) * along;
    axes[2] = cross(axes[0], axes[1]);
    const Vec3 a = point - placed(pose, c.body[0]).x, b = point - placed(pose, c.body[1]).x;
    for (size_t k = 0; k < rows(); k++) out[k] = {axes[k], cross(a, axes[k]), cross(b, axes[k])};
    if (!(rows() > 1 && pair.curved)) return;
    const Capsule& capsule = model_.capsules[at(pair.capsule)];
    slide_at_folds(capsule.folds, capsule.segment, placed(pose, capsule.body), point, out);
}

double Contacts::crush_force(const Pair& pair) const {
    const double own = model_.capsules[at(pair.capsule)].crush_force;
    return pair.obstacle < 0 ? std::min(own, model_.capsules[at(pair.solid)].crush_force) : own;
}

void Contacts::crush(const double* gap, ContactState& state) const {
    std::vector<double> deeper;
    for (size_t i = 0; i < active_.size(); i++) {
        if (!crushes(i) || gap[rows() * i] >= 0) continue;
        deeper.resize(2 * pairs_.size(), 0);
        double& depth = deeper[wall(active_[i].pair, static_cast<int>(active_[i].key % most_touches))];
        depth = std::max(depth, -gap[rows() * i]);
    }
    if (deeper.empty()) return;
    state.crushed.resize(deeper.size(), 0);
    for (size_t w = 0; w < deeper.size(); w++) state.crushed[w] += deeper[w];
}

std::vector<Contacts::Crushed> Contacts::crushed(const ContactState& state) const {
    std::vector<Crushed> out;
    for (size_t p = 0; 2 * p < state.crushed.size(); p++) {
        const double depth = std::max(state.crushed[2 * p], state.crushed[2 * p + 1]);
        if (depth > 0) out.push_back({pairs_[p].obstacle, pairs_[p].solid, pairs_[p].capsule, depth});
    }
    return out;
}

double Contacts::rest_rate(const Active& c) const {
    return std::max(least_approach, std::sqrt(2 * c.inverse_mass * negligible_energy_));
}

double Contacts::allowed(size_t i, double h, double start_rate, double unbounded) const {
    const Active& c = active_[i];
    const double restitution = bounces_ && !crushes(i) ? law(c).restitution : 0;
    if (unbounded < 0 && restitution > 0 && c.gap <= closed_gap_ && start_rate >= -rest_rate(c)) return unbounded;
    return allowed_rate(restitution_share_ * restitution, c.gap, start_rate, h, closed_gap_, rest_rate(c));
}

void Contacts::freeze(size_t i, double inverse_mass, double h) {
    Active& c = active_[i];
    c.inverse_mass = inverse_mass;
    const double cap = crushes(i) ? crush_force(pairs_[c.pair]) * h : INFINITY;
    c.frozen = spatial::freeze(law(c), inverse_mass, c.normal_impulse, cap);
}

void Contacts::widen(size_t i, double width) {
    Active& c = active_[i];
    c.frozen.width = std::max(width, creep_rate);
    c.frozen.compliance = softness * c.inverse_mass;
    if (crushes(i)) c.frozen.compliance = std::max(c.frozen.compliance, width / c.frozen.cap);
}

void Contacts::set_normal(size_t i, double impulse) {
    active_[i].normal_impulse = impulse;
    active_[i].frozen.limit = friction_limit(law(active_[i]), impulse);
}

bool Contacts::limits_hold(const double* impulse) const {
    double largest = 0, change = 0;
    for (size_t i = 0; i < active_.size(); i++) {
        const double found = -impulse[rows() * i], mu = law(active_[i]).friction, used = active_[i].normal_impulse;
        largest = std::max(largest, found);
        if (mu == 0) continue;
        // a point that sticks within both friction limits does not depend on them
        const double held = std::hypot(impulse[rows() * i + 1], impulse[rows() * i + 2]);
        if (held >= slides * mu * std::min(found, used)) change = std::max(change, std::fabs(found - used));
    }
    return change <= settled_change_ * largest;
}

bool Contacts::settle(const double* impulse, const double* rate0, const double* rate, bool any_limits) {
    double work = 0, scale = 0;
    for (size_t k = 0; k < rows() * active_.size(); k++) {
        work += impulse[k] * (rate0[k] + rate[k]) / 2;
        scale += std::fabs(impulse[k]) * (std::fabs(rate0[k]) + std::fabs(rate[k]));
    }
    const bool hold = any_limits || limits_hold(impulse);
    for (size_t i = 0; i < active_.size(); i++) active_[i].normal_impulse = -impulse[rows() * i];
    if (work < -rounding * scale && restitution_share_ > 0) {
        restitution_share_ = restitution_share_ < least_bounce ? 0 : less_bounce * restitution_share_;
        return false;
    }
    return hold;
}

void Contacts::commit(double h, bool from_rest, const Row* at_middle, const double* impulse, const double* rate0,
                      const double* rate, ContactState& state) const {
    state.held.clear();
    state.force.assign(model_.obstacles.size(), Vec3{});
    state.impulse.resize(model_.obstacles.size());
    state.closing = 0;
    for (size_t i = 0; i < active_.size(); i++) {
        const Active& c = active_[i];
        const size_t n = rows();
        const double *p = impulse + n * i, *w0 = rate0 + n * i, *w1 = rate + n * i;
        // friction acts against the slip at the end of the step: if an impact reverses the slip, the work on the mean rate has the wrong
        // sign and is counted with the impact
        double slid = 0;
        for (size_t k = 1; k < n; k++) slid += p[k] * (w0[k] + w1[k]) / 2;
        state.friction += std::max(slid, 0.0);
        state.dissipated += p[0] * (w0[0] + w1[0]) / 2 + std::min(slid, 0.0);
        if (p[0] == 0) continue;
        state.held.push_back({c.key, -p[0] / h});
        push(i, h, at_middle + n * i, p, state);
        if (c.gap <= closed_gap_) continue;
        if (from_rest) {
            // the motion without the impulse cannot be estimated from the drives: halve the step
            state.closing = h / 2;
            continue;
        }
        // time at which the motion without the contact's impulse, with a rate linear in time, closes the gap to half the closed gap
        const double most = implausible * std::max(std::fabs(w0[0]), std::fabs(w1[0]));
        const double free = std::max(w1[0] + p[0] * c.inverse_mass, -most), fastest = std::min(w0[0], free), way = c.gap - closed_gap_ / 2;
        if (-fastest <= rest_rate(c)) continue;
        const double root = w0[0] * w0[0] - 2 * way * (free - w0[0]) / h;
        const double t = root > 0 ? 2 * way / (-w0[0] + std::sqrt(root)) : h / 2;
        const double closes = t > 0 && t < h ? t : h / 2;
        state.closing = state.closing > 0 ? std::min(state.closing, closes) : closes;
    }
}

void Contacts::push(size_t i, double h, const Row* at_middle, const double* impulse, ContactState& state) const {
    const int obstacle = pairs_[active_[i].pair].obstacle;
    if (obstacle < 0) return;
    Vec3 sum;
    for (size_t k = 0; k < rows(); k++) sum = sum + impulse[k] * at_middle[k].t;
    state.impulse[at(obstacle)] = state.impulse[at(obstacle)] + sum;
    state.force[at(obstacle)] = state.force[at(obstacle)] + (1 / h) * sum;
}

bool Contacts::impact_follows(const double* gap, const double* rate) const {
    for (size_t i = 0; i < active_.size(); i++) {
        if (!crushes(i) && gap[rows() * i] <= closed_gap_ && rate[rows() * i] < -rest_rate(active_[i])) return true;
    }
    return false;
}

}  // namespace crumple::spatial
