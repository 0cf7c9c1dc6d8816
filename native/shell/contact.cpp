#include "contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::shell {

namespace {

// Neighbourhood in the sheet: twice the gap lets a fold of inner radius half a thickness still be seen
// (its points in contact were pi/2 thicknesses apart), and keeps compressed flat walls free of contact.
constexpr double neighbourhood = 2.0;
// Positions are compared with those of the last search once in so many steps ...
constexpr std::size_t check_every = 10;
// ... and a search is due when a node has moved by this share of the margin; two nodes approach at most twice as fast.
constexpr double moved_share = 0.35;

}  // namespace

Contact::Contact(const Model& model, const Masses& masses, double step)
    : model_(model), mass_(masses.mass), half_(model.nodes(), 0.0), step_(step), on_(model.contact.on), planes_(model.planes) {
    std::vector<int> sharing(model.nodes(), 0);
    for (std::size_t e = 0; e < model.elements(); e++) {
        for (int c = 0; c < 4; c++) {
            half_[model.quads[4 * e + c]] += 0.5 * model.thickness[e];
            sharing[model.quads[4 * e + c]]++;
        }
        reach_ = std::max(reach_, model.thickness[e]);
    }
    for (std::size_t n = 0; n < model.nodes(); n++) half_[n] /= std::max(sharing[n], 1);
    if (model.contact.gap > 0.0) reach_ = model.contact.gap;
    // not beyond the neighbourhood, else every node would list the rest of its own wall
    skin_ = (neighbourhood - 1.0) * reach_;
    if (!any()) return;
    force_.assign(4 * model.nodes(), 0.0);
    force_before_.assign(4 * model.nodes(), 0.0);
    for (std::size_t p = 0; p < planes_.size(); p++)
        for (Index n : planes_[p].nodes) plane_item_.emplace_back(p, n);
    plane_touch_.resize(plane_item_.size());
    if (on_) list_neighbours();
}

void Contact::corners(const double* position, Index e, Vec3 (&x)[4]) const {
    for (int c = 0; c < 4; c++) x[c] = read3(position + position_record * model_.quads[4 * e + std::size_t(c)]);
}

// Elements of `near` that hang together with the node: start at its own, go on to those that share a node.
static std::vector<Index> connected(const std::vector<Index>& quads, Index node, const std::vector<Index>& near) {
    auto shares = [&](Index a, Index b) {
        for (std::size_t i = 0; i < 4; i++)
            for (std::size_t j = 0; j < 4; j++)
                if (quads[4 * a + i] == quads[4 * b + j]) return true;
        return false;
    };
    std::vector<Index> found, open(near);
    for (auto e = open.begin(); e != open.end();) {
        const bool own = std::find(&quads[4 * *e], &quads[4 * *e] + 4, node) != &quads[4 * *e] + 4;
        if (own) found.push_back(*e);
        e = own ? open.erase(e) : e + 1;
    }
    for (std::size_t k = 0; k < found.size(); k++)
        for (auto e = open.begin(); e != open.end();) {
            const bool next = shares(found[k], *e);
            if (next) found.push_back(*e);
            e = next ? open.erase(e) : e + 1;
        }
    return found;
}

// The same piece of sheet, and what overlaps at the start (walls joined on purpose), never touch.
void Contact::list_neighbours() {
    const std::vector<std::uint8_t> alive(model_.elements(), 1);
    neighbour_first_.assign(model_.nodes() + 1, 0);
    const PairList pairs = close_pairs(model_.position.data(), 3, model_.nodes(), model_.quads, alive, neighbourhood * reach_);
    std::size_t k = 0;
    for (Index n = 0; n < model_.nodes(); n++) {
        std::vector<Index> near, overlapping;
        for (; k < pairs.size() && pairs[k].first == n; k++) {
            const Index e = pairs[k].second;
            Vec3 x[4];
            for (std::size_t c = 0; c < 4; c++) x[c] = read3(&model_.position[3 * model_.quads[4 * e + c]]);
            const double gap = model_.contact.gap > 0.0 ? model_.contact.gap : half_[n] + 0.5 * model_.thickness[e];
            const double distance = closest_on_quad(read3(&model_.position[3 * n]), x).distance;
            if (distance < neighbourhood * gap) near.push_back(e);
            if (distance < (1.0 - 1e-6) * gap) overlapping.push_back(e);
        }
        std::vector<Index> apart = connected(model_.quads, n, near);
        apart.insert(apart.end(), overlapping.begin(), overlapping.end());
        std::sort(apart.begin(), apart.end());
        apart.erase(std::unique(apart.begin(), apart.end()), apart.end());
        neighbours_.insert(neighbours_.end(), apart.begin(), apart.end());
        neighbour_first_[n + 1] = Index(neighbours_.size());
    }
}

bool Contact::neighbour(Index n, Index e) const {
    for (Index k = neighbour_first_[n]; k < neighbour_first_[n + 1]; k++)
        if (neighbours_[k] == e) return true;
    return false;
}

