// Python module of the compiled kernels behind crumple._core, with a registration function for each kernel.
#include <nanobind/nanobind.h>

#include "common/binding.hpp"
#include "common/records.hpp"

namespace nb = nanobind;

namespace crumple::planar {
inline namespace plain {
void bind(nb::module_& m);
}
inline namespace tangent {
void bind_tangent(nb::module_& m);
}
}
namespace crumple::shell {
void bind(nb::module_& m);
}
namespace crumple::spatial {
void bind(nb::module_& m);
void bind_hinge(nb::module_& m);
void bind_contact(nb::module_& m);
void bind_batch(nb::module_& m);
}

NB_MODULE(_kernels, m) {
    m.doc() = "Compiled kernels of Crumple; use them through crumple.multibody and crumple.shell.";
    nb::dict columns;
    columns["energy"] = crumple::column_names<crumple::EnergyRecord<double>>();
    columns["hinge"] = crumple::column_names<crumple::ComponentRecord<double>>();
    columns["hinge_energy"] = crumple::column_names<crumple::HingeEnergyRecord<double>>();
    columns["summary"] = crumple::column_names<crumple::HingeSummary<double>>();
    m.attr("record_columns") = columns;
    auto planar = m.def_submodule("planar", "Implicit convex stepper for trees of rigid bodies with plastic hinges.");
    crumple::planar::bind(planar);
    auto spatial = m.def_submodule("spatial", "Implicit convex stepper for rigid bodies in space with plastic hinges.");
    crumple::spatial::bind(spatial);
    crumple::spatial::bind_hinge(spatial);
    crumple::spatial::bind_contact(spatial);
    crumple::spatial::bind_batch(spatial);
    auto tangent = planar.def_submodule("tangent", "The same stepper with derivatives.");
    crumple::planar::bind_tangent(tangent);
    auto shell = m.def_submodule("shell", "Explicit stepper for thin shells.");
    crumple::shell::bind(shell);
}
