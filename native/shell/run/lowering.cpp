#include "shell/run/lowering.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace crumple::shell {

// Copies rate law, hardening table and failure strain of a material to a part.
static void set_plasticity(Part& p, const Material& a) {
    const bool rate = std::isfinite(a.rate_reference) && !a.yield_stress.empty();
    p.rate = !rate ? Rate::none : (a.rate_logarithm > 0.0 ? Rate::logarithm : Rate::power);
    p.inverse_rate_reference = rate ? 1.0 / a.rate_reference : 0.0;
    p.rate_exponent = p.rate == Rate::logarithm ? a.rate_logarithm : (rate ? 1.0 / a.rate_exponent : 0.0);
    p.rate_time = a.rate_time;
    p.table_size = int(a.yield_stress.size());
    p.table_strain = a.plastic_strain.data();
    p.table_stress = a.yield_stress.data();
    p.fails = std::isfinite(a.failure_strain);
    p.fails_at_any_point = a.fails_at_any_point;
    p.failure_strain = a.failure_strain;
    p.yield_stress = a.yield_stress.empty() ? 0.0 : a.yield_stress[0];
    p.hardening = a.hardening_modulus;
    // a single point with a hardening modulus uses the fast law
    p.law = a.yield_stress.empty() ? Law::elastic : (a.yield_stress.size() == 1 && !rate ? Law::linear : Law::general);
}

Part part_of(const Model& m, const Sheet& sheet, bool triangle) {
    const Material& a = m.materials[sheet.material];
    Part p{};
    const double E = a.youngs_modulus, nu = a.poissons_ratio;
    p.youngs_modulus = E;
    p.poissons_ratio = nu;
    p.density = a.density;
    p.plane_modulus = E / (1.0 - nu * nu);
    p.shear_modulus = E / (2.0 * (1.0 + nu));
    p.transverse_modulus = 5.0 / 6.0 * p.shear_modulus;
    p.pressure_ratio = (1.0 + nu) / (3.0 * (1.0 - nu));
    p.bulk_compliance = (1.0 - 2.0 * nu) / E;
    p.inverse_3g = 1.0 / (3.0 * p.shear_modulus);
    set_plasticity(p, a);
    p.points = sheet.points;
    thickness_rule(sheet.points, sheet.lobatto, p.z, p.weight);
    for (int k = 0; k < p.points; k++) p.second_moment += p.weight[k] * p.z[k] * p.z[k];
    p.half_compliance = 0.5 / E;
    p.half_shear_compliance = 0.5 / p.shear_modulus;
    p.rigid = a.rigid;
    const Settings& s = m.settings;
    p.viscous_hourglass = s.viscous_hourglass;
    p.hourglass_membrane = s.hourglass_membrane;
    p.hourglass_shear = s.hourglass_shear;
    p.hourglass_bending = s.hourglass_bending;
    p.hourglass_moduli[0] = s.hourglass_membrane * E / 8.0;
    p.hourglass_moduli[1] = s.hourglass_shear * p.transverse_modulus / 12.0;
    p.hourglass_moduli[2] = s.hourglass_bending * E / 192.0;
    p.formulation = triangle ? Formulation::triangle : (s.stabilised ? Formulation::stabilised : Formulation::one_point);
    p.drill_stiffness = triangle ? 0.0 : s.drill_stiffness;
    p.thickness_update = s.thickness_update;
    p.warping_correction = s.warping_correction && !triangle;
    return p;
}

struct Place {
    std::size_t chunk;
    std::uint32_t record;                        // of the corner, counted from the chunk's first
};

static Place place_in_chunk(const Blocks& b, std::size_t element, int corner) {
    const std::vector<std::uint32_t>& first = b.chunks.block;
    const std::size_t lanes = std::size_t(b.lanes), block = b.place_of[element] / lanes;
    const std::size_t chunk = std::size_t(std::upper_bound(first.begin(), first.end(), std::uint32_t(block)) - first.begin()) - 1;
    return {chunk, std::uint32_t(b.corner(element, corner) - 4 * lanes * first[chunk])};
}

