#include "shell/contact/contact.hpp"

#include <algorithm>

namespace crumple::shell {

namespace {

// Number of steps between comparisons of the positions with those of the last search ...
constexpr std::size_t check_every = 10;
// ... a search is due when a node has moved by this share of the search margin; two nodes approach each other by at most twice that.
constexpr double moved_share = 0.35;
// Most candidates listed by a search are too far away for contact in the next steps.  Candidates closer than the gap plus this share
// of the search margin are checked in every step; all candidates are checked when a node has moved by half this share, so that no
// contact is missed or late.  A larger share means fewer checks of all candidates but a longer list of close ones.
constexpr double close_share = 0.1;
// Items that a thread takes at a time: a few microseconds of work.
constexpr std::size_t items_at_once = 16;
// Share of half its wall's thickness that a node around a spot weld keeps as distance.  The weld keeps the mean distance of these
// nodes; if contact acted at each of them too, it would push against the weld and increase the weld's reported force.
constexpr double welded_share = 0.5;

}  // namespace

Sheets::Sheets(const Model& m, const Masses& masses, double dt) : model(m), mass(masses.mass), half(m.nodes(), 0.0), step(dt) {
    std::vector<int> sharing(m.nodes(), 0);
    for (std::size_t e = 0; e < m.elements(); e++)
        for (std::size_t c = 0; c < 4; c++) {
            half[m.quads[4 * e + c]] += half_of(e);
            sharing[m.quads[4 * e + c]]++;
        }
    for (std::size_t n = 0; n < m.nodes(); n++) half[n] /= std::max(sharing[n], 1);
    std::vector<Index> welded;
    for (const SpotWeld& weld : m.spot_welds) welded.insert(welded.end(), weld.nodes.begin(), weld.nodes.end());
    std::sort(welded.begin(), welded.end());
    welded.erase(std::unique(welded.begin(), welded.end()), welded.end());
    for (Index n : welded) half[n] *= welded_share;
}

void NodeForces::save(std::vector<double>& out) const {
    out.push_back(double(touched()));
    for (const std::vector<Index>& chunk : touched_)
        for (Index n : chunk) out.insert(out.end(), {double(n), force_[4 * n], force_[4 * n + 1], force_[4 * n + 2]});
}

void NodeForces::restore(Saved& in) {
    clear({0, chunks()});
    for (std::size_t count = in.count(4); count > 0; count--) {
        const Index node = Index(in.index(force_.size() / 4));
        add(node, in.vector());
    }
}

Contact::Contact(const Model& model, const Masses& masses, double step) : sheets_(model, masses, step), obstacles_(sheets_) {
    if (model.contact.on) {
        walls_ = std::make_unique<WallContact>(sheets_);
        edges_ = std::make_unique<EdgeContact>(sheets_, *walls_);
    }
    if (!any()) return;
    now_ = NodeForces(model.nodes());
    before_ = NodeForces(model.nodes());
    power_.assign(now_.chunks(), 0.0);
    searched_at_.assign(3 * model.nodes(), 0.0);
    // not larger than the neighbourhood, or every node would list the rest of its own wall as candidates
    const double thickest = *std::max_element(model.thickness.begin(), model.thickness.end());
    skin_ = (WallContact::neighbourhood - 1.0) * (walls_ ? walls_->reach() : thickest);
    margin_ = close_share * skin_;
    if (walls_) seen_.assign(position_record * model.nodes(), 0.0);
}

bool Contact::moved_far(const Motions& m, Range nodes) const {
    const double limit = moved_share * skin_;
    for (std::size_t n = nodes.first; n < nodes.last; n++) {
        const Vec3 d = position_of(m, n) - read3(&searched_at_[3 * n]);
        if (!(dot(d, d) < limit * limit)) return true;
    }
    return false;
}

void Contact::search(const Motions& m, const std::vector<std::uint8_t>& alive, const Member& member) {
    if (!any()) return;
    const Range nodes = member.share(sheets_.model.nodes()), elements = member.share(sheets_.model.elements());
    for (std::size_t n = nodes.first; n < nodes.last; n++) write3(&searched_at_[3 * n], position_of(m, n));
    if (walls_) {
        edges_->turn(m, elements);
        member.meet([&] { walls_->start_search(m, skin_, member.count); });
        walls_->search(m, alive, elements, member);
        edges_->find_creases(alive, member);
        member.meet([&] {
            walls_->end_search();
            edges_->start_search(m, skin_, member.count);
        });
        edges_->search(m, member);
    }
    member.meet([&] {
        if (walls_) edges_->end_search(m);
        obstacles_.search(m, skin_);
        all_ = true;
        searches_++;
        due_ = false;
    });
}

void Contact::prepare(double way2) {
    all_ |= !(way2 < 0.25 * margin_ * margin_);
    chunks_ = (items() + items_at_once - 1) / items_at_once;
    if (found_.size() < chunks_) found_.resize(chunks_);
    next_.store(0, std::memory_order_relaxed);
}

void Contact::evaluate(const Motions& m, const Member& member) {
    const std::size_t walls = wall_items(), edges = walls + edge_items(), all = edges + obstacles_.items();
    for (std::size_t k; (k = next_.fetch_add(1, std::memory_order_relaxed)) < chunks_;) {
        FoundForces& found = found_[k];
        found.clear(sheets_.model.nodes(), member.count);
        for (std::size_t i = items_at_once * k; i < std::min(all, items_at_once * (k + 1)); i++) {
            if (i < walls)
                all_ ? walls_->evaluate_all(m, i, margin_, found) : walls_->evaluate_close(m, i, found);
            else if (i < edges)
                all_ ? edges_->evaluate_all(m, i - walls, margin_, found) : edges_->evaluate_close(m, i - walls, found);
            else
                obstacles_.evaluate(m, i - edges);
        }
    }
    if (!all_ || !walls_) return;
    const Range nodes = member.share(sheets_.model.nodes());
    std::copy_n(m.position + position_record * nodes.first, position_record * (nodes.last - nodes.first), &seen_[position_record * nodes.first]);
}

void Contact::turn_over(const Motions& m) {
    std::swap(now_, before_);
    obstacles_.commit(m, now_);  // each obstacle keeps its own depth
}

void Contact::sum(const Motions& m, const Member& member) {
    const Range chunks = member.share(now_.chunks());
    for (std::size_t k = 0; k < chunks_; k++)
        for (const FoundForces::Found& f : found_[k].of(member)) now_.add(f.node, f.force);
    for (std::size_t c = chunks.first; c < chunks.last; c++) power_[c] = now_.power(m, c) + before_.power(m, c);
    before_.clear(chunks);
    const bool look = (checks_ + 1) % check_every == 0;
    if (look && moved_far(m, member.share(sheets_.model.nodes()))) moved_.store(true, std::memory_order_relaxed);
}

void Contact::commit(double last_dt) {
    for (std::size_t k = 0; k < chunks_; k++) deepest_ = std::max(deepest_, found_[k].deepest);
    double power = obstacles_.power(false) + obstacles_.power(true);
    for (double p : power_) power += p;
    // work done against contact over the last step, by the mean of the forces at its start and end
    work_ -= 0.5 * last_dt * power;
    obstacles_.book(last_dt);
    due_ = ++checks_ % check_every == 0 && (moved_ || !(obstacles_.moved() < moved_share * skin_));
    moved_ = false;
    if (walls_ && all_) {
        walls_->list_close();
        edges_->list_close();
    }
    all_ = false;
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
    constexpr std::size_t most = std::size_t(1) << 53;
    Saved in(saved);
    work_ = in.number();
    deepest_ = in.number();
    searches_ = in.index(most);
    checks_ = in.index(most);
    if (in.count(1) != searched_at_.size()) throw std::invalid_argument("the checkpoint is that of another contact");
    in.copy(searched_at_);
    now_.restore(in);
    if (walls_) {
        walls_->restore(in);
        edges_->restore(in);
    }
    obstacles_.restore(in);
    in.finish();
    all_ = true;
}

}  // namespace crumple::shell
