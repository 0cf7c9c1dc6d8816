// The three kernels without Python, on a small model each: what another compiler, processor or operating system must
// compute as well.  `kernels [isa]` prints figures that tools/portability.py compares between builds; it fails where a
// closed form is missed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>

#include "planar/simulation.hpp"
#include "shell/run/simulation.hpp"
#include "spatial/run/simulation.hpp"

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A mass on a weightless bar, thrown about a hinge of constant moment: it stops after I w^2 / (2 M).
constexpr double mass = 6.0, length = 1.0, rate = 4.0, moment = 400.0;
constexpr double rest_angle = mass * length * length * rate * rate / (2.0 * moment);
// The step control sees the end of the motion, where the moment jumps, to some ten times its accuracy.
constexpr double accuracy = 1e-7, tolerance = 1e-5;

int failures = 0;

void print(const char* name, double value) { std::printf("%s %.17g\n", name, value); }

void expect(const char* name, double value, double wanted) {
    print(name, value);
    if (std::fabs(value - wanted) <= tolerance * std::fabs(wanted)) return;
    std::fprintf(stderr, "%s is %.17g and should be %.17g\n", name, value, wanted);
    failures++;
}

crumple::hinge::Hinge constant_hinge() {
    crumple::hinge::Hinge hinge;
    hinge.positive = hinge.negative = crumple::hinge::Curve({0.0}, {moment});
    return hinge;
}

void planar() {
    using namespace crumple::planar;
    Body bar;
    bar.centre = {length, 0.0};
    bar.mass = mass;
    Model model{Tree({bar}), {constant_hinge()}, {}, {}, {}, {}, {}, {0.0}, length, {}};
    Settings settings;
    settings.accuracy = accuracy;
    Simulation run(model, settings);
    run.set_rates(&rate);
    const Record record = run.run({0.1, 0.2}, {});
    expect("planar.rest", record.q.back(), rest_angle);
    expect("planar.dissipated", record.energy.dissipated.back(), 0.5 * mass * length * length * rate * rate);
    print("planar.residual", record.residual);
}

void spatial() {
    using namespace crumple::spatial;
    Model model;
    Body body;
    body.mass = mass;
    body.inertia = {{{1e-3, 0.0, 0.0}, {0.0, 1e-3, 0.0}, {0.0, 0.0, 1e-3}}};
    body.inverse = inverse(body.inertia);
    body.centre = {length, 0.0, 0.0};
    model.bodies = {body};
    Joint joint;
    joint.body[1] = 0;
    joint.arm[1] = {-length, 0.0, 0.0};
    joint.held = 5;
    joint.laws = 1;
    const int freedoms[] = {0, 1, 2, 3, 4, 5};
    std::copy(freedoms, freedoms + 6, joint.freedom);
    joint.hinge = 0;
    model.joints = {joint};
    SpatialHinge hinge;
    hinge.components = {{5, constant_hinge(), {}, -1}};
    model.hinges = {hinge};
    model.hinge_joint = {0};
    model.length = length;
    Settings settings;
    settings.accuracy = accuracy;
    Simulation run(model, settings);
    const Twist motion{{0.0, 0.0, rate}, {0.0, rate * length, 0.0}}, none{};
    run.set_motion(&motion, &none);
    const Record record = run.run({0.1, 0.2}, {});
    const double inertia = mass * length * length + 1e-3;
    expect("spatial.rest", record.hinge.rotation.back(), 0.5 * inertia * rate * rate / moment);
    print("spatial.residual", record.residual);
}

// A clamped strip with a rigid end, thrown sideways until it yields and its walls could touch.
std::shared_ptr<crumple::shell::Model> strip() {
    using namespace crumple::shell;
    constexpr Index along = 12, across = 7;
    auto model = std::make_shared<Model>();
    RigidSet end{{}, 0.2, {0.2, 0.05, 0.0}, {}, 0, false, {}};
    for (Index i = 0; i <= along; i++)
        for (Index j = 0; j <= across; j++) {
            const double x = 0.2 * i / along, y = 0.1 * j / across;
            if (i == along) end.nodes.push_back(Index(model->nodes()));
            model->position.insert(model->position.end(), {x, y, 0.0});
            model->velocity.insert(model->velocity.end(), {0.0, 0.0, 60.0 * x / 0.2});
            model->fixed.push_back(i == 0 ? 63 : 0);
        }
    model->spin.assign(3 * model->nodes(), 0.0);
    model->added_mass.assign(model->nodes(), 0.0);
    model->added_inertia.assign(model->nodes(), 0.0);
    for (Index i = 0; i < along; i++)
        for (Index j = 0; j < across; j++) {
            const Index a = i * (across + 1) + j, b = a + across + 1;
            model->quads.insert(model->quads.end(), {a, b, b + 1, a + 1});
        }
    model->thickness.assign(along * across, 2e-3);
    model->sheet_of.assign(along * across, 0);
    // a hardening table with a rate effect: the branch that calls the power function of the system
    model->materials = {{7850.0, 210e9, 0.3, {0.0, 0.05, 0.2}, {488e6, 550e6, 600e6}, 0.0, 40.0, 0.2, 1e-5, 0.0, false, infinity, false}};
    model->sheets = {{0, 5, false}};
    model->rigid_sets = {end};
    model->contact.on = true;
    return model;
}

void shell(const char* isa) {
    using namespace crumple::shell;
    const Kernels& kernels = choose_kernels(isa);
    Simulation one(strip(), kernels), two(strip(), kernels);
    one.advance(1.0, 600.0, 200, 1);
    two.advance(1.0, 600.0, 200, 2);
    const Energies energies = one.energies();
    std::fprintf(stderr, "%s\n", kernels.name);
    print("shell.time", one.time());
    print("shell.kinetic", energies.kinetic);
    print("shell.elastic", energies.elastic);
    print("shell.plastic", energies.plastic);
    print("shell.tip", one.position()[4 * (one.model().nodes() - 1) + 2]);
    if (!(energies.plastic > 1.0)) failures++, std::fprintf(stderr, "the strip does not yield\n");
    for (std::size_t i = 0; i < 4 * one.model().nodes(); i++) {
        if (one.position()[i] == two.position()[i]) continue;
        std::fprintf(stderr, "two threads do not give the bits of one\n");
        failures++;
        break;
    }
}

}  // namespace

int main(int count, char** arguments) {
    try {
        planar();
        spatial();
        shell(count > 1 ? arguments[1] : "");
    } catch (const std::invalid_argument& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;   // this processor lacks the instructions
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
    return failures == 0 ? 0 : 1;
}