// Lists the corners that each chunk sums per node, in the order of the elements, so that the order of summation is fixed.
static void list_corners(const Model& m, Blocks& b) {
    Chunks& c = b.chunks;
    struct Corner {
        std::uint32_t node, record;
    };
    std::vector<std::vector<Corner>> corners(c.count());
    for (std::size_t e = 0; e < m.elements(); e++)
        for (int k = 0; k < m.corners(e); k++) {
            const Place p = place_in_chunk(b, e, k);
            corners[p.chunk].push_back({m.quads[4 * e + std::size_t(k)], p.record});
        }
    std::vector<Index> node_of;                  // [sum]
    c.first.push_back(0);
    for (std::vector<Corner>& chunk : corners) {
        c.sums.push_back(std::uint32_t(node_of.size()));
        std::stable_sort(chunk.begin(), chunk.end(), [](const Corner& x, const Corner& y) { return x.node < y.node; });
        for (std::size_t i = 0; i < chunk.size(); i++) {
            c.corner_of.push_back(chunk[i].record);
            if (i + 1 < chunk.size() && chunk[i + 1].node == chunk[i].node) continue;
            node_of.push_back(chunk[i].node);
            c.first.push_back(std::uint32_t(c.corner_of.size()));
        }
    }
    c.sums.push_back(std::uint32_t(node_of.size()));
    b.first.assign(m.nodes() + 1, 0);
    for (Index n : node_of) b.first[n + 1]++;
    for (std::size_t i = 0; i < m.nodes(); i++) b.first[i + 1] += b.first[i];
    std::vector<std::uint32_t> next(b.first.begin(), b.first.end() - 1);
    b.sum_of.resize(node_of.size());
    for (std::size_t i = 0; i < node_of.size(); i++) b.sum_of[next[node_of[i]]++] = std::uint32_t(i);
}

// Lists the corners of the cuts' elements at the cuts' nodes, by chunk.
static void list_cuts(const Model& m, Blocks& b) {
    Chunks& c = b.chunks;
    struct Kept {
        Place place;
        std::size_t cut;
        bool operator<(const Kept& other) const {
            return place.chunk < other.place.chunk || (place.chunk == other.place.chunk && place.record < other.place.record);
        }
    };
    std::vector<Kept> all;
    for (std::size_t i = 0; i < m.cuts.size(); i++) {
        std::vector<std::uint8_t> in(m.nodes(), 0);
        for (Index n : m.cuts[i].nodes) in[n] = 1;
        for (Index e : m.cuts[i].elements)
            for (int k = 0; k < m.corners(e); k++)
                if (in[m.quads[4 * std::size_t(e) + std::size_t(k)]]) all.push_back({place_in_chunk(b, e, k), i});
    }
    std::vector<std::size_t> order(all.size());
    for (std::size_t i = 0; i < order.size(); i++) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return all[x] < all[y]; });
    b.cut_corners.assign(m.cuts.size(), {});
    std::vector<std::uint32_t> place(all.size());
    c.kept.assign(c.count() + 1, 0);
    for (std::size_t i = 0; i < order.size(); i++) {
        place[order[i]] = std::uint32_t(i);
        c.kept_corner.push_back(all[order[i]].place.record);
        c.kept[all[order[i]].place.chunk + 1]++;
    }
    for (std::size_t i = 0; i < c.count(); i++) c.kept[i + 1] += c.kept[i];
    for (std::size_t i = 0; i < all.size(); i++) b.cut_corners[all[i].cut].push_back(place[i]);
}

Blocks block_up(const Model& m, int lanes) {
    Blocks b;
    b.lanes = lanes;
    b.place_of.resize(m.elements());
    std::map<std::pair<Index, bool>, std::vector<std::size_t>> groups;
    for (std::size_t e = 0; e < m.elements(); e++) groups[{m.sheet_of[e], m.triangle(e)}].push_back(e);
    std::size_t offset = 0;
    for (const auto& [key, members] : groups) {
        b.parts.push_back(part_of(m, m.sheets[key.first], key.second));
        const Part& part = b.parts.back();
        for (std::size_t start = 0; start < members.size(); start += std::size_t(lanes)) {
            if (start % elements_per_chunk == 0) b.chunks.block.push_back(std::uint32_t(b.count()));
            const std::size_t block = b.part_of.size();
            b.part_of.push_back(std::uint32_t(b.parts.size() - 1));
            b.offset.push_back(offset);
            offset += std::size_t(lanes) * std::size_t(slots_of(part.points, part.rate != Rate::none, part.extra()));
            for (int lane = 0; lane < lanes; lane++) {
                const bool real = start + std::size_t(lane) < members.size();
                const std::size_t e = members[real ? start + std::size_t(lane) : members.size() - 1];
                b.element_of.push_back(real ? std::int64_t(e) : -1);
                if (real) b.place_of[e] = block * std::size_t(lanes) + std::size_t(lane);
            }
        }
    }
    b.offset.push_back(offset);
    b.chunks.block.push_back(std::uint32_t(b.count()));
    // copies use the nodes of the last real element of the part; their forces are not read
    b.nodes.resize(4 * b.element_of.size());
    std::int64_t last = 0;
    for (std::size_t place = 0; place < b.element_of.size(); place++) {
        if (b.element_of[place] >= 0) last = b.element_of[place];
        const std::size_t block = place / std::size_t(lanes), lane = place % std::size_t(lanes);
        for (std::size_t c = 0; c < 4; c++) b.nodes[(4 * block + c) * std::size_t(lanes) + lane] = m.quads[4 * std::size_t(last) + c];
    }
    list_corners(m, b);
    list_cuts(m, b);
    return b;
}

