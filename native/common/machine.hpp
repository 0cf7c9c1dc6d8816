// What differs between processors and operating systems: no other source asks for these, but for the width of the vector types
// (shell/simd/pack.hpp).
#pragma once

namespace crumple {

// Number of this process: it changes when a process forks, and is 0 where none can.
long long process_number();

// Level of the x86-64 instruction set that processor and operating system offer: 1 to 4, 0 on other processors.
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
