#include "common/machine.hpp"

#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace crumple {

long long process_number() {
#if defined(_WIN32)
    return 0;
#else
    return getpid();
#endif
}

namespace {

// The register with the modes of floating-point arithmetic, and those of its bits that stand for tiny operands and results.
#if defined(__x86_64__)
constexpr unsigned long long tiny_as_zero = 1u << 6 | 1u << 15;

unsigned long long modes() {
    unsigned value;
    __asm__ volatile("stmxcsr %0" : "=m"(value));
    return value;
}

void set_modes(unsigned long long wanted) {
    const unsigned value = static_cast<unsigned>(wanted);
    __asm__ volatile("ldmxcsr %0" : : "m"(value) : "memory");
}
#elif defined(__aarch64__)
constexpr unsigned long long tiny_as_zero = 1u << 24;

unsigned long long modes() {
    unsigned long long value;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    return value;
}

void set_modes(unsigned long long wanted) { __asm__ volatile("msr fpcr, %0" : : "r"(wanted) : "memory"); }
#else
constexpr unsigned long long tiny_as_zero = 0;

unsigned long long modes() { return 0; }

void set_modes(unsigned long long) {}
#endif

}  // namespace

TinyAsZero::TinyAsZero(bool wanted) : before_(modes()) { set_modes(wanted ? before_ | tiny_as_zero : before_ & ~tiny_as_zero); }

TinyAsZero::~TinyAsZero() { set_modes(before_); }

#if defined(__x86_64__)

namespace {

struct Registers {
    unsigned a, b, c, d;
};

// Written as an instruction because the headers that wrap it differ between GCC, Clang and clang-cl.
Registers cpuid(unsigned leaf) {
    Registers r;
    __asm__ volatile("cpuid" : "=a"(r.a), "=b"(r.b), "=c"(r.c), "=d"(r.d) : "a"(leaf), "c"(0));
    return r;
}

// Bits of the register sets that the operating system saves when it switches threads (XCR0).
unsigned saved_registers() {
    unsigned low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

constexpr unsigned bits() { return 0; }
template <class... More> constexpr unsigned bits(int first, More... more) { return 1u << first | bits(more...); }

// The features of each level are those of the x86-64 psABI: a compiler may use all of them.
constexpr unsigned level2_c = bits(0, 9, 13, 19, 20, 23);    // leaf 1 ecx: SSE3, SSSE3, CMPXCHG16B, SSE4.1, SSE4.2, POPCNT
constexpr unsigned level2_extended_c = bits(0);              // LAHF
constexpr unsigned level3_c = bits(12, 22, 27, 28, 29);      // FMA, MOVBE, OSXSAVE, AVX, F16C
constexpr unsigned level3_extended_c = bits(5);              // LZCNT
constexpr unsigned level3_b = bits(3, 5, 8);                 // leaf 7 ebx: BMI1, AVX2, BMI2
constexpr unsigned level3_saved = bits(1, 2);                // XMM, YMM
constexpr unsigned level4_b = bits(16, 17, 28, 30, 31);      // AVX512F, DQ, CD, BW, VL
constexpr unsigned level4_saved = bits(1, 2, 5, 6, 7);       // and the mask registers and both parts of ZMM

constexpr bool has(unsigned found, unsigned wanted) { return (found & wanted) == wanted; }

}  // namespace

int x86_level() {
    const unsigned last = cpuid(0).a, c = cpuid(1).c;
    const unsigned extended = cpuid(0x80000000u).a >= 0x80000001u ? cpuid(0x80000001u).c : 0;
    if (!has(c, level2_c) || !has(extended, level2_extended_c)) return 1;
    const unsigned b = last >= 7 ? cpuid(7).b : 0;
    // level3_c contains OSXSAVE, without which xgetbv in saved_registers() does not exist
    if (!has(c, level3_c) || !has(extended, level3_extended_c) || !has(b, level3_b) || !has(saved_registers(), level3_saved)) return 2;
    // macOS saves the ZMM registers only for threads that have used them, so it is rated level 3
    return has(b, level4_b) && has(saved_registers(), level4_saved) ? 4 : 3;
}

#else

int x86_level() { return 0; }

#endif

}  // namespace crumple
