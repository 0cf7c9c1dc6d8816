#include "shell/run/model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shell/rigid/welds.hpp"

namespace crumple::shell {

double Curve::at(double t) const {
    if (t <= time.front()) return value.front();
    if (t >= time.back()) return value.back();
    const std::size_t i = std::size_t(std::upper_bound(time.begin(), time.end(), t) - time.begin());
    const double share = (t - time[i - 1]) / (time[i] - time[i - 1]);
    return value[i - 1] + share * (value[i] - value[i - 1]);
}

static Vec3 corner(const Model& m, std::size_t e, int c) { return read3(&m.position[3 * m.quads[4 * e + c]]); }

double area_of(const Model& m, std::size_t e) {
    return 0.5 * norm(cross(corner(m, e, 2) - corner(m, e, 0), corner(m, e, 3) - corner(m, e, 1)));
}

[[noreturn]] static void refuse(const char* what, std::size_t i, const std::string& why) {
    throw std::invalid_argument(std::string(what) + " " + std::to_string(i) + ": " + why);
}

// the triangle at every corner must have the orientation of the element's normal
static void check_shape(const Model& m, std::size_t e) {
    const int corners = m.triangle(e) ? 3 : 4;
    for (int a = 0; a < corners; a++)
        for (int b = a + 1; b < corners; b++)
            if (m.quads[4 * e + a] == m.quads[4 * e + b])
                refuse("element", e, "node " + std::to_string(m.quads[4 * e + a]) + " appears twice");
    const Vec3 normal = cross(corner(m, e, 2) - corner(m, e, 0), corner(m, e, 3) - corner(m, e, 1));
    double longest = 0.0;
    for (int c = 0; c < corners; c++) longest = std::max(longest, norm(corner(m, e, (c + 1) % corners) - corner(m, e, c)));
    if (!(norm(normal) > 1e-6 * longest * longest)) refuse("element", e, "it has no area");
    for (int c = 0; c < corners; c++)
        if (!(norm(corner(m, e, (c + 1) % corners) - corner(m, e, c)) > 1e-6 * longest))
            refuse("element", e, "corners " + std::to_string(c + 1) + " and " + std::to_string((c + 1) % corners + 1) + " coincide");
    for (int c = 0; c < corners; c++) {
        const Vec3 next = corner(m, e, (c + 1) % corners) - corner(m, e, c);
        const Vec3 last = corner(m, e, (c + corners - 1) % corners) - corner(m, e, c);
        if (!(dot(cross(next, last), normal) > 0.0))
            refuse("element", e, "it is crossed or not convex at corner " + std::to_string(c + 1));
    }
}

static void check_elements(const Model& m) {
    for (std::size_t e = 0; e < m.elements(); e++) {
        for (int c = 0; c < 4; c++)
            if (m.quads[4 * e + c] >= m.nodes()) refuse("element", e, "node " + std::to_string(m.quads[4 * e + c]) + " does not exist");
        if (!(m.thickness[e] > 0.0)) refuse("element", e, "its thickness is not positive");
        if (m.sheet_of[e] >= m.sheets.size()) refuse("element", e, "its part does not exist");
        check_shape(m, e);
    }
}

static void check_materials(const Model& m) {
    for (std::size_t i = 0; i < m.materials.size(); i++) {
        const Material& a = m.materials[i];
        if (!(a.density > 0.0)) refuse("material", i, "its density is not positive");
        if (!(a.youngs_modulus > 0.0)) refuse("material", i, "its Young's modulus is not positive");
        if (!(a.rate_time >= 0.0)) refuse("material", i, "the smoothing time of its strain rate is negative");
        if (!(a.poissons_ratio > -1.0 && a.poissons_ratio <= 0.5)) refuse("material", i, "Poisson's ratio lies outside (-1, 0.5]");
        for (std::size_t k = 0; k < a.yield_stress.size(); k++) {
            if (!(a.yield_stress[k] > 0.0)) refuse("material", i, "a yield stress is not positive");
            if (k && !(a.plastic_strain[k] > a.plastic_strain[k - 1])) refuse("material", i, "plastic strains do not increase");
            if (k && a.yield_stress[k] < a.yield_stress[k - 1]) refuse("material", i, "the hardening table softens");
        }
    }
    for (std::size_t i = 0; i < m.sheets.size(); i++) {
        if (m.sheets[i].material >= m.materials.size()) refuse("part", i, "its material does not exist");
        if (m.sheets[i].points < (m.sheets[i].lobatto ? 2 : 1) || m.sheets[i].points > max_points)
            refuse("part", i, "1 to 10 thickness points are allowed (Lobatto: 2 to 10)");
    }
}

// the nodes of rigid elements must belong to one rigid set, and at least one deformable element must define the time step
static void check_rigid_elements(const Model& m, const std::vector<Index>& set_of) {
    bool something_strains = false;
    for (std::size_t e = 0; e < m.elements(); e++) {
        const bool rigid = m.materials[m.sheets[m.sheet_of[e]].material].rigid;
        something_strains |= !rigid;
        const Index set = set_of[m.quads[4 * e]];
        for (std::size_t c = 0; rigid && c < 4; c++)
            if (!set || set_of[m.quads[4 * e + c]] != set) refuse("element", e, "it is rigid, but its nodes are not all in one rigid set");
    }
    if (!something_strains) throw std::invalid_argument("every element is rigid: nothing gives a time step");
}

static void check_sets(const Model& m) {
    std::vector<Index> taken(m.nodes(), 0);
    for (std::size_t i = 0; i < m.rigid_sets.size(); i++)
        for (Index n : m.rigid_sets[i].nodes) {
            if (n >= m.nodes()) refuse("rigid set", i, "node " + std::to_string(n) + " does not exist");
            if (taken[n]) refuse("rigid set", i, "node " + std::to_string(n) + " belongs to a rigid set already");
            if (m.fixed[n]) refuse("rigid set", i, "node " + std::to_string(n) + " is fixed; fix the set instead");
            taken[n] = Index(i + 1);
        }
    check_rigid_elements(m, taken);
    for (std::size_t i = 0; i < m.loads.size(); i++) {
        if (m.loads[i].node >= m.nodes()) refuse("load", i, "its node does not exist");
        if (m.loads[i].dof < 0 || m.loads[i].dof > 5) refuse("load", i, "its degree of freedom is none of six");
    }
    for (std::size_t i = 0; i < m.motions.size(); i++) {
        const Motion& a = m.motions[i];
        if (a.dof < 0 || a.dof > 5) refuse("motion", i, "its degree of freedom is none of six");
        if (a.target >= (a.rigid ? m.rigid_sets.size() : m.nodes())) refuse("motion", i, "its target does not exist");
        if (!a.rigid && taken[a.target]) refuse("motion", i, "its node belongs to a rigid set; move the set instead");
    }
}

static void check_obstacles(const Model& m) {
    for (std::size_t i = 0; i < m.obstacles.size(); i++) {
        const Obstacle& o = m.obstacles[i];
        if (o.shape < Shape::plane || o.shape > Shape::sphere) refuse("obstacle", i, "its shape is unknown");
        for (Index n : o.nodes)
            if (n >= m.nodes()) refuse("obstacle", i, "node " + std::to_string(n) + " does not exist");
    }
}

static void check_cuts(const Model& m) {
    for (std::size_t i = 0; i < m.cuts.size(); i++) {
        for (Index e : m.cuts[i].elements)
            if (e >= m.elements()) refuse("cut", i, "element " + std::to_string(e) + " does not exist");
        for (Index n : m.cuts[i].nodes)
            if (n >= m.nodes()) refuse("cut", i, "node " + std::to_string(n) + " does not exist");
        if (m.cuts[i].nodes.empty()) refuse("cut", i, "it has no nodes");
    }
}

static void check_finite(const std::vector<double>& values, const char* what, std::size_t width) {
    for (std::size_t i = 0; i < values.size(); i++)
        if (!std::isfinite(values[i])) refuse("node", i / width, std::string(what) + " is not finite");
}

void check(const Model& m) {
    if (m.position.size() % 3 != 0) throw std::invalid_argument("positions have shape (nodes, 3)");
    if (m.elements() == 0) throw std::invalid_argument("the model has no elements");
    check_finite(m.position, "its position", 3);
    check_finite(m.velocity, "its velocity", 3);
    check_finite(m.spin, "its angular velocity", 3);
    check_materials(m);
    check_elements(m);
    check_sets(m);
    check_obstacles(m);
    check_cuts(m);
    check_welds(m);
}

}  // namespace crumple::shell
