#include "shell/contact/wall_contact.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::shell {

namespace {

// Largest number of elements with which a node can be in contact at once; further ones are ignored.
constexpr std::size_t most_hits = 24;
// Distance returned for elements beyond gap and margin.
constexpr double beyond = 1e300;

// Elements of `near` that are connected to the node: its own elements, and from there all that share a node.
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

// Bounding sphere: centre of an element and the square of the largest distance of a corner from it.
struct Ball {
    Vec3 centre;
    double square;
    // Whether a point at the squared distance `away` from the centre is closer to the sphere than `gap`; the most frequent test,
    // therefore without a square root.
    bool within(double away, double gap) const {
        const double d = away - square - gap * gap;
        return d < 0.0 || d * d < 4.0 * square * gap * gap;
    }
};

inline Ball ball_around(const Vec3 (&x)[4]) {
    Ball b{0.25 * ((x[0] + x[1]) + (x[2] + x[3])), 0.0};
    for (const Vec3& corner : x) b.square = std::max(b.square, dot(corner - b.centre, corner - b.centre));
    return b;
}

// Stable sort by node.
template <class Near> std::vector<Near> by_node(const std::vector<std::vector<Near>>& lists, std::size_t nodes) {
    std::vector<std::size_t> next(nodes + 1, 0);
    for (const std::vector<Near>& list : lists)
        for (const Near& a : list) next[a.node + 1]++;
    for (std::size_t n = 0; n < nodes; n++) next[n + 1] += next[n];
    std::vector<Near> out(next.back());
    for (const std::vector<Near>& list : lists)
        for (const Near& a : list) out[next[a.node]++] = a;
    return out;
}

}  // namespace

WallContact::WallContact(const Sheets& sheets) : sheets_(sheets), stick_(2 * sheets.model.nodes()) {
    for (double t : sheets.model.thickness) reach_ = std::max(reach_, t);
    if (sheets.model.contact.gap > 0.0) reach_ = sheets.model.contact.gap;
    for (std::size_t e = 0; e < sheets.model.elements(); e++)
        span_ += std::sqrt(area_of(sheets.model, e)) / double(sheets.model.elements());
    list_neighbours();
}

double WallContact::gap(Index n, Index e) const {
    const double given = sheets_.model.contact.gap;
    return given > 0.0 ? given : sheets_.half[n] + sheets_.half_of(e);
}

