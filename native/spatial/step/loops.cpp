#include "spatial/step/loops.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Remaining length of a row of H below which it depends on others: the remainder of independent rows is at least 1e-4 if hinges
// have been moved off dead centres; rounding is about 1e-15.
constexpr double dependent = 1e-9;
// Rotation [rad] of a body after which the rows are chosen again: up to it the worst row kept loses 1 - cos of this angle.
constexpr double fresh = 0.1;

size_t at(int i) { return static_cast<size_t>(i); }

// Scalar product in eight partial sums, to hide the latency of additions.
double product(const double* a, const double* b, size_t n) {
    double part[8] = {};
    size_t k = 0;
    for (; k + 8 <= n; k += 8) {
        for (size_t i = 0; i < 8; i++) part[i] += a[k + i] * b[k + i];
    }
    for (; k < n; k++) part[k % 8] += a[k] * b[k];
    return ((part[0] + part[4]) + (part[1] + part[5])) + ((part[2] + part[6]) + (part[3] + part[7]));
}

// Subtracts from a row its component along a unit vector; returns that component.
double project(double* row, const double* along, size_t n) {
    const double part = product(row, along, n);
    if (part == 0) return 0;
    for (size_t k = 0; k < n; k++) row[k] -= part * along[k];
    return part;
}

}  // namespace

Loops::Loops(const Model& model) : model_(model), branch_(model.bodies.size()) {
    std::vector<std::vector<int>> around(model.bodies.size() + 1);
    const auto node = [&](int body) { return body < 0 ? model.bodies.size() : at(body); };
    for (size_t j = 0; j < model.joints.size(); j++) {
        if (model.joints[j].held == 0) continue;
        for (const int body : model.joints[j].body) around[node(body)].push_back(static_cast<int>(j));
    }
    std::vector<char> reached(model.bodies.size() + 1, 0), used(model.joints.size(), 0);
    for (size_t start = model.bodies.size() + 1; start-- > 0;) {
        if (reached[start]) continue;
        reached[start] = 1;
        std::vector<size_t> queue{start};
        for (size_t q = 0; q < queue.size(); q++) {
            for (const int j : around[queue[q]]) {
                const Joint& joint = model.joints[at(j)];
                const bool ahead = node(joint.body[0]) == queue[q];
                const int outer = joint.body[ahead ? 1 : 0];
                if (reached[node(outer)]) continue;
                reached[node(outer)] = used[at(j)] = 1;
                const int inner = joint.body[ahead ? 0 : 1];
                branch_[at(outer)] = {inner, j, ahead ? 1.0 : -1.0, inner < 0 ? 1 : branch_[at(inner)].depth + 1};
                queue.push_back(at(outer));
            }
        }
    }
    size_t rows = 0;
    for (size_t j = 0; j < model.joints.size(); j++) {
        first_.push_back(rows);
        column_.push_back(columns_);
        rows += at(model.joints[j].held);
        if (used[j]) columns_ += at(6 - model.joints[j].held);
        else if (model.joints[j].held > 0) closing_.push_back(j);
    }
    redundant_.assign(rows, 0);
    part_.resize(columns_);
}

bool Loops::find(const std::vector<JointGeometry>& geometry, const std::vector<Pose>& pose) {
    if (closing_.empty()) return false;
    bool near = !found_at_.empty();
    for (size_t i = 0; near && i < pose.size(); i++) near = angle_between(pose[i].q, found_at_[i].q) < fresh;
    if (near) return false;
    found_at_ = pose;
    for (const Branch& b : branch_) {
        if (b.joint >= 0) free_parts(at(b.joint), geometry[at(b.joint)]);
    }
    place_.clear();
    for (const size_t j : closing_) {
        for (int r = 0; r < model_.joints[j].held; r++) place_.push_back(first_[j] + at(r));
    }
    matrix_.assign(place_.size() * columns_, 0.0);
    double* row = matrix_.data();
    for (const size_t j : closing_) {
        for (int r = 0; r < model_.joints[j].held; r++, row += columns_) equation(j, geometry[j], r, row);
    }
    choose(place_.size());
    return true;
}

