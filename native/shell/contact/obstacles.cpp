#include "shell/contact/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crumple::shell {

namespace {

// If the walls in contact are heavier than this multiple of an obstacle's mass, its penalty stiffness is reduced: the springs of all
// nodes act on the same mass, and the sum of their shares of the stability limit must stay below that limit.
constexpr double heaviest_walls = 4.0;

// rotation matrix about a unit axis
Mat3 turned(Vec3 k, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), d = 1.0 - c;
    return Mat3{{c + d * k.x * k.x, d * k.x * k.y - s * k.z, d * k.x * k.z + s * k.y,
                 d * k.y * k.x + s * k.z, c + d * k.y * k.y, d * k.y * k.z - s * k.x,
                 d * k.z * k.x - s * k.y, d * k.z * k.y + s * k.x, c + d * k.z * k.z}};
}

Distance from_round(Vec3 apart, double radius, Vec3 otherwise) {
    const double size = norm(apart);
    return {size - radius, size > 0.0 ? (1.0 / size) * apart : otherwise};
}

}  // namespace

Distance distance_from(const Obstacle& o, Vec3 x) {
    const Vec3 r = x - o.point;
    switch (o.shape) {
        case Shape::plane: return {dot(r, o.axis), o.axis};
        case Shape::edge: {
            // the corner between the plane and the side below its edge
            const double above = dot(r, o.axis), beyond = dot(r, o.edge);
            if (above > 0.0 && beyond > 0.0) return from_round(above * o.axis + beyond * o.edge, 0.0, o.axis);
            return above >= beyond ? Distance{above, o.axis} : Distance{beyond, o.edge};
        }
        case Shape::cylinder: return from_round(r - std::clamp(dot(r, o.axis), 0.0, o.length) * o.axis, o.radius, o.edge);
        case Shape::pole: return from_round(r - dot(r, o.axis) * o.axis, o.radius, o.edge);
        case Shape::sphere: return from_round(r, o.radius, o.edge);
    }
    return {};
}

ObstacleContact::ObstacleContact(const Sheets& sheets)
    : sheets_(sheets), model_(sheets.model.obstacles), states_(model_.size()), turn_(model_.size()), present_(model_.size(), 0),
      searched_at_(model_.size()), mass_(sheets.mass), half_(sheets.half) {
    for (std::size_t i = 0; i < model_.size(); i++) {
        const Obstacle& o = model_[i];
        states_[i].velocity = o.mass > 0.0 ? o.velocity : Vec3{};
        double walls = 0.0;
        for (Index n : o.nodes) walls += sheets.mass[n];
        soft_.push_back(o.mass > 0.0 ? std::min(1.0, heaviest_walls * o.mass / walls) : 1.0);
        gap_.emplace_back(o.nodes.size(), 0.0);
        stick_.emplace_back(o.nodes.size());
    }
}

void ObstacleContact::attach(const std::vector<RigidBody>& bodies, const std::vector<RigidState>& states) {
    bodies_ = &bodies;
    body_states_ = &states;
    body_of_.assign(sheets_.mass.size(), -1);
    ground_.mass = 1.0;
    ground_.held = 0x3fu;
    for (std::size_t b = 0; b < bodies.size(); b++) {
        double mass = 0.0, half = 0.0, walls = 0.0;
        for (Index n : bodies[b].nodes) {
            body_of_[n] = std::int32_t(b);
            if (!(sheets_.half[n] > 0.0)) continue;
            mass += sheets_.mass[n];
            half += sheets_.half[n];
            walls += 1.0;
        }
        for (Index n : bodies[b].nodes) {
            if (sheets_.half[n] > 0.0 || walls == 0.0) continue;
            mass_[n] = mass / walls;
            half_[n] = half / walls;
        }
    }
}

int ObstacleContact::set_of(const Item& item) const {
    constexpr unsigned translations = 7u;
    const Obstacle& o = model_[item.obstacle];
    const Index n = o.nodes[item.place];
    if (body_of_[n] >= 0) return body_of_[n];
    return o.mass > 0.0 && (sheets_.model.fixed[n] & translations) == translations ? int(bodies_->size()) : -1;
}

