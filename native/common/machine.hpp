// Everything that depends on the processor or the operating system; only the width of the vector types is chosen elsewhere
// (shell/simd/pack.hpp).
#pragma once

namespace crumple {

// Process identifier, which differs in a forked process; 0 on systems without fork.
long long process_number();

// Level of the x86-64 instruction set that both processor and operating system support: 1 to 4; 0 on other processors.
int x86_level();

// Hint to the processor that this thread waits in a loop.
inline void pause() {
#if defined(__x86_64__)
    __asm__ volatile("pause");
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

}  // namespace crumple
