#include "shell/rigid/welds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shell/run/simulation.hpp"

namespace crumple::shell {

namespace {

// Welds that share nodes are solved by Gauss-Seidel iteration until no correction exceeds this share of the fastest node's speed;
// the remaining drift is corrected in the next step.
constexpr double settled = 1e-10;
// Limit of the iterations; neighbouring welds that share some nodes converge in about ten.
constexpr int most_turns = 50;
// Distance of two sheets [m] below which the direction across them is undefined: far above round-off, far below any thickness.
constexpr double least_distance = 1e-9;

[[noreturn]] void refuse(std::size_t i, const std::string& why) {
    throw std::invalid_argument("spot weld " + std::to_string(i) + ": " + why);
}

// Reason for each node that cannot belong to a weld, else null
std::vector<const char*> taken_nodes(const Model& m) {
    std::vector<const char*> taken(m.nodes(), nullptr);
    for (std::size_t n = 0; n < m.nodes(); n++)
        if (m.fixed[n]) taken[n] = "is held";
    for (const RigidSet& set : m.rigid_sets)
        for (Index n : set.nodes) taken[n] = "belongs to a rigid set";
    for (const Load& load : m.loads) taken[load.node] = "carries a load";
    for (const Motion& motion : m.motions)
        if (!motion.rigid) taken[motion.target] = "is driven";
    return taken;
}

}  // namespace

void check_welds(const Model& m) {
    if (m.spot_welds.empty()) return;
    const std::vector<const char*> taken = taken_nodes(m);
    for (std::size_t i = 0; i < m.spot_welds.size(); i++) {
        const SpotWeld& w = m.spot_welds[i];
        if (w.first == 0 || w.first >= w.nodes.size() || w.weight.size() != w.nodes.size()) refuse(i, "both sheets need nodes with weights");
        if (!(w.normal_strength > 0.0) || !(w.shear_strength > 0.0)) refuse(i, "its strength is not positive");
        double sum[2] = {0.0, 0.0};
        for (std::size_t k = 0; k < w.nodes.size(); k++) {
            if (w.nodes[k] >= m.nodes()) refuse(i, "node " + std::to_string(w.nodes[k]) + " does not exist");
            if (taken[w.nodes[k]]) refuse(i, "node " + std::to_string(w.nodes[k]) + " " + taken[w.nodes[k]]);
            if (std::count(w.nodes.begin(), w.nodes.end(), w.nodes[k]) > 1) refuse(i, "node " + std::to_string(w.nodes[k]) + " appears twice");
            sum[k < w.first ? 0 : 1] += w.weight[k];
        }
        if (!(std::abs(sum[0] - 1.0) < 1e-9 && std::abs(sum[1] - 1.0) < 1e-9)) refuse(i, "the weights of a sheet do not add up to 1");
    }
}

SpotWelds::SpotWelds(const Model& model, const Masses& masses) : model_(model), states_(model.spot_welds.size()) {
    for (const SpotWeld& w : model.spot_welds) nodes_.insert(nodes_.end(), w.nodes.begin(), w.nodes.end());
    std::sort(nodes_.begin(), nodes_.end());
    const std::size_t all = nodes_.size();
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    coupled_ = nodes_.size() < all;
    for (Index n : nodes_) {
        inverse_mass_.push_back(1.0 / masses.mass[n]);
        inverse_inertia_.push_back(1.0 / masses.inertia[n]);
    }
    for (std::size_t i = 0; i < model.spot_welds.size(); i++) {
        const SpotWeld& w = model.spot_welds[i];
        Tie tie{};
        Vec3 mean[2];
        for (std::size_t k = 0; k < w.nodes.size(); k++) {
            Side& side = tie.side[k < w.first ? 0 : 1];
            const std::size_t at = std::size_t(std::lower_bound(nodes_.begin(), nodes_.end(), w.nodes[k]) - nodes_.begin());
            side.at.push_back(std::uint32_t(at));
            side.weight.push_back(w.weight[k]);
            side.mobility += w.weight[k] * w.weight[k] * inverse_mass_[at];
            side.spin_mobility += w.weight[k] * w.weight[k] * inverse_inertia_[at];
            mean[k < w.first ? 0 : 1] = mean[k < w.first ? 0 : 1] + w.weight[k] * read3(&model.position[3 * w.nodes[k]]);
        }
        tie.distance = norm(mean[1] - mean[0]);
        if (!(tie.distance > least_distance)) refuse(i, "its two sheets coincide");
        ties_.push_back(std::move(tie));
    }
}

std::vector<std::uint8_t> SpotWelds::held() const {
    std::vector<std::uint8_t> out(nodes_.size(), 0);
    for (std::size_t i = 0; i < ties_.size(); i++)
        for (const Side& side : ties_[i].side)
            for (std::uint32_t at : side.at) out[at] |= !states_[i].broken;
    return out;
}

// The five equations of a tie in axes along and across the sheets, factorised.
struct SpotWelds::Frame5 {
    Vec3 r, drift;                   // vector between the sheets; velocity that corrects the drift
    Vec3 axis[3];                    // two along the sheets, the last along r
    Vec3 turn[2][5];                 // moments on each side of unit impulses
    double factor[5][5];             // Cholesky factor