Vec3 ObstacleContact::in_frame(std::size_t o, Vec3 x) const {
    const Vec3 c = model_[o].turn_about;
    return c + transposed_times(turn_[o], x - c) - states_[o].shift;
}

void ObstacleContact::place(const Motions& m) {
    for (std::size_t i = 0; i < model_.size(); i++) {
        const bool appears = model_[i].active && !present_[i];
        present_[i] = model_[i].active;
        states_[i].inside = 0.0;
        if (!appears) continue;
        for (std::size_t k = 0; k < gap_[i].size(); k++) {
            const Index n = model_[i].nodes[k];
            const double distance = distance_from(model_[i], in_frame(i, position_of(m, n))).value;
            gap_[i][k] = std::min(half_[n] + model_[i].gap, distance);
            stick_[i][k] = {};
            if (sheets_.half[n] > 0.0 && -distance > states_[i].inside) {
                states_[i].inside = -distance;
                states_[i].inside_node = n;
            }
        }
    }
}

double ObstacleContact::acceleration(std::size_t i) const {
    const Obstacle& o = model_[i];
    return dot(states_[i].force, o.guide) / o.mass + dot(sheets_.model.settings.gravity, o.guide);
}

void ObstacleContact::move(double time, double kick, double drift) {
    const double middle = time + 0.5 * drift;
    for (std::size_t i = 0; i < model_.size(); i++) {
        const Obstacle& o = model_[i];
        State& s = states_[i];
        if (!o.active) continue;
        if (o.mass > 0.0) {
            s.velocity = s.velocity + (kick * acceleration(i)) * o.guide;
        } else {
            const auto rate = [&](const Curve& c) { return c.time.empty() ? 0.0 : c.at(middle); };
            s.velocity = {rate(o.motion[0]), rate(o.motion[1]), rate(o.motion[2])};
            s.rate = rate(o.turning);
        }
        s.shift = s.shift + drift * s.velocity;
        s.angle += drift * s.rate;
        if (s.angle != 0.0) turn_[i] = turned(o.turn_axis, s.angle);
    }
}

void ObstacleContact::evaluate(const Motions& m, std::size_t i) {
    const Item item = items_[i];
    const Obstacle& o = model_[item.obstacle];
    const State& s = states_[item.obstacle];
    const Index n = o.nodes[item.place];
    const Vec3 x = position_of(m, n);
    const Distance d = distance_from(o, in_frame(item.obstacle, x));
    const double depth = gap_[item.obstacle][item.place] - d.value;
    Vec3& stick = stick_[item.obstacle][item.place];
    touch_[i].active = depth > 0.0;
    if (!touch_[i].active) {
        stick = {};
        return;
    }
    const Vec3 surface = turn_[item.obstacle] * s.velocity + cross(s.rate * o.turn_axis, x - o.turn_about);
    Touch& touch = touch_[i];
    touch.normal = turn_[item.obstacle] * d.normal;
    touch.slip = velocity_of(m, n) - surface;
    touch.depth = depth;
    if (set_of(item) >= 0) return;
    const double mass = soft_[item.obstacle] * sheets_.mass[n];
    const Bond bond = bond_of(sheets_.model.contact, mass, sheets_.step, o.friction);
    touch.force = force_of(bond, depth, touch.normal, touch.slip, m.step, stick);
    touch.moment = cross(x - o.turn_about, touch.force);
}

