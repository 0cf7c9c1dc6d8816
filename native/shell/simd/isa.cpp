// Which build of the kernels runs here.  Detection on x86-64 stays in this file; elsewhere there is one generic build.
#include <stdexcept>
#include <string>
#include <vector>

#include "shell/element/kernel.hpp"

namespace crumple::shell {

#if defined(__x86_64__) || defined(_M_X64)
extern const Kernels kernels_v2, kernels_v3, kernels_v4;

static std::vector<const Kernels*> available() {
    __builtin_cpu_init();
    std::vector<const Kernels*> found;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd"))
        found.push_back(&kernels_v4);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        found.push_back(&kernels_v3);
    if (__builtin_cpu_supports("sse4.2")) found.push_back(&kernels_v2);
    return found;
}
#else
extern const Kernels kernels_generic;

static std::vector<const Kernels*> available() { return {&kernels_generic}; }
#endif

const Kernels& choose_kernels(const char* name) {
    const std::vector<const Kernels*> found = available();
    if (found.empty()) throw std::runtime_error("this processor lacks SSE4.2, the least that the shell kernels need");
    if (!name || !*name) return *found.front();
    std::string allowed;
    for (const Kernels* k : found) {
        if (std::string(name) == k->name) return *k;
        allowed += std::string(allowed.empty() ? "" : ", ") + k->name;
    }
    throw std::invalid_argument("unknown instruction set '" + std::string(name) + "' for this machine; allowed: " + allowed);
}

}  // namespace crumple::shell
