#include "contact.hpp"

#include <algorithm>

namespace crumple::shell {

namespace {

// Positions are compared with those of the last search once in so many steps ...
constexpr std::size_t check_every = 10;
// ... and a search is due when a node has moved by this share of the margin; two nodes approach at most twice as fast.
constexpr double moved_share = 0.35;

}  // namespace

Sheets::Sheets(const Model& m, const Masses& masses, double dt) : model(m), mass(masses.mass), half(m.nodes(), 0.0), step(dt) {
    std::vector<int> sharing(m.nodes(), 0);
    for (std::size_t e = 0; e < m.elements(); e++)
        for (std::size_t c = 0; c < 4; c++) {
            half[m.quads[4 * e + c]] += half_of(e);
            sharing[m.quads[4 * e + c]]++;
        }
    for (std::size_t n = 0; n < m.nodes(); n++) half[n] /= std::max(sharing[n], 1);
}

void NodeForces::save(std::vector<double>& out) const {
    out.push_back(double(touched_.size()));
    for (Index n : touched_) out.insert(out.end(), {double(n), force_[4 * n], force_[4 * n + 1], force_[4 * n + 2]});
}

void NodeForces::restore(const double*& in) {
    clear();
    std::size_t count = std::size_t(*in++);
    for (; count > 0; count--, in += 4) add(Index(in[0]), read3(in + 1));
}

Contact::Contact(const Model& model, const Masses& masses, double step) : sheets_(model, masses, step), obstacles_(sheets_) {
    if (model.contact.on) {
        walls_ = std::make_unique<WallContact>(sheets_);
        edges_ = std::make_unique<EdgeContact>(sheets_, *walls_);
    }
    if (!any()) return;
    now_ = NodeForces(model.nodes());
    before_ = NodeForces(model.nodes());
    // not beyond the neighbourhood, else every node would list the rest of its own wall
    const double thickest = *std::max_element(model.thickness.begin(), model.thickness.end());
    skin_ = (WallContact::neighbourhood - 1.0) * (walls_ ? walls_->reach() : thickest);
}

bool Contact::moved_far(const Motions& m) const {
    if (searched_at_.empty()) return true;
    const double limit = moved_share * skin_;
    for (std::size_t n = 0; n < sheets_.model.nodes(); n++) {
        const Vec3 d = position_of(m, n) - read3(&searched_at_[3 * n]);
        if (!(dot(d, d) < limit * limit)) return true;
    }
    return !(obstacles_.moved() < limit);
}

void Contact::search_when_needed(const Motions& m, const std::vector<std::uint8_t>& alive, bool force) {
    if (!any()) return;
    if (!force && (++checks_ % check_every != 0 || !moved_far(m))) return;
    searches_++;
    searched_at_.resize(3 * sheets_.model.nodes());
    for (std::size_t n = 0; n < sheets_.model.nodes(); n++) write3(&searched_at_[3 * n], position_of(m, n));
    if (walls_) {
        walls_->search(m, alive, skin_);
        edges_->search(m, alive, skin_);
    }
    obstacles_.search(m, skin_);
}

void Contact::evaluate(const Motions& m, std::size_t first, std::size_t last) {
    const std::size_t walls = wall_items(), edges = walls + edge_items();
    for (std::size_t i = first; i < last; i++) {
        if (i < walls)
            walls_->evaluate(m, i);
        else if (i < edges)
            edges_->evaluate(m, i - walls);
        else
            obstacles_.evaluate(m, i - edges);
    }
}

void Contact::commit(const Motions& m, double last_dt) {
    std::swap(now_, before_);
    now_.clear();
    if (walls_) deepest_ = std::max({deepest_, walls_->commit(now_), edges_->commit(now_)});
    obstacles_.commit(m, now_);  // each obstacle keeps its own depth
    // work done against contact over the last step, by the mean of the forces at both ends
    work_ -= 0.5 * last_dt * (now_.power(m) + before_.power(m) + obstacles_.power(false) + obstacles_.power(true));
    obstacles_.book(last_dt);
}

std::vector<double> Contact::save() const {
    std::vector<double> out{work_, deepest_, double(searches_), double(checks_), double(searched_at_.size())};
    out.insert(out.end(), searched_at_.begin(), searched_at_.end());
    now_.save(out);
    if (walls_) {
        walls_->save(out);
        edges_->save(out);
    }
    obstacles_.save(out);
    return out;
}

void Contact::restore(const std::vector<double>& saved) {
    work_ = saved[0];
    deepest_ = saved[1];
    searches_ = std::size_t(saved[2]);
    checks_ = std::size_t(saved[3]);
    const double* in = saved.data() + 5;
    searched_at_.assign(in, in + std::size_t(saved[4]));
    in += std::size_t(saved[4]);
    now_.restore(in);
    if (walls_) {
        walls_->restore(in);
        edges_->restore(in);
    }
    obstacles_.restore(in);
}

}  // namespace crumple::shell