std::vector<std::vector<BodyTouch>> ObstacleContact::touches_of_bodies(const Motions& m) const {
    std::vector<std::vector<BodyTouch>> of(bodies_->size() + 1);
    std::vector<double> touching(bodies_->size() + 1, 0.0);  // wall mass of each set's nodes that touch
    for (std::size_t i = 0; i < items_.size(); i++) {
        const int set = set_of(items_[i]);
        if (touch_[i].active && set >= 0) touching[std::size_t(set)] += mass_[model_[items_[i].obstacle].nodes[items_[i].place]];
    }
    for (std::size_t i = 0; i < items_.size(); i++) {
        const Obstacle& o = model_[items_[i].obstacle];
        const Index n = o.nodes[items_[i].place];
        const int set = set_of(items_[i]);
        if (!touch_[i].active || set < 0) continue;
        const std::size_t b = std::size_t(set);
        BodyTouch t{};
        t.item = i;
        t.arm = position_of(m, n) - (b < bodies_->size() ? (*body_states_)[b].centre : Vec3{});
        t.normal = touch_[i].normal;
        t.slip = touch_[i].slip;
        t.depth = touch_[i].depth;
        t.partner = -1;
        t.guide = o.guide;
        t.damping = o.damping;
        t.friction = o.friction;
        t.share = mass_[n] / touching[b];
        t.stick = stick_[items_[i].obstacle][items_[i].place];
        of[b].push_back(t);
    }
    return of;
}

void ObstacleContact::hold_bodies(const Motions& m) {
    const double stiffness = sheets_.model.contact.stiffness / (sheets_.step * sheets_.step);
    std::vector<std::vector<BodyTouch>> of = touches_of_bodies(m);
    // sets that an obstacle presses at the same time have equal parts of its mass: its acceleration is then the mean of what they ask
    std::vector<double> pressed(model_.size(), 0.0);
    for (const auto& touches : of) {
        std::vector<std::uint8_t> presses(model_.size(), 0);
        for (const BodyTouch& t : touches) presses[items_[t.item].obstacle] |= wanted(t, stiffness) > 0.0;
        for (std::size_t o = 0; o < model_.size(); o++) pressed[o] += presses[o];
    }
    for (std::size_t b = 0; b < of.size(); b++) {
        if (of[b].empty()) continue;
        std::vector<double> partners;
        std::vector<int> place(model_.size(), -1);
        for (BodyTouch& t : of[b]) {
            const std::size_t o = items_[t.item].obstacle;
            if (!(model_[o].mass > 0.0)) continue;
            if (place[o] < 0) {
                place[o] = int(partners.size());
                partners.push_back(model_[o].mass / std::max(pressed[o], 1.0));
            }
            t.partner = place[o];
        }
        const bool moves = b < bodies_->size();
        hold(moves ? (*bodies_)[b] : ground_, moves ? (*body_states_)[b] : RigidState{}, partners, stiffness, m.step, of[b]);
        for (const BodyTouch& t : of[b]) {
            const Obstacle& o = model_[items_[t.item].obstacle];
            stick_[items_[t.item].obstacle][items_[t.item].place] = t.stick;
            touch_[t.item].force = t.force;
            touch_[t.item].moment = cross(position_of(m, o.nodes[items_[t.item].place]) - o.turn_about, t.force);
        }
    }
}

double ObstacleContact::commit(const Motions& m, NodeForces& forces) {
    hold_bodies(m);
    for (State& s : states_) {
        s.force_before = s.force;
        s.moment_before = s.moment;
        s.force = s.moment = Vec3{};
    }
    double deepest = 0.0;
    for (std::size_t i = 0; i < items_.size(); i++) {
        if (!touch_[i].active) continue;
        const Obstacle& o = model_[items_[i].obstacle];
        State& s = states_[items_[i].obstacle];
        forces.add(o.nodes[items_[i].place], touch_[i].force);
        s.force = s.force - touch_[i].force;
        s.moment = s.moment - touch_[i].moment;
        const double depth = touch_[i].depth / half_[o.nodes[items_[i].place]];
        s.deepest = std::max(s.deepest, depth);
        deepest = std::max(deepest, depth);
    }
    return deepest;
}

double ObstacleContact::power(bool before) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < model_.size(); i++) {
        const State& s = states_[i];
        if (!model_[i].active) continue;
        sum += dot(before ? s.force_before : s.force, turn_[i] * s.velocity);
        sum += s.rate * dot(before ? s.moment_before : s.moment, model_[i].turn_axis);
    }
    return sum;
}

