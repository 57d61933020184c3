/* A C library whose mathematics differs from this one's in the last bit of each result. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#define ONE(name) double name(double x) { static double (*own)(double); \
    if (!own) own = dlsym(RTLD_NEXT, #name); double y = own(x); \
    return y == 0.0 || !isfinite(y) || y == rint(y) ? y : nextafter(y, INFINITY); }
#define TWO(name) double name(double x, double y) { static double (*own)(double, double); \
    if (!own) own = dlsym(RTLD_NEXT, #name); double z = own(x, y); \
    return z == 0.0 || !isfinite(z) || z == rint(z) ? z : nextafter(z, INFINITY); }
ONE(exp) ONE(exp2) ONE(expm1) ONE(log) ONE(log2) ONE(log10) ONE(log1p) ONE(sin) ONE(cos) ONE(tan)
ONE(asin) ONE(acos) ONE(atan) ONE(sinh) ONE(cosh) ONE(tanh) ONE(cbrt) TWO(pow) TWO(atan2) TWO(hypot)
