#include "shell/contact/edge_contact.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace crumple::shell {

namespace {

// Cosine of the angle between two elements' normals below which their common edge is a crease (30 degrees).  Flatter folds are
// covered by node contact, because an edge that crosses them passes a node first.
constexpr double crease = 0.866;
// Squared sine of the angle between two edges below which they count as parallel and are left to node contact (10 degrees).
constexpr double parallel = 0.03;

struct Crossing {
    double s, t;                     // coordinates of the closest points along the segments, 0 to 1
    Vec3 apart;                      // vector from the second to the first
    bool parallel, inside;           // inside: within both segments and not parallel
};

Crossing crossing(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1) {
    const Vec3 u = a1 - a0, v = b1 - b0, r = a0 - b0;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), ur = dot(u, r), vr = dot(v, r), d = uu * vv - uv * uv;
    Crossing c{};
    c.parallel = !(d > parallel * uu * vv);
    if (c.parallel) return c;
    c.s = (uv * vr - vv * ur) / d;
    c.t = (uu * vr - uv * ur) / d;
    c.apart = r + c.s * u - c.t * v;
    c.inside = c.s > 0.0 && c.s < 1.0 && c.t > 0.0 && c.t < 1.0;
    return c;
}

double segment_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1) {
    const Crossing c = crossing(a0, a1, b0, b1);
    if (c.inside) return norm(c.apart);
    auto from = [](Vec3 p, Vec3 s0, Vec3 s1) {
        const Vec3 u = s1 - s0;
        return norm(p - s0 - std::clamp(dot(p - s0, u) / dot(u, u), 0.0, 1.0) * u);
    };
    return std::min({from(a0, b0, b1), from(a1, b0, b1), from(b0, a0, a1), from(b1, a0, a1)});
}

// Lower bound of the distance of two segments.  Segments that count as parallel may still cross between their ends; then an end lies
// within half the shorter segment of the crossing, at a distance from the other segment of at most that times the sine of their angle.
double least_distance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1) {
    const double distance = segment_distance(a0, a1, b0, b1);
    if (!crossing(a0, a1, b0, b1).parallel) return distance;
    return distance - 0.5 * std::sqrt(parallel * std::min(dot(a1 - a0, a1 - a0), dot(b1 - b0, b1 - b0)));
}

}  // namespace

EdgeContact::EdgeContact(const Sheets& sheets, const WallContact& walls)
    : sheets_(sheets), walls_(walls), normal_(sheets.model.elements()) {
    list_edges();
    out_.assign(edges_.size(), 0);
}

void EdgeContact::list_edges() {
    const Model& model = sheets_.model;
    std::map<std::pair<Index, Index>, std::size_t> known;
    for (std::size_t e = 0; e < model.elements(); e++)
        for (std::size_t c = 0; c < 4; c++) {
            const Index a = model.quads[4 * e + c], b = model.quads[4 * e + (c + 1) % 4];
            if (a == b) continue;
            const auto [at, fresh] = known.try_emplace({std::min(a, b), std::max(a, b)}, edges_.size());
            if (fresh) edges_.push_back({{std::min(a, b), std::max(a, b)}, 0.0, {}, {}});
            Edge& edge = edges_[at->second];
            edge.elements.push_back(Index(e));
            edge.sense.push_back(a < b ? 1 : -1);
        }
    for (Edge& edge : edges_) {
        for (Index e : edge.elements) edge.half += sheets_.half_of(e) / double(edge.elements.size());
        if (model.contact.gap > 0.0) edge.half = 0.5 * model.contact.gap;
    }
}

void EdgeContact::turn(const Motions& m, Range elements) {
    for (std::size_t e = elements.first; e < elements.last; e++) {
        Vec3 x[4];
        sheets_.corners(m.position, position_record, e, x);
        normal_[e] = cross(x[2] - x[0], x[3] - x[1]);
    }
}

bool EdgeContact::stands_out(const std::vector<std::uint8_t>& alive, const Edge& edge) const {
    Vec3 normal[2];
    int count = 0;
    for (std::size_t k = 0; k < edge.elements.size(); k++) {
        if (!alive[edge.elements[k]]) continue;
        // two elements with the same orientation traverse their common edge in opposite directions
        if (count < 2) normal[count] = (count == 0 ? double(edge.sense[k]) : -double(edge.sense[k])) * normal_[edge.elements[k]];
        count++;
    }
    if (count != 2) return count > 0;
    return dot(normal[0], normal[1]) < crease * std::sqrt(dot(normal[0], normal[0]) * dot(normal[1], normal[1]));
}

void EdgeContact::find_creases(const std::vector<std::uint8_t>& alive, const Member& member) {
    const Range edges = member.share(edges_.size());
    for (std::size_t i = edges.first; i < edges.last; i++) out_[i] = stands_out(alive, edges_[i]);
}

// Edges with a common node, and connected edges within twice the gap at the start, belong to the same sheet and have no contact.
// Parts of a crumpled corner that were further apart at the start have contact.
bool EdgeContact::same_sheet(const Edge& a, const Edge& b) const {
    auto near = [this](const Edge& from, const Edge& to) {
        for (Index n : from.node)
            for (Index e : to.elements)
                if (walls_.neighbour(n, e)) return true;
        return false;
    };
    for (Index n : a.node)
        if (n == b.node[0] || n == b.node[1]) return true;
    auto start = [this](Index n) { return read3(&sheets_.model.position[3 * n]); };
    const double apart = segment_distance(start(a.node[0]), start(a.node[1]), start(b.node[0]), start(b.node[1]));
    return apart < WallContact::neighbourhood * (a.half + b.half) && (near(a, b) || near(b, a));
}

