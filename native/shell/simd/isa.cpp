// Choice of the kernels' build: on x86-64 one for each level of the instruction set, elsewhere one generic build.
#include <stdexcept>
#include <string>
#include <vector>

#include "common/machine.hpp"
#include "shell/element/kernel.hpp"

namespace crumple::shell {

#if defined(__x86_64__)
extern const Kernels kernels_v2, kernels_v3, kernels_v4;

static std::vector<const Kernels*> available() {
    const int level = x86_level();
    std::vector<const Kernels*> found;
    if (level >= 4) found.push_back(&kernels_v4);
    if (level >= 3) found.push_back(&kernels_v3);
    if (level >= 2) found.push_back(&kernels_v2);
    return found;
}
#else
extern const Kernels kernels_generic;

static std::vector<const Kernels*> available() { return {&kernels_generic}; }
#endif

const Kernels& choose_kernels(const char* name) {
    const std::vector<const Kernels*> found = available();
    if (found.empty()) throw std::runtime_error("this processor lacks the x86-64-v2 instructions, the least that the shell kernels need");
    if (!name || !*name) return *found.front();
    std::string allowed;
    for (const Kernels* k : found) {
        if (std::string(name) == k->name) return *k;
        allowed += std::string(allowed.empty() ? "" : ", ") + k->name;
    }
    throw std::invalid_argument("unknown instruction set '" + std::string(name) + "' for this machine; allowed: " + allowed);
}

}  // namespace crumple::shell
