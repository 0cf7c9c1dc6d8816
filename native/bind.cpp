// The compiled kernels behind crumple._core: one registration function per engine.
#include <nanobind/nanobind.h>

namespace nb = nanobind;

namespace crumple::multibody {
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
namespace crumple::space {
void bind(nb::module_& m);
void bind_hinge(nb::module_& m);
void bind_contact(nb::module_& m);
void bind_batch(nb::module_& m);
}

NB_MODULE(_kernels, m) {
    m.doc() = "Compiled kernels of Crumple; use them through crumple.multibody and crumple.shell.";
    auto multibody = m.def_submodule("multibody", "Implicit convex stepper for trees of rigid bodies with plastic hinges.");
    crumple::multibody::bind(multibody);
    auto space = m.def_submodule("space", "Implicit convex stepper for rigid bodies in space with plastic hinges.");
    crumple::space::bind(space);
    crumple::space::bind_hinge(space);
    crumple::space::bind_contact(space);
    crumple::space::bind_batch(space);
    auto tangent = multibody.def_submodule("tangent", "The same stepper with derivatives.");
    crumple::multibody::bind_tangent(tangent);
    auto shell = m.def_submodule("shell", "Explicit stepper for thin shells.");
    crumple::shell::bind(shell);
}