// Lists pairs that never have contact: those of the same piece of sheet, and those that overlap at the start (walls joined on
// purpose).
void WallContact::list_neighbours() {
    const Model& model = sheets_.model;
    const double* x0 = model.position.data();
    const double far = neighbourhood * reach_;
    const PointGrid grid(x0, 3, model.nodes(), 0.5 * span_ + far);
    std::vector<std::vector<Near>> found(1);
    for (Index e = 0; e < model.elements(); e++) {
        Vec3 x[4];
        sheets_.corners(x0, 3, e, x);
        grid.each_in(box_around<4>(x0, 3, &model.quads[4 * e], far), [&](Index n) {
            const double distance = closest_on_quad(read3(x0 + 3 * n), x).distance;
            // the third number is 1 if they overlap
            if (distance < neighbourhood * gap(n, e)) found[0].push_back({n, e, std::int8_t(distance < (1.0 - 1e-6) * gap(n, e))});
        });
    }
    const std::vector<Near> pairs = by_node(found, model.nodes());
    neighbour_first_.assign(model.nodes() + 1, 0);
    auto pair = pairs.begin();
    for (Index n = 0; n < model.nodes(); n++) {
        std::vector<Index> near, overlapping;
        for (; pair != pairs.end() && pair->node == n; ++pair) {
            near.push_back(pair->element);
            if (pair->side) overlapping.push_back(pair->element);
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

void WallContact::start_search(const Motions& m, double skin, int members) {
    far_ = reach_ + skin;
    grid_ = PointGrid(m.position, position_record, sheets_.model.nodes(), 0.5 * span_ + far_);
    near_.resize(std::size_t(members));
}

void WallContact::search(const Motions& m, const std::vector<std::uint8_t>& alive, Range elements, const Member& member) {
    std::vector<Near>& near = near_[std::size_t(member.index)];
    near.clear();
    for (Index e = Index(elements.first); e < elements.last; e++) {
        if (!alive[e]) continue;
        Vec3 x[4];
        sheets_.corners(m.position, position_record, e, x);
        const Ball ball = ball_around(x);
        grid_.each_in(box_around<4>(m.position, position_record, &sheets_.model.quads[4 * e], far_), [&](Index n) {
            const Vec3 p = position_of(m, n), away = p - ball.centre;
            if (!ball.within(dot(away, away), far_)) return;
            if (!(sheets_.half[n] > 0.0) || neighbour(n, e) || closest_on_quad(p, x).distance > far_) return;
            near.push_back({n, e, side_so_far(n, e)});
        });
    }
}

// A known pair keeps its side, even if the node has been pressed through the element.
std::int8_t WallContact::side_so_far(Index n, Index e) const {
    const auto at = std::lower_bound(listed_.begin(), listed_.end(), n);
    if (at == listed_.end() || *at != n) return 0;
    const std::size_t i = std::size_t(at - listed_.begin());
    for (std::size_t k = candidate_first_[i]; k < candidate_first_[i + 1]; k++)
        if (candidates_[k].element == e) return candidates_[k].side;
    return 0;
}

void WallContact::end_search() {
    const std::vector<Index> before = std::move(listed_);
    listed_.clear();
    candidate_first_.assign(1, 0);
    candidates_.clear();
    for (const Near& a : by_node(near_, sheets_.model.nodes())) {
        if (listed_.empty() || listed_.back() != a.node) {
            listed_.push_back(a.node);
            candidate_first_.push_back(candidates_.size());
        }
        candidates_.push_back({a.element, a.side});
        candidate_first_.back() = candidates_.size();
    }
    is_close_.assign(candidates_.size(), 0);
    // a node without candidates has no friction force
    for (Index n : before)
        if (!std::binary_search(listed_.begin(), listed_.end(), n)) stick_[2 * n] = stick_[2 * n + 1] = {};
}

struct WallContact::Hits {
    Hit hit[most_hits];
    std::size_t count = 0;
};

// Distance of the node from the element, `beyond` if it is larger than the gap plus `margin`; adds a contact to `hits`.
// The node is held on the side on which it first lies over the interior of the element; outside the element's border there is no side.
double WallContact::approach(const Motions& m, Index n, Candidate& c, double margin, Hits& hits) const {
    const Vec3 p = position_of(m, n);
    const double g = gap(n, c.element), far = g + margin;
    Vec3 x[4];
    sheets_.corners(m.position, position_record, c.element, x);
    // reject by the bounding slab and the bounding sphere of the element
    const Ball ball = ball_around(x);
    const Vec3 away = p - ball.centre, across = cross(x[2] - x[0], x[3] - x[1]);
    // height above the slab that contains the warped element, times the length of `across`
    const double high = std::abs(dot(away, across)) - std::abs(dot(x[0] - ball.centre, across));
    const bool near = (high < 0.0 || high * high < far * far * dot(across, across)) && ball.within(dot(away, away), far);
    const Closest q = near ? closest_on_quad(p, x) : Closest{};
    if (!near || q.distance >= g) {
        c.side = 0;
        return near ? q.distance : beyond;
    }
    if (hits.count == most_hits) return q.distance;
    const Vec3 d = p - q.point;
    if (!q.inside) c.side = 0;
    else if (c.side == 0) c.side = dot(d, across) >= 0.0 ? 1 : -1;
    const Vec3 normal = (double(c.side) / norm(across)) * across;
    const bool through = dot(d, normal) < 0.0, on_it = q.distance < 1e-9 * g;
    hits.hit[hits.count++] = {q, through || (on_it && q.inside) ? normal : (1.0 / std::max(q.distance, 1e-9 * g)) * d, g,
                              g - (through ? -q.distance : q.distance), c.element};
    return q.distance;
}

// Applies the force to the node and its reaction to the corners, distributed by their weights.
void WallContact::touch(const Motions& m, Index n, const Hit& hit, Vec3& stick, FoundForces& found) const {
    const Index* corners = &sheets_.model.quads[4 * hit.element];
    double compliance = 1.0 / sheets_.mass[n];
    Vec3 slip = velocity_of(m, n);
    for (std::size_t c = 0; c < 4; c++) {
        const double w = hit.at.weight[c];
        compliance += w * w / sheets_.mass[corners[c]];
        slip = slip - w * velocity_of(m, corners[c]);
    }
    const ContactSettings& s = sheets_.model.contact;
    const Vec3 force = force_of(bond_of(s, 1.0 / compliance, sheets_.step, s.friction), hit.depth, hit.direction, slip, m.step, stick);
    found.deepest = std::max(found.deepest, hit.depth / hit.gap);
    found.add(n, force);
    for (std::size_t c = 0; c < 4; c++)
        if (hit.at.weight[c] != 0.0) found.add(corners[c], (-hit.at.weight[c]) * force);
}

// Contact forces from the closest element and from the closest element on the node's other side.
void WallContact::answer(const Motions& m, Index n, const Hits& hits, FoundForces& found) {
    const Hit *first = nullptr, *second = nullptr, *end = hits.hit + hits.count;
    for (const Hit* h = hits.hit; h != end; h++)
        if (!first || h->at.distance < first->at.distance) first = h;
    for (const Hit* h = hits.hit; h != end; h++)
        if (dot(h->direction, first->direction) < 0.0 && (!second || h->at.distance < second->at.distance)) second = h;
    const Hit* chosen[2] = {first, second};
    for (std::size_t k = 0; k < 2; k++) {
        Vec3& stick = stick_[2 * n + k];
        if (chosen[k])
            touch(m, n, *chosen[k], stick, found);
        else
            stick = {};
    }
}

void WallContact::evaluate_all(const Motions& m, std::size_t i, double margin, FoundForces& found) {
    const Index n = listed_[i];
    Hits hits;
    for (std::size_t k = candidate_first_[i]; k < candidate_first_[i + 1]; k++)
        is_close_[k] = approach(m, n, candidates_[k], margin, hits) < gap(n, candidates_[k].element) + margin;
    answer(m, n, hits, found);
}

void WallContact::evaluate_close(const Motions& m, std::size_t i, FoundForces& found) {
    const Index n = close_nodes_[i];
    Hits hits;
    for (std::size_t k = close_first_[i]; k < close_first_[i + 1]; k++) approach(m, n, candidates_[close_[k]], 0.0, hits);
    answer(m, n, hits, found);
}

void WallContact::list_close() {
    close_nodes_.clear();
    close_first_.assign(1, 0);
    close_.clear();
    for (std::size_t i = 0; i < listed_.size(); i++) {
        for (std::size_t k = candidate_first_[i]; k < candidate_first_[i + 1]; k++)
            if (is_close_[k]) close_.push_back(k);
        if (close_.size() == close_first_.back()) continue;
        close_nodes_.push_back(listed_[i]);
        close_first_.push_back(close_.size());
    }
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

void WallContact::restore(Saved& in) {
    const std::size_t elements = sheets_.model.elements();
    listed_.resize(in.count(8));
    candidates_.resize(in.count(2));
    is_close_.assign(candidates_.size(), 0);
    candidate_first_.assign(listed_.size() + 1, 0);
    stick_.assign(stick_.size(), Vec3{});
    for (std::size_t i = 0; i < listed_.size(); i++) {
        listed_[i] = Index(in.index(stick_.size() / 2));
        candidate_first_[i + 1] = in.index(candidates_.size() + 1);
        if (candidate_first_[i + 1] < candidate_first_[i]) throw std::invalid_argument("the lists of contact are damaged");
        for (std::size_t k = 0; k < 2; k++) stick_[2 * listed_[i] + k] = in.vector();
    }
    for (Candidate& c : candidates_) {
        c.element = Index(in.index(elements));
        c.side = std::int8_t(in.whole(-1, 3));
    }
}

}  // namespace crumple::shell
