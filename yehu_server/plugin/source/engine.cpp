/* Chooses among the instrument's versions; and the clock that it asks for, where a system has another
 * one than Linux.
 */
#include "engine.hpp"

#define VERSION_OF(prefix)                                                                         \
    {prefix##yehu_size, prefix##yehu_prepare,    prefix##yehu_reset,   prefix##yehu_post,           \
     prefix##yehu_midi, prefix##yehu_use_tables, prefix##yehu_process, prefix##yehu_frame,          \
     prefix##yehu_value, prefix##yehu_pitch,     prefix##yehu_snapshot}

#ifdef __x86_64__
#include <cpuid.h>

extern "C" {
decltype(yehu_size) wide_yehu_size;
decltype(yehu_prepare) wide_yehu_prepare;
decltype(yehu_reset) wide_yehu_reset;
decltype(yehu_post) wide_yehu_post;
decltype(yehu_midi) wide_yehu_midi;
decltype(yehu_use_tables) wide_yehu_use_tables;
decltype(yehu_process) wide_yehu_process;
decltype(yehu_frame) wide_yehu_frame;
decltype(yehu_value) wide_yehu_value;
decltype(yehu_pitch) wide_yehu_pitch;
decltype(yehu_snapshot) wide_yehu_snapshot;
}

namespace {

/* Whether processor and system have all of x86-64-v3. */
bool is_wide() {
    unsigned a, b, c, d;
    const unsigned first = bit_FMA | bit_MOVBE | bit_OSXSAVE | bit_AVX | bit_F16C;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & first) != first) return false;
    unsigned low, high;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    if ((low & 6) != 6) return false; /* the system keeps the wide registers */
    const unsigned second = bit_AVX2 | bit_BMI | bit_BMI2;
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d) || (b & second) != second) return false;
    return __get_cpuid(0x80000001, &a, &b, &c, &d) && (c & (1u << 5)); /* LZCNT */
}

} /* namespace */

const yehu::Engine &yehu::engine() {
    static const Engine any = VERSION_OF(), wide = VERSION_OF(wide_);
    return is_wide() ? wide : any;
}
#else
const yehu::Engine &yehu::engine() {
    static const Engine any = VERSION_OF();
    return any;
}
#endif

#if defined(_WIN32)
#include <windows.h>
#elif defined(__APPLE__)
#include <time.h>
#endif

#if defined(_WIN32) || defined(__APPLE__)
/* Kind 1 is monotonic; the others, of a thread, are for meters that no host sees. */
extern "C" int yehu_clock(int kind, int64_t *time) {
    time[0] = time[1] = 0;
    if (kind != 1) return 0;
#ifdef _WIN32
    LARGE_INTEGER now, rate;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&rate);
    time[0] = now.QuadPart / rate.QuadPart;
    time[1] = now.QuadPart % rate.QuadPart * 1000000000LL / rate.QuadPart;
#else
    const uint64_t now = clock_gettime_nsec_np(CLOCK_UPTIME_RAW);
    time[0] = (int64_t)(now / 1000000000), time[1] = (int64_t)(now % 1000000000);
#endif
    return 0;
}
#endif