void Contact::search_when_needed(const Motions& m, const std::vector<std::uint8_t>& alive, bool force) {
    if (!on_) return;
    if (!force && ++checks_ % check_every != 0) return;
    if (!force && !searched_at_.empty()) {
        const double limit = moved_share * skin_;
        bool far = false;
        for (std::size_t n = 0; n < model_.nodes() && !far; n++) {
            const Vec3 d = read3(m.position + position_record * n) - read3(&searched_at_[3 * n]);
            far = !(dot(d, d) < limit * limit);
        }
        if (!far) return;
    }
    search(m, alive);
}

void Contact::search(const Motions& m, const std::vector<std::uint8_t>& alive) {
    searches_++;
    searched_at_.resize(3 * model_.nodes());
    for (std::size_t n = 0; n < model_.nodes(); n++) write3(&searched_at_[3 * n], read3(m.position + position_record * n));
    std::vector<Index> listed;
    std::vector<std::size_t> first{0};
    std::vector<Candidate> candidates;
    std::size_t old = 0;
    for (auto [n, e] : close_pairs(m.position, position_record, model_.nodes(), model_.quads, alive, reach_ + skin_)) {
        if (neighbour(n, e)) continue;
        Vec3 x[4];
        corners(m.position, e, x);
        if (closest_on_quad(read3(m.position + position_record * n), x).distance > reach_ + skin_) continue;
        const Vec3 centre = 0.25 * ((x[0] + x[1]) + (x[2] + x[3])), normal = cross(x[2] - x[0], x[3] - x[1]);
        std::int8_t side = dot(read3(m.position + position_record * n) - centre, normal) >= 0.0 ? 1 : -1;
        // a pair known already keeps its side, even where the node has been pressed through
        while (old < listed_.size() && listed_[old] < n) old++;
        if (old < listed_.size() && listed_[old] == n)
            for (std::size_t k = candidate_first_[old]; k < candidate_first_[old + 1]; k++)
                if (candidates_[k].element == e) side = candidates_[k].side;
        if (listed.empty() || listed.back() != n) {
            listed.push_back(n);
            first.push_back(candidates.size());
        }
        candidates.push_back({e, side});
        first.back() = candidates.size();
    }
    listed_ = std::move(listed);
    candidate_first_ = std::move(first);
    candidates_ = std::move(candidates);
    wall_touch_.assign(listed_.size(), Touch{});
}

// normal force along `direction`, viscous share and friction, from a relative velocity
static Vec3 penalty(double k, double mass, double step, double depth, Vec3 direction, Vec3 slip, double friction, double damping) {
    const double approach = dot(slip, direction), impedance = std::sqrt(k * mass);
    const double normal = std::max(k * depth - 2.0 * damping * impedance * approach, 0.0);
    const Vec3 tangent = slip - approach * direction;
    const double speed = norm(tangent);
    Vec3 force = normal * direction;
    // friction is viscous up to the Coulomb limit; half a mass per step is the stiffest damper that central differences take well
    if (friction > 0.0 && speed > 0.0) force = force - (std::min(friction * normal / speed, 0.5 * mass / step)) * tangent;
    return force;
}

Touch Contact::touch_wall(const Motions& m, Index n, std::size_t first, std::size_t last) const {
    const Vec3 p = read3(m.position + position_record * n);
    Touch touch{};
    Closest best{};
    double best_distance = 1e300, gap = 0.0;
    Vec3 direction;
    for (std::size_t k = first; k < last; k++) {
        const Candidate c = candidates_[k];
        const double g = model_.contact.gap > 0.0 ? model_.contact.gap : half_[n] + 0.5 * model_.thickness[c.element];
        Vec3 x[4];
        corners(m.position, c.element, x);
        // reject by the ball around the element
        const Vec3 centre = 0.25 * ((x[0] + x[1]) + (x[2] + x[3])), away = p - centre;
        double ball = 0.0;
        for (const Vec3& corner : x) ball = std::max(ball, dot(corner - centre, corner - centre));
        if (norm(away) > std::sqrt(ball) + g) continue;
        const Closest q = closest_on_quad(p, x);
        if (q.distance >= g || q.distance >= best_distance) continue;
        const Vec3 across = cross(x[2] - x[0], x[3] - x[1]), normal = (double(c.side) / norm(across)) * across;
        const Vec3 d = p - q.point;
        const bool through = q.inside && dot(d, normal) < 0.0, on_it = q.distance < 1e-9 * g;
        best = q;
        best_distance = q.distance;
        gap = g;
        direction = through || on_it ? normal : (1.0 / q.distance) * d;
        touch.depth = (g - (through ? -q.distance : q.distance)) / g;
        touch.element = c.element;
        touch.active = true;
    }
    if (!touch.active) return touch;
    double compliance = 1.0 / mass_[n];
    Vec3 slip = read3(m.velocity + velocity_record * n);
    for (std::size_t c = 0; c < 4; c++) {
        const Index corner = model_.quads[4 * touch.element + c];
        touch.weight[c] = best.weight[c];
        compliance += best.weight[c] * best.weight[c] / mass_[corner];
        slip = slip - best.weight[c] * read3(m.velocity + velocity_record * corner);
    }
    const SelfContact& s = model_.contact;
    const double k = s.stiffness / (compliance * step_ * step_);
    touch.force = penalty(k, 1.0 / compliance, step_, touch.depth * gap, direction, slip, s.friction, s.damping);
    return touch;
}

