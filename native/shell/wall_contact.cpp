#include "wall_contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::shell {

namespace {

// A node can be near so many elements at once at most; more are passed over.
constexpr std::size_t most_hits = 24;

// Elements of `near` that hang together with the node: start at its own, go on to those that share a node.
std::vector<Index> connected(const std::vector<Index>& quads, Index node, const std::vector<Index>& near) {
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

std::vector<Box> boxes_around(const Sheets& s, const double* position, int stride, double grow) {
    std::vector<Box> boxes;
    boxes.reserve(s.model.elements());
    for (std::size_t e = 0; e < s.model.elements(); e++)
        boxes.push_back(box_around<4>(position, stride, &s.model.quads[4 * e], grow));
    return boxes;
}

}  // namespace

WallContact::WallContact(const Sheets& sheets) : sheets_(sheets), stick_(2 * sheets.model.nodes()) {
    for (double t : sheets.model.thickness) reach_ = std::max(reach_, t);
    if (sheets.model.contact.gap > 0.0) reach_ = sheets.model.contact.gap;
    list_neighbours();
}

double WallContact::gap(Index n, Index e) const {
    const double given = sheets_.model.contact.gap;
    return given > 0.0 ? given : sheets_.half[n] + sheets_.half_of(e);
}

// The same piece of sheet, and what overlaps at the start (walls joined on purpose), never touch.
void WallContact::list_neighbours() {
    const Model& model = sheets_.model;
    const std::vector<std::uint8_t> alive(model.elements(), 1);
    const double* x0 = model.position.data();
    neighbour_first_.assign(model.nodes() + 1, 0);
    const PairList pairs = points_in_boxes(x0, 3, model.nodes(), boxes_around(sheets_, x0, 3, neighbourhood * reach_), alive);
    std::size_t k = 0;
    for (Index n = 0; n < model.nodes(); n++) {
        std::vector<Index> near, overlapping;
        for (; k < pairs.size() && pairs[k].first == n; k++) {
            const Index e = pairs[k].second;
            Vec3 x[4];
            sheets_.corners(x0, 3, e, x);
            const double distance = closest_on_quad(read3(x0 + 3 * n), x).distance;
            if (distance < neighbourhood * gap(n, e)) near.push_back(e);
            if (distance < (1.0 - 1e-6) * gap(n, e)) overlapping.push_back(e);
        }
        std::vector<Index> apart = connected(model.quads, n, near);
        apart.insert(apart.end(), overlapping.begin(), overlapping.end());
        std::sort(apart.begin(), apart.end());
        apart.erase(std::unique(apart.begin(), apart.end()), apart.end());
        neighbours_.insert(neighbours_.end(), apart.begin(), apart.end());
        neighbour_first_[n + 1] = Index(neighbours_.size());
    }
}

bool WallContact::neighbour(Index n, Index e) const {
    for (Index k = neighbour_first_[n]; k < neighbour_first_[n + 1]; k++)
        if (neighbours_[k] == e) return true;
    return false;
}

void WallContact::search(const Motions& m, const std::vector<std::uint8_t>& alive, double skin) {
    std::vector<Index> listed;
    std::vector<std::size_t> first{0};
    std::vector<Candidate> candidates;
    std::size_t old = 0;
    const double far = reach_ + skin;
    const auto boxes = boxes_around(sheets_, m.position, position_record, far);
    for (auto [n, e] : points_in_boxes(m.position, position_record, sheets_.model.nodes(), boxes, alive)) {
        if (!(sheets_.half[n] > 0.0) || neighbour(n, e)) continue;
        Vec3 x[4];
        sheets_.corners(m.position, position_record, e, x);
        if (closest_on_quad(position_of(m, n), x).distance > far) continue;
        std::int8_t side = 0;
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
    // a node that has left every wall behind has nothing that sticks
    std::vector<Vec3> stick(stick_.size());
    for (Index n : listed) std::copy_n(&stick_[2 * n], 2, &stick[2 * n]);
    stick_ = std::move(stick);
    listed_ = std::move(listed);
    candidate_first_ = std::move(first);
    candidates_ = std::move(candidates);
    touch_.assign(2 * listed_.size(), Touch{});
}

// Whether the node is nearer to the element than the gap, and how.  The side on which it is held is the one from
// which it comes to lie over the element; beside the border there is none.
bool WallContact::hit(const Motions& m, Index n, Candidate& c, Hit& found) const {
    const Vec3 p = position_of(m, n);
    const double g = gap(n, c.element);
    Vec3 x[4];
    sheets_.corners(m.position, position_record, c.element, x);
    // reject by the slab and the ball around the element
    const Vec3 centre = 0.25 * ((x[0] + x[1]) + (x[2] + x[3])), away = p - centre, across = cross(x[2] - x[0], x[3] - x[1]);
    double ball = 0.0;
    for (const Vec3& corner : x) ball = std::max(ball, dot(corner - centre, corner - centre));
    const double far = std::sqrt(ball) + g;
    const double size = norm(across), high = std::abs(dot(away, across)), warp = std::abs(dot(x[0] - centre, across));
    const bool near = high < g * size + warp && dot(away, away) < far * far;
    const Closest q = near ? closest_on_quad(p, x) : Closest{};
    if (!near || q.distance >= g) {
        c.side = 0;
        return false;
    }
    const Vec3 d = p - q.point;
    if (!q.inside) c.side = 0;
    else if (c.side == 0) c.side = dot(d, across) >= 0.0 ? 1 : -1;
    const Vec3 normal = (double(c.side) / size) * across;
    const bool through = dot(d, normal) < 0.0, on_it = q.distance < 1e-9 * g;
    found = {q, through || (on_it && q.inside) ? normal : (1.0 / std::max(q.distance, 1e-9 * g)) * d, g,
             g - (through ? -q.distance : q.distance), c.element};
    return true;
}

WallContact::Touch WallContact::touch(const Motions& m, Index n, const Hit& hit, Vec3& stick) const {
    Touch touch{};
    touch.element = hit.element;
    touch.depth = hit.depth / hit.gap;
    touch.active = true;
    double compliance = 1.0 / sheets_.mass[n];
    Vec3 slip = velocity_of(m, n);
    for (std::size_t c = 0; c < 4; c++) {
        const Index corner = sheets_.model.quads[4 * hit.element + c];
        const double w = touch.weight[c] = hit.at.weight[c];
        compliance += w * w / sheets_.mass[corner];
        slip = slip - w * velocity_of(m, corner);
    }
    const ContactSettings& s = sheets_.model.contact;
    touch.force = force_of(bond_of(s, 1.0 / compliance, sheets_.step, s.friction), hit.depth, hit.direction, slip, m.step, stick);
    return touch;
}

void WallContact::evaluate(const Motions& m, std::size_t i) {
    const Index n = listed_[i];
    Hit hits[most_hits];
    std::size_t count = 0;
    for (std::size_t k = candidate_first_[i]; k < candidate_first_[i + 1] && count < most_hits; k++)
        count += hit(m, n, candidates_[k], hits[count]);
    const Hit *first = nullptr, *second = nullptr;
    for (std::size_t k = 0; k < count; k++)
        if (!first || hits[k].at.distance < first->at.distance) first = &hits[k];
    for (std::size_t k = 0; k < count; k++)
        if (dot(hits[k].direction, first->direction) < 0.0 && (!second || hits[k].at.distance < second->at.distance)) second = &hits[k];
    const Hit* chosen[2] = {first, second};
    for (std::size_t k = 0; k < 2; k++) {
        Vec3& stick = stick_[2 * n + k];
        if (!chosen[k]) stick = {};
        touch_[2 * i + k] = chosen[k] ? touch(m, n, *chosen[k], stick) : Touch{};
    }
}

double WallContact::commit(NodeForces& forces) const {
    double deepest = 0.0;
    for (std::size_t i = 0; i < touch_.size(); i++) {
        const Touch& t = touch_[i];
        if (!t.active) continue;
        deepest = std::max(deepest, t.depth);
        // node first, then the corners that carry it
        forces.add(listed_[i / 2], t.force);
        for (std::size_t c = 0; c < 4; c++)
            if (t.weight[c] != 0.0) forces.add(sheets_.model.quads[4 * t.element + c], (-t.weight[c]) * t.force);
    }
    return deepest;
}

// [counts, lists, sticking forces of the listed nodes]
void WallContact::save(std::vector<double>& out) const {
    out.push_back(double(listed_.size()));
    out.push_back(double(candidates_.size()));
    for (std::size_t i = 0; i < listed_.size(); i++) {
        out.push_back(listed_[i]);
        out.push_back(double(candidate_first_[i + 1]));
        for (std::size_t k = 0; k < 2; k++) {
            const Vec3 s = stick_[2 * listed_[i] + k];
            out.insert(out.end(), {s.x, s.y, s.z});
        }
    }
    for (const Candidate& c : candidates_) {
        out.push_back(c.element);
        out.push_back(c.side);
    }
}

void WallContact::restore(const double*& in) {
    listed_.resize(std::size_t(*in++));
    candidates_.resize(std::size_t(*in++));
    candidate_first_.assign(listed_.size() + 1, 0);
    stick_.assign(stick_.size(), Vec3{});
    for (std::size_t i = 0; i < listed_.size(); i++) {
        listed_[i] = Index(*in++);
        candidate_first_[i + 1] = std::size_t(*in++);
        for (std::size_t k = 0; k < 2; k++, in += 3) stick_[2 * listed_[i] + k] = read3(in);
    }
    for (Candidate& c : candidates_) {
        c.element = Index(*in++);
        c.side = std::int8_t(*in++);
    }
    touch_.assign(2 * listed_.size(), Touch{});
}

}  // namespace crumple::shell
