// The state of a model and the explicit stepper that advances it.
#pragma once
#include <memory>
#include <string>

#include "shell/contact/contact.hpp"
#include "shell/rigid/rigid_body.hpp"
#include "common/team.hpp"
#include "shell/rigid/welds.hpp"

namespace crumple::shell {

// [J]; internal = elastic + plastic; residual = kinetic + internal + hourglass + contact + damping - external - first kinetic
struct Energies {
    double kinetic = 0.0, elastic = 0.0, plastic = 0.0, hourglass = 0.0, contact = 0.0, damping = 0.0, external = 0.0;
    double residual = 0.0, eroded = 0.0;
};

enum class End : int { running, reached, not_finite, step_collapsed, torn, inverted };

// Kind of a node held by a spot weld; 0: free, 1: in a rigid set, 2: loaded or driven.
constexpr std::uint8_t tied_node = 3;

struct Checkpoint {
    std::vector<double> numbers, nodes, elements, sums, bodies, drives, contact;
};

class Simulation {
public:
    Simulation(std::shared_ptr<const Model> model, const Kernels& kernels);

    // Advances to the time `until`, for `seconds` of wall time, or by `steps` steps, whichever comes first.
    End advance(double until, double seconds, std::int64_t steps, int threads);
    // One evaluation of the elements at given nodal motion, without time integration: positions at the end of the step.
    void deform(const double* position, const double* velocity, const double* spin, double dt);

    Energies energies() const;
    Wrench cut(std::size_t i, Vec3* centre) const;
    double slot(std::size_t element, int slot) const;
    void node_forces(double* force_and_moment) const;    // (n, 6) internal forces
    void velocities(double* v, double* w) const;         // (n, 3) each, at the time of the positions

    Checkpoint save() const;
    void restore(const Checkpoint& saved);
    // Continues from the state of another model with the same mesh, bodies and obstacles: the next stage of a sequence.
    void go_on_from(const Checkpoint& saved);
    // Adds velocities and spins (n, 3) to the motion; the change of kinetic energy counts as external work.
    void add_motion(const double* velocity, const double* spin);
    // Stops all motion; its kinetic energy counts as damping.
    void stop();
    double external_work() const { return outside_work_ + work_to_come() + gravity_work() + contact_->obstacles().external_work(); }

    const Model& model() const { return *model_; }
    const Blocks& blocks() const { return blocks_; }
    const Masses& masses() const { return masses_; }
    const Kernels& kernels() const { return kernels_; }
    const Contact& contact() const { return *contact_; }
    const std::vector<RigidBody>& bodies() const { return bodies_; }
    const std::vector<RigidState>& body_states() const { return body_states_; }
    const SpotWelds& welds() const { return *welds_; }
    const double* position() const { return position_.data(); }
    double time() const { return time_; }
    double step() const { return dt_; }
    double first_step() const { return first_dt_; }
    std::int64_t steps() const { return steps_; }
    std::int64_t failed_element() const { return failed_element_; }
    End end() const { return end_; }

private:
    // node with a load or a prescribed velocity
    struct Driven {
        Index node;
        unsigned held;                           // prescribed dofs
        std::vector<std::size_t> loads, motions;
        double outside[6];                       // external force at the last step
    };
    struct BodyDrive {
        std::vector<std::size_t> loads, motions;
        double outside[6];
    };
    struct Kick {                                // new velocities and external forces of six degrees of freedom
        double velocity[6], outside[6];
    };

    void place_nodes();
    void sort_drives();
    void start_elements();
    ElementStage element_stage(double dt, double* corner);
    // buffer for the forces at the corners of a chunk's elements
    aligned_vector<double> chunk_corners() const { return aligned_vector<double>(std::size_t(4 * corner_record) * elements_per_chunk); }
    void move_elements(const ElementStage& stage, std::size_t chunk, ElementReport& report);
    NodeStage node_stage();
    double move_nodes(Range range);              // returns the square of the largest displacement since contact checked all candidates
    double way_of_others() const;                // the same for nodes that are driven, tied or in rigid sets
    void move_driven();
    void move_bodies();
    std::vector<SpotWelds::Motion6> weld_motion() const;
    void set_weld_motion(const std::vector<SpotWelds::Motion6>& motion);
    std::vector<SpotWelds::Motion6> kick_welds(std::vector<Vec3>& impulse) const;
    void move_welds();
    double kinetic_of_welds() const;
    void sort_welds();
    void fit_welds();
    void end_step(const std::vector<ElementReport>& reports);
    void end_contact(const Member& member);
    void note_failure(const ElementReport& report);
    void update_alive();
    Wrench internal_force(Index node) const;     // of elements and contact on the node
    Vec3 load(const std::vector<std::size_t>& loads, bool moment, double t) const;
    Kick kick_driven(const Driven& d) const;
    Kick kick_body(std::size_t i, RigidState& state) const;
    double kinetic() const;
    double work_to_come() const;
    double gravity_work() const;
    Motions motions() const { return {position_.data(), velocity_.data(), dt_}; }
    double kick() const { return 0.5 * (dt_ + last_dt_); }

    std::shared_ptr<const Model> model_;
    const Kernels& kernels_;
    Masses masses_;
    Blocks blocks_;
    aligned_vector<double> position_, velocity_, inverse_mass_, state_;
    aligned_vector<double> sum_, kept_;           // corner forces: sums per chunk and node, and those that cuts read
    std::vector<std::uint8_t> kind_, alive_;
    std::vector<double> damping_work_;
    std::vector<RigidBody> bodies_;
    std::vector<RigidState> body_states_;
    std::vector<BodyDrive> body_drives_;
    std::vector<Driven> driven_;
    std::unique_ptr<SpotWelds> welds_;
    std::unique_ptr<Contact> contact_;
    double time_ = 0.0, dt_ = 0.0, last_dt_ = 0.0, first_dt_ = 0.0;
    double outside_work_ = 0.0, body_damping_ = 0.0, first_kinetic_ = 0.0;
    std::int64_t steps_ = 0, failed_element_ = -1;
    End end_ = End::running;
    bool can_fail_ = false;
    Team team_;
};

}  // namespace crumple::shell