// Relative motions that a joint leaves free: along and about the directions perpendicular to its held ones.
void Loops::free_parts(size_t j, const JointGeometry& g) {
    const Joint& joint = model_.joints[j];
    Vec3 held[2][3];
    int count[2] = {0, 0};
    for (int r = 0; r < joint.held; r++) {
        const int turns = joint.freedom[r] < 3 ? 0 : 1;
        held[turns][count[turns]++] = turns ? g.row[r].mb : g.row[r].t;
    }
    size_t k = column_[j];
    for (int turns = 0; turns < 2; turns++) {
        const Vec3* h = held[turns];
        Vec3 free[3] = {g.axes[0], g.axes[1], g.axes[2]};
        if (count[turns] == 1) {
            tangents(h[0], free[0], free[1]);
        } else if (count[turns] == 2) {
            const Vec3 across = cross(h[0], h[1]);
            free[0] = (1 / norm(across)) * across;
        }
        for (int i = 0; i < 3 - count[turns]; i++) part_[k++] = {turns ? Twist{free[i], {}} : Twist{{}, model_.length * free[i]}, g.point};
    }
}

// Coefficients of a held row: its rate for the motions of the tree's joints on the paths from both bodies to the root.
void Loops::equation(size_t j, const JointGeometry& g, int r, double* out) const {
    const Joint& joint = model_.joints[j];
    const bool turns = joint.freedom[r] >= 3;
    const Vec3 direction = turns ? g.row[r].mb : (1 / model_.length) * g.row[r].t;
    int body[2] = {joint.body[0], joint.body[1]};
    const auto depth = [&](int i) { return i < 0 ? 0 : branch_[at(i)].depth; };
    const auto climb = [&](int& i, double sense) {
        const Branch& b = branch_[at(i)];
        const size_t first = column_[at(b.joint)];
        for (size_t k = first; k < first + at(6 - model_.joints[at(b.joint)].held); k++) {
            const Twist& t = part_[k].twist;
            out[k] = sense * b.sign * dot(direction, turns ? t.w : t.v + cross(t.w, g.point - part_[k].point));
        }
        i = b.parent;
    };
    while (body[0] != body[1]) {
        const int lower = depth(body[1]) >= depth(body[0]) ? 1 : 0;
        climb(body[lower], lower ? 1 : -1);
    }
}

// Gram-Schmidt orthogonalisation, largest remaining row first; a row whose length falls below half is orthogonalised again.
void Loops::choose(size_t rows) {
    const auto row = [&](size_t i) { return matrix_.data() + i * columns_; };
    std::vector<size_t> left(rows);
    // squared lengths as updated by projections, and as last computed from the row itself
    std::vector<double> length(rows), summed(rows);
    for (size_t i = 0; i < rows; i++) {
        left[i] = i;
        length[i] = summed[i] = product(row(i), row(i), columns_);
    }
    for (const size_t place : place_) redundant_[place] = 1;
    while (!left.empty()) {
        // of rows that are equal up to rounding choose the first
        size_t best = 0;
        for (size_t i = 1; i < left.size(); i++) {
            if (length[left[i]] > length[left[best]] * (1 + dependent)) best = i;
        }
        const double largest = length[left[best]];
        if (!(largest > dependent * dependent)) return;
        double* chosen = row(left[best]);
        redundant_[place_[left[best]]] = 0;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
        const double scale = 1 / std::sqrt(largest);
        for (size_t k = 0; k < columns_; k++) chosen[k] *= scale;
        for (const size_t i : left) {
            const double along = project(row(i), chosen, columns_);
            length[i] -= along * along;
            if (length[i] > 0.25 * summed[i]) continue;
            project(row(i), chosen, columns_);
            length[i] = summed[i] = product(row(i), row(i), columns_);
        }
    }
}

}  // namespace crumple::spatial
