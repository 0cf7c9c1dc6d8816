// Spot welds: ties of two sheets at points between nodes, which can fail.
//
// Each sheet is represented by the weighted mean of the velocities v and spins w of some nodes; the weights add up to one and are
// such that the mean positions p and q lie opposite each other.  With r = q - p the tie requires
//     v_q - v_p = (w_p + w_q)/2 x r   and   w_q = w_p along the sheets,
// which is the motion of a small rigid piece.  Its force F on the second sheet acts half-way between the sheets: F w and -F w on
// their nodes, with moments -r x F w/2 on each, so that force and moment balance to round-off and a satisfied tie has no power.
// The impulses of a step follow from five equations for each weld; welds that share nodes are iterated (Gauss-Seidel).
// Spins about the normal are not tied: a smooth sheet has no stiffness against them.
// With Fn = -F . r/|r| (tension positive) and Fs = |F + Fn r/|r||, a weld fails at (max(Fn, 0)/Sn)^2 + (Fs/Ss)^2 >= 1.
// Theory: docs/theory/spot_welds.md.
#pragma once
#include "shell/run/lowering.hpp"
#include "shell/run/saved.hpp"

namespace crumple::shell {

struct WeldState {
    bool broken = false;
    double time = 0.0;               // of the last evaluation, or of failure [s]
    double normal = 0.0, shear = 0.0;// force then, tension positive [N]
    double worst = 0.0;              // largest value of the failure criterion so far
};

// Throws std::invalid_argument naming the first weld that cannot be computed.
void check_welds(const Model& model);

class SpotWelds {
public:
    // Linear and angular velocity of a tied node.
    struct Motion6 {
        Vec3 velocity, spin;
    };

    SpotWelds(const Model& model, const Masses& masses);

    // Nodes of all welds, intact or failed, in increasing order.
    const std::vector<Index>& nodes() const { return nodes_; }
    // Whether each node of the list is held by an intact weld.
    std::vector<std::uint8_t> held() const;
    const std::vector<WeldState>& states() const { return states_; }

    // Makes the velocities of the tied nodes compatible with the ties; `step` > 0 also corrects the drift of the sheets' distance by
    // the end of the step.  Returns the impulse on each second sheet.
    std::vector<Vec3> fit(const double* position, double step, std::vector<Motion6>& motion) const;
    // Evaluates the failure criterion with the impulses within `kick` [s]: overloaded welds fail.
    void bear(const double* position, double time, double kick, const std::vector<Vec3>& impulse);

    void save(std::vector<double>& out) const;
    void restore(Saved& in);

private:
    struct Side {
        std::vector<std::uint32_t> at;   // indices in the list of nodes
        std::vector<double> weight;
        double mobility = 0.0, spin_mobility = 0.0;      // sums of weight^2/mass and weight^2/inertia
    };
    struct Tie {
        Side side[2];
        double distance;                 // of the sheets at the start [m]
    };
    struct Frame5;
    Vec3 mean(const double* position, const Side& side) const;
    Vec3 arm(const double* position, const Tie& tie) const;
    Frame5 framed(const Tie& tie, Vec3 r) const;

    const Model& model_;
    std::vector<Index> nodes_;
    std::vector<double> inverse_mass_, inverse_inertia_;     // of the list of nodes
    std::vector<Tie> ties_;
    std::vector<WeldState> states_;
    bool coupled_ = false;               // whether any node belongs to several welds
};

}  // namespace crumple::shell