Touch Contact::touch_plane(const Motions& m, std::size_t item) const {
    const Plane& plane = planes_[plane_item_[item].first];
    const Index n = plane_item_[item].second;
    Touch touch{};
    const double depth = plane.gap - dot(read3(m.position + position_record * n) - plane.point, plane.normal);
    if (!(depth > 0.0)) return touch;
    touch.active = true;
    touch.depth = depth / std::max(plane.gap, half_[n]);
    const double k = model_.contact.stiffness * mass_[n] / (step_ * step_);
    touch.force = penalty(k, mass_[n], step_, depth, plane.normal, read3(m.velocity + velocity_record * n), plane.friction,
                          model_.contact.damping);
    return touch;
}

void Contact::evaluate(const Motions& m, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; i++) {
        if (i < listed_.size())
            wall_touch_[i] = touch_wall(m, listed_[i], candidate_first_[i], candidate_first_[i + 1]);
        else
            plane_touch_[i - listed_.size()] = touch_plane(m, i - listed_.size());
    }
}

void Contact::add(Index n, Vec3 f) {
    add3(&force_[4 * n], f);
    if (force_[4 * n + 3] == 0.0) {
        force_[4 * n + 3] = 1.0;     // the unused fourth number marks a touched node
        touched_.push_back(n);
    }
}

void Contact::commit(const Motions& m, double last_dt) {
    std::swap(force_, force_before_);
    std::swap(touched_, touched_before_);
    for (Index n : touched_)
        for (std::size_t i = 0; i < 4; i++) force_[4 * n + i] = 0.0;
    touched_.clear();
    // node first, then the corners that carry it
    for (std::size_t i = 0; i < wall_touch_.size(); i++) {
        const Touch& t = wall_touch_[i];
        if (!t.active) continue;
        deepest_ = std::max(deepest_, t.depth);
        add(listed_[i], t.force);
        for (std::size_t c = 0; c < 4; c++)
            if (t.weight[c] != 0.0) add(model_.quads[4 * t.element + c], (-t.weight[c]) * t.force);
    }
    for (std::size_t i = 0; i < plane_touch_.size(); i++) {
        if (!plane_touch_[i].active) continue;
        deepest_ = std::max(deepest_, plane_touch_[i].depth);
        add(plane_item_[i].second, plane_touch_[i].force);
    }
    // work done against contact over the last step, by the mean of the forces at both ends
    auto work = [&](const std::vector<Index>& nodes, const aligned_vector<double>& force) {
        double sum = 0.0;
        for (Index n : nodes) sum += dot(read3(&force[4 * n]), read3(m.velocity + velocity_record * n));
        return sum;
    };
    work_ -= 0.5 * last_dt * (work(touched_, force_) + work(touched_before_, force_before_));
}

// [work, deepest, searches, checks, counts..., then the lists]
std::vector<double> Contact::save() const {
    std::vector<double> out{work_, deepest_, double(searches_), double(checks_), double(listed_.size()), double(candidates_.size()),
                            double(touched_.size()), double(searched_at_.size())};
    for (Index n : listed_) out.push_back(n);
    for (std::size_t k : candidate_first_) out.push_back(double(k));
    for (const Candidate& c : candidates_) {
        out.push_back(c.element);
        out.push_back(c.side);
    }
    for (Index n : touched_) {
        out.push_back(n);
        for (std::size_t i = 0; i < 4; i++) out.push_back(force_[4 * n + i]);
    }
    out.insert(out.end(), searched_at_.begin(), searched_at_.end());
    return out;
}

void Contact::restore(const std::vector<double>& in) {
    work_ = in[0];
    deepest_ = in[1];
    searches_ = std::size_t(in[2]);
    checks_ = std::size_t(in[3]);
    const double* next = in.data() + 8;
    listed_.resize(std::size_t(in[4]));
    candidates_.resize(std::size_t(in[5]));
    candidate_first_.resize(on_ && searches_ ? listed_.size() + 1 : 0);
    for (Index& n : listed_) n = Index(*next++);
    for (std::size_t& k : candidate_first_) k = std::size_t(*next++);
    for (Candidate& c : candidates_) {
        c.element = Index(*next++);
        c.side = std::int8_t(*next++);
    }
    for (Index n : touched_)
        for (std::size_t i = 0; i < 4; i++) force_[4 * n + i] = 0.0;
    touched_.resize(std::size_t(in[6]));
    for (Index& n : touched_) {
        n = Index(*next++);
        for (std::size_t i = 0; i < 4; i++) force_[4 * n + i] = *next++;
    }
    searched_at_.assign(next, next + std::size_t(in[7]));
    wall_touch_.assign(listed_.size(), Touch{});
}

}  // namespace crumple::shell
