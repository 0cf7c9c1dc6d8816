// Memory layout: node records, corner records and the slots of an element's state.
//
// Element state is [block][slot][lane]: one load fills a register with the same quantity of `lanes`
// elements.  Nodes are padded records that are loaded as a whole and transposed in registers.
#pragma once
#include <cstdint>

namespace crumple::shell {

constexpr int position_record = 4;   // x, y, z, unused
constexpr int velocity_record = 8;   // v (3), 0, angular velocity (3), 0
constexpr int corner_record = 8;     // force (3), 0, moment (3), 0
constexpr int max_points = 10;       // through the thickness

// Slots common to all elements; the thickness points follow.
enum Slot : int {
    shear_xz, shear_yz,              // transverse shear stress [Pa]
    hourglass_x, hourglass_y, hourglass_z, hourglass_rx, hourglass_ry,   // [N], [N m]
    volume0,                         // volume at the start [m3]
    thickness,                       // [m]
    wave,                            // factor of the stable step: 4 c^2 (quadrilateral) or 3 c^2 (triangle) [m2/s2]
    internal_energy, plastic_energy, hourglass_energy,                   // accumulated [J]
    alive,                           // 1, or 0 once deleted
    common_slots
};
// Slots of one thickness point.
enum PointSlot : int { stress_x, stress_y, stress_xy, plastic_strain, point_slots };
// Slots after those of the points, for elements with stabilisation or drilling stiffness.
enum ExtraSlot : int {
    edge_shear,                      // second resultant of varying transverse shear; the first is hourglass_z [N m]
    drill_1, drill_2, drill_3, drill_4,   // moment about the normal at each corner [N m]
    extra_slots
};

constexpr int point_slot(int point, int slot) { return common_slots + point_slots * point + slot; }
constexpr int rate_slot(int points, int point) { return common_slots + point_slots * points + point; }
constexpr int extra_slot(int points, bool rate, int slot) {
    return common_slots + (point_slots + (rate ? 1 : 0)) * points + slot;
}
constexpr int slots_of(int points, bool rate, bool extra) { return extra_slot(points, rate, extra ? int(extra_slots) : 0); }

}  // namespace crumple::shell