    // replaces a velocity mismatch by the impulses that remove it
    void solve(double (&y)[5]) const {
        for (int i = 0; i < 5; i++) {
            for (int k = 0; k < i; k++) y[i] -= factor[i][k] * y[k];
            y[i] /= factor[i][i];
        }
        for (int i = 4; i >= 0; i--) {
            for (int k = i + 1; k < 5; k++) y[i] -= factor[k][i] * y[k];
            y[i] /= factor[i][i];
        }
    }
};

Vec3 SpotWelds::mean(const double* position, const Side& side) const {
    Vec3 sum;
    for (std::size_t k = 0; k < side.at.size(); k++)
        sum = sum + side.weight[k] * read3(position + std::size_t(position_record) * nodes_[side.at[k]]);
    return sum;
}

Vec3 SpotWelds::arm(const double* position, const Tie& tie) const { return mean(position, tie.side[1]) - mean(position, tie.side[0]); }

SpotWelds::Frame5 SpotWelds::framed(const Tie& tie, Vec3 r) const {
    Frame5 f{};
    f.r = r;
    f.axis[2] = (1.0 / norm(r)) * r;
    const Vec3 across = std::abs(f.axis[2].x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    f.axis[0] = cross(f.axis[2], across);
    f.axis[0] = (1.0 / norm(f.axis[0])) * f.axis[0];
    f.axis[1] = cross(f.axis[2], f.axis[0]);
    for (int s = 0; s < 2; s++) {
        for (int k = 0; k < 3; k++) f.turn[s][k] = -0.5 * cross(r, f.axis[k]);
        for (int k = 0; k < 2; k++) f.turn[s][3 + k] = (s ? 1.0 : -1.0) * f.axis[k];
    }
    for (int i = 0; i < 5; i++)
        for (int j = 0; j <= i; j++) {
            double sum = i == j && i < 3 ? tie.side[0].mobility + tie.side[1].mobility : 0.0;
            for (int s = 0; s < 2; s++) sum += tie.side[s].spin_mobility * dot(f.turn[s][i], f.turn[s][j]);
            for (int k = 0; k < j; k++) sum -= f.factor[i][k] * f.factor[j][k];
            f.factor[i][j] = i == j ? std::sqrt(sum) : sum / f.factor[j][j];
        }
    return f;
}

std::vector<Vec3> SpotWelds::fit(const double* position, double step, std::vector<Motion6>& motion) const {
    std::vector<Vec3> impulse(ties_.size());
    std::vector<Frame5> frames(ties_.size());
    for (std::size_t i = 0; i < ties_.size(); i++) {
        if (states_[i].broken) continue;
        frames[i] = framed(ties_[i], arm(position, ties_[i]));
        if (step > 0.0) frames[i].drift = ((norm(frames[i].r) - ties_[i].distance) / step) * frames[i].axis[2];
    }
    for (int turns = 0; turns < (coupled_ ? most_turns : 1); turns++) {
        double fastest = 0.0, worst = 0.0;
        for (std::size_t i = 0; i < ties_.size(); i++) {
            if (states_[i].broken) continue;
            const Tie& tie = ties_[i];
            const Frame5& f = frames[i];
            Motion6 mean[2];
            for (int s = 0; s < 2; s++)
                for (std::size_t k = 0; k < tie.side[s].at.size(); k++) {
                    const Motion6& m = motion[tie.side[s].at[k]];
                    mean[s].velocity = mean[s].velocity + tie.side[s].weight[k] * m.velocity;
                    mean[s].spin = mean[s].spin + tie.side[s].weight[k] * m.spin;
                }
            const Vec3 apart = mean[1].velocity - mean[0].velocity - 0.5 * cross(mean[0].spin + mean[1].spin, f.r) + f.drift;
            const Vec3 turning = mean[1].spin - mean[0].spin;
            double y[5] = {-dot(apart, f.axis[0]), -dot(apart, f.axis[1]), -dot(apart, f.axis[2]), -dot(turning, f.axis[0]), -dot(turning, f.axis[1])};
            worst = std::max(worst, norm(apart) + norm(turning - dot(turning, f.axis[2]) * f.axis[2]) * norm(f.r));
            fastest = std::max({fastest, norm(mean[0].velocity), norm(mean[1].velocity)});
            f.solve(y);
            const Vec3 push = y[0] * f.axis[0] + y[1] * f.axis[1] + y[2] * f.axis[2];
            impulse[i] = impulse[i] + push;
            for (int s = 0; s < 2; s++) {
                Vec3 turn;
                for (int k = 0; k < 5; k++) turn = turn + y[k] * f.turn[s][k];
                for (std::size_t k = 0; k < tie.side[s].at.size(); k++) {
                    const std::size_t at = tie.side[s].at[k];
                    const double w = tie.side[s].weight[k];
                    motion[at].velocity = motion[at].velocity + ((s ? w : -w) * inverse_mass_[at]) * push;
                    motion[at].spin = motion[at].spin + (w * inverse_inertia_[at]) * turn;
                }
            }
        }
        if (worst <= settled * fastest) break;
    }
    return impulse;
}

void SpotWelds::bear(const double* position, double time, double kick, const std::vector<Vec3>& impulse) {
    for (std::size_t i = 0; i < ties_.size(); i++) {
        WeldState& state = states_[i];
        if (state.broken) continue;
        const Vec3 r = arm(position, ties_[i]), across = (1.0 / norm(r)) * r, force = (1.0 / kick) * impulse[i];
        state.time = time;
        state.normal = -dot(force, across);
        state.shear = norm(force + state.normal * across);
        const double pull = std::max(state.normal, 0.0) / model_.spot_welds[i].normal_strength;
        const double slide = state.shear / model_.spot_welds[i].shear_strength, use = pull * pull + slide * slide;
        state.worst = std::max(state.worst, use);
        state.broken = use >= 1.0;
    }
}

void SpotWelds::save(std::vector<double>& out) const {
    for (const WeldState& w : states_) out.insert(out.end(), {double(w.broken), w.time, w.normal, w.shear, w.worst});
}

void SpotWelds::restore(Saved& in) {
    for (WeldState& w : states_) {
        w.broken = in.number() != 0.0;
        for (double* x : {&w.time, &w.normal, &w.shear, &w.worst}) *x = in.number();
    }
}

// Motion of the tied nodes, in the order of the welds' list.  Nodes of failed welds are skipped: other threads move them at the same
// time.
std::vector<SpotWelds::Motion6> Simulation::weld_motion() const {
    std::vector<SpotWelds::Motion6> motion(welds_->nodes().size());
    for (std::size_t i = 0; i < motion.size(); i++) {
        const Index n = welds_->nodes()[i];
        if (kind_[n] != tied_node) continue;
        motion[i] = {read3(&velocity_[velocity_record * n]), read3(&velocity_[velocity_record * n + 4])};
    }
    return motion;
}

void Simulation::set_weld_motion(const std::vector<SpotWelds::Motion6>& motion) {
    for (std::size_t i = 0; i < motion.size(); i++) {
        const Index n = welds_->nodes()[i];
        if (kind_[n] != tied_node) continue;
        write3(&velocity_[velocity_record * n], motion[i].velocity);
        write3(&velocity_[velocity_record * n + 4], motion[i].spin);
    }
}

// New velocities of the tied nodes from forces and ties, and the impulses on the second sheets of the welds.
std::vector<SpotWelds::Motion6> Simulation::kick_welds(std::vector<Vec3>& impulse) const {
    const Settings& s = model_->settings;
    const double a = 0.5 * kick() * s.damping;
    std::vector<SpotWelds::Motion6> motion = weld_motion();
    for (std::size_t i = 0; i < motion.size(); i++) {
        const Index n = welds_->nodes()[i];
        if (kind_[n] != tied_node) continue;
        const Wrench w = internal_force(n);
        const double* inverse = &inverse_mass_[velocity_record * n];
        motion[i].velocity = (1.0 / (1.0 + a)) * ((1.0 - a) * motion[i].velocity + kick() * (inverse[0] * w.force + s.gravity));
        motion[i].spin = (1.0 / (1.0 + a)) * ((1.0 - a) * motion[i].spin + (kick() * inverse[4]) * w.moment);
    }
    impulse = welds_->fit(position_.data(), dt_, motion);
    return motion;
}

void Simulation::move_welds() {
    if (welds_->nodes().empty()) return;
    std::vector<Vec3> impulse;
    const std::vector<SpotWelds::Motion6> now = kick_welds(impulse), before = weld_motion();
    // with mass damping a step transmits only 1/(1 + a) of a force's impulse
    welds_->bear(position_.data(), time_, kick() / (1.0 + 0.5 * kick() * model_->settings.damping), impulse);
    for (std::size_t i = 0; i < now.size(); i++) {
        const Index n = welds_->nodes()[i];
        if (kind_[n] != tied_node) continue;
        const Vec3 v = 0.5 * (before[i].velocity + now[i].velocity), w = 0.5 * (before[i].spin + now[i].spin);
        body_damping_ += model_->settings.damping * kick() * (masses_.mass[n] * dot(v, v) + masses_.inertia[n] * dot(w, w));
        add3(&position_[position_record * n], dt_ * now[i].velocity);
    }
    set_weld_motion(now);
}

// Kinetic energy of the tied nodes, computed as for free nodes.
double Simulation::kinetic_of_welds() const {
    if (!welds_ || welds_->nodes().empty()) return 0.0;
    std::vector<Vec3> impulse;
    const std::vector<SpotWelds::Motion6> now = kick_welds(impulse), before = weld_motion();
    double sum = 0.0;
    for (std::size_t i = 0; i < now.size(); i++) {
        const Index n = welds_->nodes()[i];
        if (kind_[n] != tied_node) continue;
        sum += 0.5 * (masses_.mass[n] * dot(before[i].velocity, now[i].velocity) + masses_.inertia[n] * dot(before[i].spin, now[i].spin));
    }
    return sum;
}

// Makes the nodes of failed welds free; called by one thread only.
void Simulation::sort_welds() {
    const std::vector<std::uint8_t> held = welds_->held();
    for (std::size_t i = 0; i < held.size(); i++) kind_[welds_->nodes()[i]] = held[i] ? tied_node : 0;
}

// Makes given velocities compatible with the ties.
void Simulation::fit_welds() {
    std::vector<SpotWelds::Motion6> motion = weld_motion();
    welds_->fit(position_.data(), 0.0, motion);
    set_weld_motion(motion);
}

}  // namespace crumple::shell