void ObstacleContact::book(double step) {
    const Vec3 g = sheets_.model.settings.gravity;
    for (std::size_t i = 0; i < model_.size(); i++) {
        State& s = states_[i];
        s.impulse = s.impulse + (0.5 * step) * (s.force + s.force_before);
        if (!model_[i].active) continue;
        if (model_[i].mass > 0.0)
            outside_work_ += step * model_[i].mass * dot(g, s.velocity);
        else
            outside_work_ -= 0.5 * step * (dot(s.force + s.force_before, turn_[i] * s.velocity) +
                                           s.rate * dot(s.moment + s.moment_before, model_[i].turn_axis));
    }
}

double ObstacleContact::kinetic(double kick) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < model_.size(); i++) {
        const Obstacle& o = model_[i];
        if (!(o.mass > 0.0)) continue;
        const double v = dot(states_[i].velocity, o.guide);
        sum += 0.5 * o.mass * v * (o.active ? v + kick * acceleration(i) : v);
    }
    return sum;
}

double ObstacleContact::stop() {
    const double lost = kinetic(0.0);
    for (std::size_t i = 0; i < model_.size(); i++)
        if (model_[i].mass > 0.0 && model_[i].active) states_[i].velocity = {};
    return lost - kinetic(0.0);
}

double ObstacleContact::moved() const {
    double most = 0.0;
    for (std::size_t i = 0; i < model_.size(); i++) {
        if (!model_[i].active) continue;
        most = std::max(most, norm(states_[i].shift - searched_at_[i]));
    }
    return most;
}

// for a rotating obstacle all its nodes are listed, because the distance that it sweeps depends on their positions
void ObstacleContact::search(const Motions& m, double skin) {
    items_.clear();
    for (std::size_t i = 0; i < model_.size(); i++) {
        searched_at_[i] = states_[i].shift;
        if (!model_[i].active) continue;
        const bool turns = !model_[i].turning.time.empty();
        for (std::size_t k = 0; k < model_[i].nodes.size(); k++) {
            const Vec3 x = in_frame(i, position_of(m, model_[i].nodes[k]));
            if (turns || distance_from(model_[i], x).value < gap_[i][k] + skin)
                items_.push_back({std::uint32_t(i), std::uint32_t(k)});
            else
                stick_[i][k] = {};
        }
    }
    touch_.assign(items_.size(), Touch{});
}

void ObstacleContact::save(std::vector<double>& out) const {
    out.push_back(outside_work_);
    for (std::size_t i = 0; i < model_.size(); i++) {
        const State& s = states_[i];
        for (Vec3 v : {s.shift, s.velocity, s.force, s.moment, s.force_before, s.moment_before, s.impulse, searched_at_[i]})
            out.insert(out.end(), {v.x, v.y, v.z});
        out.insert(out.end(), {s.angle, s.rate, s.deepest, double(present_[i])});
        for (std::size_t k = 0; k < gap_[i].size(); k++)
            out.insert(out.end(), {gap_[i][k], stick_[i][k].x, stick_[i][k].y, stick_[i][k].z});
    }
    out.push_back(double(items_.size()));
    for (const Item& item : items_) out.insert(out.end(), {double(item.obstacle), double(item.place)});
}

void ObstacleContact::restore(Saved& in) {
    outside_work_ = in.number();
    for (std::size_t i = 0; i < model_.size(); i++) {
        State& s = states_[i];
        for (Vec3* v : {&s.shift, &s.velocity, &s.force, &s.moment, &s.force_before, &s.moment_before, &s.impulse, &searched_at_[i]}) *v = in.vector();
        s.angle = in.number();
        s.rate = in.number();
        s.deepest = in.number();
        present_[i] = in.number() != 0.0;
        turn_[i] = s.angle != 0.0 ? turned(model_[i].turn_axis, s.angle) : Mat3{};
        for (std::size_t k = 0; k < gap_[i].size(); k++) {
            gap_[i][k] = in.number();
            stick_[i][k] = in.vector();
        }
    }
    items_.resize(in.count(2));
    for (Item& item : items_) {
        item.obstacle = std::uint32_t(in.index(model_.size()));
        item.place = std::uint32_t(in.index(gap_[item.obstacle].size()));
    }
    touch_.assign(items_.size(), Touch{});
}

}  // namespace crumple::shell