double first_stable_step(const Model& m, std::size_t e) {
    const Material& a = m.materials[m.sheets[m.sheet_of[e]].material];
    if (a.rigid) return std::numeric_limits<double>::infinity();
    Vec3 x[4];
    for (int c = 0; c < 4; c++) x[c] = read3(&m.position[3 * m.quads[4 * e + c]]);
    // frame and frequency bound as in the kernel (frame.hpp), for one element
    const Vec3 d31 = x[2] - x[0], d42 = x[3] - x[1], normal = cross(d31, d42);
    const double inverse = 1.0 / norm(normal);
    const Vec3 e3 = inverse * normal, g1 = d31 - d42, g2 = d31 + d42;
    const Vec3 both = (1.0 / norm(g1)) * g1 + (1.0 / norm(g2)) * cross(g2, e3);
    const Vec3 e1 = (1.0 / norm(both)) * both, e2 = cross(e3, e1);
    const double bx1 = -dot(d42, e2) * inverse, bx2 = dot(d31, e2) * inverse;
    const double by1 = dot(d42, e1) * inverse, by2 = -dot(d31, e1) * inverse;
    const bool tri = m.triangle(e);
    // the sum of b b^T over the corners: corners 3 and 4 have -b_1 and -b_2, a triangle's third has -b_1 - b_2
    const double x3 = bx1 + bx2, y3 = by1 + by2, twice = tri ? 1.0 : 2.0;
    const double xx = twice * (bx1 * bx1 + bx2 * bx2) + (tri ? x3 * x3 : 0.0);
    const double yy = twice * (by1 * by1 + by2 * by2) + (tri ? y3 * y3 : 0.0);
    const double xy = twice * (bx1 * by1 + bx2 * by2) + (tri ? x3 * y3 : 0.0);
    const double c2 = a.youngs_modulus / (1.0 - a.poissons_ratio * a.poissons_ratio) / a.density;
    return 2.0 / std::sqrt((tri ? 3.0 : 4.0) * c2 * (std::max(xx, yy) + std::abs(xy)));
}

// In a mesh the stiffest mode alternates from element to element and cannot dilate all of them; an element with two corners that
// belong to no other element can dilate, which raises its squared frequency by the factor 1 + nu.
static std::vector<double> loose_ends(const Model& m) {
    std::vector<int> sharing(m.nodes(), 0);
    for (std::size_t e = 0; e < m.elements(); e++)
        for (std::size_t c = 0; c < std::size_t(m.corners(e)); c++) sharing[m.quads[4 * e + c]]++;
    std::vector<double> out(m.elements(), 1.0);
    for (std::size_t e = 0; e < m.elements(); e++) {
        int own = 0;
        for (std::size_t c = 0; c < std::size_t(m.corners(e)); c++) own += sharing[m.quads[4 * e + c]] == 1;
        if (own >= 2) out[e] = 1.0 + m.materials[m.sheets[m.sheet_of[e]].material].poissons_ratio;
    }
    return out;
}

// Rotary inertia per mass is (t^2 + a A) / 12.  With a = 3 kG / (C - kG) (kG transverse shear, C plane modulus) the
// squared frequency of shear, 4 kG (1/A + 3/(a A)) in a square, stays at that of membrane waves, 4 C / A: shear
// never governs the step.  With a = 1 narrow strips with a small nu are unstable.  Theory: docs/theory/explicit_stepper.md.
static double inertia_factor(const Material& a) {
    const double shear = 5.0 / 6.0 / (2.0 * (1.0 + a.poissons_ratio)), plane = 1.0 / (1.0 - a.poissons_ratio * a.poissons_ratio);
    return 3.0 * shear / (plane - shear);
}

Masses lump(const Model& m) {
    Masses out;
    out.loose = loose_ends(m);
    out.mass = m.added_mass;
    out.inertia = m.added_inertia;
    out.scale.assign(m.elements(), 1.0);
    const double target = m.settings.scaled_step / m.settings.safety;
    for (std::size_t e = 0; e < m.elements(); e++) {
        const double step = first_stable_step(m, e) / std::sqrt(out.loose[e]), area = area_of(m, e), t = m.thickness[e];
        if (step < target) out.scale[e] = (target / step) * (target / step);
        const double plain = m.materials[m.sheets[m.sheet_of[e]].material].density * t * area;
        const double mass = plain * out.scale[e];
        out.structure += plain;
        out.added += mass - plain;
        const bool tri = m.triangle(e);
        const double gyration = (t * t + (tri ? 2.0 : 1.0) * inertia_factor(m.materials[m.sheets[m.sheet_of[e]].material]) * area) / 12.0;
        for (int c = 0; c < m.corners(e); c++) {
            const double share = tri ? 1.0 / 3.0 : 0.25;
            out.mass[m.quads[4 * e + c]] += share * mass;
            out.inertia[m.quads[4 * e + c]] += share * mass * gyration;
        }
    }
    return out;
}

}  // namespace crumple::shell
