// Everything that depends on the processor or the operating system; only the width of the vector types is chosen elsewhere
// (shell/simd/pack.hpp).
#pragma once

namespace crumple {

// Process identifier, which differs in a forked process; 0 on systems without fork.
long long process_number();

// Level of the x86-64 instruction set that both processor and operating system support: 1 to 4; 0 on other processors.
int x86_level();

// Hint to the processor that this thread waits in a loop.
inline void spin() {
#if defined(__x86_64__)
    __asm__ volatile("pause");
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

// While one lives, this thread and those that it starts take numbers below the smallest normal one for zero (or not): motion that
// friction has slowed down to nothing ends in such numbers, which slow a processor down: a frame struck in its plane took 7 times as long.
class TinyAsZero {
public:
    explicit TinyAsZero(bool wanted = true);
    ~TinyAsZero();
    TinyAsZero(const TinyAsZero&) = delete;
    TinyAsZero& operator=(const TinyAsZero&) = delete;

private:
    const unsigned long long before_;
};

}  // namespace crumple