void EdgeContact::start_search(const Motions& m, double skin, int members) {
    listed_.clear();
    for (Index i = 0; i < edges_.size(); i++)
        if (out_[i]) listed_.push_back(i);
    longest_ = 0.0;
    std::vector<double> middle;
    for (Index i : listed_) {
        const Vec3 a = position_of(m, edges_[i].node[0]), b = position_of(m, edges_[i].node[1]), c = 0.5 * (a + b);
        longest_ = std::max(longest_, norm(b - a));
        middle.insert(middle.end(), {c.x, c.y, c.z});
    }
    far_ = walls_.reach() + skin;
    middles_ = PointGrid(middle.data(), 3, listed_.size(), far_ + 0.5 * longest_);
    near_.resize(std::size_t(members));
}

// Finds midpoints of edges in the boxes around other edges, enlarged by half the longest edge and the search distance.
void EdgeContact::search(const Motions& m, const Member& member) {
    std::vector<Pair>& near = near_[std::size_t(member.index)];
    near.clear();
    const Range share = member.share(listed_.size());
    for (std::size_t q = share.first; q < share.last; q++) {
        const Edge& b = edges_[listed_[q]];
        const Vec3 b0 = position_of(m, b.node[0]), b1 = position_of(m, b.node[1]);
        middles_.each_in(box_around<2>(m.position, position_record, b.node, far_ + 0.5 * longest_), [&](Index p) {
            if (p >= q) return;
            const Edge& a = edges_[listed_[p]];
            if (segment_distance(position_of(m, a.node[0]), position_of(m, a.node[1]), b0, b1) > far_ || same_sheet(a, b)) return;
            near.push_back({listed_[p], listed_[q], a.half + b.half, {}, false});
        });
    }
}

void EdgeContact::end_search(const Motions& m) {
    std::vector<Pair> pairs;
    for (const std::vector<Pair>& near : near_) pairs.insert(pairs.end(), near.begin(), near.end());
    auto before = [](const Pair& a, const Pair& b) { return a.first != b.first ? a.first < b.first : a.second < b.second; };
    std::sort(pairs.begin(), pairs.end(), before);
    for (Pair& p : pairs) {
        const auto old = std::lower_bound(pairs_.begin(), pairs_.end(), p, before);
        if (old != pairs_.end() && !before(p, *old)) {
            p = *old;
            continue;
        }
        // an edge that has just become a crease close to another one keeps its present distance
        const Edge &a = edges_[p.first], &b = edges_[p.second];
        const Crossing c = crossing(position_of(m, a.node[0]), position_of(m, a.node[1]), position_of(m, b.node[0]), position_of(m, b.node[1]));
        if (c.inside) p.gap = std::min(p.gap, norm(c.apart));
    }
    pairs_ = std::move(pairs);
}

void EdgeContact::evaluate_all(const Motions& m, std::size_t i, double margin, FoundForces& found) {
    Pair& p = pairs_[i];
    evaluate(m, p, found);
    const Edge &a = edges_[p.first], &b = edges_[p.second];
    p.close = least_distance(position_of(m, a.node[0]), position_of(m, a.node[1]), position_of(m, b.node[0]),
                             position_of(m, b.node[1])) < p.gap + margin;
}

void EdgeContact::list_close() {
    close_.clear();
    for (std::size_t i = 0; i < pairs_.size(); i++)
        if (pairs_[i].close) close_.push_back(i);
}

void EdgeContact::evaluate(const Motions& m, Pair& p, FoundForces& found) const {
    const Edge &a = edges_[p.first], &b = edges_[p.second];
    const Vec3 a0 = position_of(m, a.node[0]), b0 = position_of(m, b.node[0]);
    const Crossing c = crossing(a0, position_of(m, a.node[1]), b0, position_of(m, b.node[1]));
    const double distance = norm(c.apart);
    if (!c.inside || !(distance < p.gap) || !(distance > 0.0)) {
        p.stick = {};
        return;
    }
    // weights of the nodes: the force acts on the first edge, its reaction on the second
    const double w[4] = {1.0 - c.s, c.s, c.t - 1.0, -c.t};
    const Index nodes[4] = {a.node[0], a.node[1], b.node[0], b.node[1]};
    double compliance = 0.0;
    Vec3 slip;
    for (std::size_t k = 0; k < 4; k++) {
        compliance += w[k] * w[k] / sheets_.mass[nodes[k]];
        slip = slip + w[k] * velocity_of(m, nodes[k]);
    }
    const ContactSettings& s = sheets_.model.contact;
    const Bond bond = bond_of(s, 1.0 / compliance, sheets_.step, s.friction);
    const Vec3 force = force_of(bond, p.gap - distance, (1.0 / distance) * c.apart, slip, m.step, p.stick);
    found.deepest = std::max(found.deepest, (p.gap - distance) / (a.half + b.half));
    for (std::size_t k = 0; k < 4; k++) found.add(nodes[k], w[k] * force);
}

void EdgeContact::save(std::vector<double>& out) const {
    out.push_back(double(pairs_.size()));
    for (const Pair& p : pairs_) out.insert(out.end(), {double(p.first), double(p.second), p.gap, p.stick.x, p.stick.y, p.stick.z});
}

void EdgeContact::restore(Saved& in) {
    pairs_.resize(in.count(6));
    for (Pair& p : pairs_) {
        p.first = Index(in.index(edges_.size()));
        p.second = Index(in.index(edges_.size()));
        p.gap = in.number();
        p.stick = in.vector();
        p.close = false;
    }
}

}  // namespace crumple::shell
