/* What all parts share: the records, small functions, and how a point force meets the grid. */

#pragma once

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "records.h"

/* ---- layout.py ------------------------------------------------------------------------------ */

typedef const struct model *restrict Model;
typedef struct state *restrict State;

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }
static inline double within(double x, double low, double high)
{
    return larger(low, smaller(x, high));
}

static inline int64_t whole_vectors(int64_t count)
{
    return (count + VECTOR - 1) & -VECTOR;
}

/* ---- elementary.py -------------------------------------------------------------------------- */

/* A sum that stays as it is written. gcc, once it may reorder sums, turns pairs of terms that need
 * not wait for each other back into a chain. */
#if defined(__has_builtin)
#if __has_builtin(__builtin_assoc_barrier)
#define PAIRED(sum) __builtin_assoc_barrier(sum)
#endif
#endif
#ifndef PAIRED
#define PAIRED(sum) (sum)
#endif

static inline int64_t bits_of(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double of_bits(int64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline void sine_and_cosine(double half_turns, double *sine, double *cosine)
{
    const double t = half_turns * half_turns, t_2 = t * t, t_4 = t_2 * t_2;
    const double s_low = PAIRED(S_0 + S_1 * t) + t_2 * PAIRED(S_2 + S_3 * t);
    const double s_high = PAIRED(S_4 + S_5 * t) + t_2 * PAIRED(S_6 + S_7 * t);
    const double c_low = PAIRED(C_0 + C_1 * t) + t_2 * PAIRED(C_2 + C_3 * t);
    const double c_high = PAIRED(C_4 + C_5 * t) + t_2 * PAIRED(C_6 + C_7 * t);
    *sine = half_turns * PAIRED(PAIRED(s_low) + t_4 * PAIRED(s_high));
    *cosine = PAIRED(c_low) + t_4 * PAIRED(c_high);
}

static inline double power_of_2(double x)
{
    const double twos = rint(x), t = x - twos, t_2 = t * t, t_4 = t_2 * t_2;
    const double low = PAIRED(P_0 + P_1 * t) + t_2 * PAIRED(P_2 + P_3 * t);
    const double middle = PAIRED(P_4 + P_5 * t) + t_2 * PAIRED(P_6 + P_7 * t);
    const double high = PAIRED(P_8 + P_9 * t) + t_2 * PAIRED(P_10 + P_11 * t);
    const int64_t exponent = (int64_t)twos > LEAST_EXPONENT ? (int64_t)twos : LEAST_EXPONENT;
    const double scale = of_bits((int64_t)((uint64_t)(exponent + EXPONENT_OF_1) << MANTISSA_BITS));
    return scale * PAIRED(PAIRED(PAIRED(low) + t_4 * PAIRED(middle)) + t_4 * t_4 * PAIRED(high));
}

static inline double slowing(double t)
{
    if (t < SLIGHT) {
        const double t_2 = t * t;
        return R_1 * t + t_2 * PAIRED(PAIRED(R_2 + R_3 * t) + t_2 * PAIRED(R_4 + R_5 * t));
    }
    const double root = sqrt(1.0 + t);
    return t / (root * (1.0 + root));
}

/* ---- power.py ------------------------------------------------------------------------------- */

static inline double power(Model m, double x)
{
    const uint64_t bits = (uint64_t)bits_of(x);
    const uint64_t exponent = (bits >> MANTISSA_BITS) & (EXPONENTS - 1);
    const uint64_t interval = (bits >> INTERVAL_SHIFT) & (INTERVALS - 1);
    const double part = of_bits((int64_t)((bits & MANTISSA_MASK) | BITS_OF_1));
    const double t = part * m->per_middle[interval] - 1.0, t_2 = t * t;
    const double *c = m->power_series;
    const double high = PAIRED(c[2] + c[3] * t) + t_2 * c[4];
    const double series = PAIRED(c[0] + c[1] * t) + t_2 * PAIRED(high);
    const double about = m->power_of_twos[exponent] * m->power_of_middle[interval];
    return about + about * t * PAIRED(series);
}

/* ---- stencil.py ----------------------------------------------------------------------------- */

static inline int64_t place(double position, int64_t N, double *restrict weights, bool cubic)
{
    int64_t l = (int64_t)position;
    l = l > N - 2 ? N - 2 : l;
    l = l < 1 ? 1 : l;
    const double a = position - (double)l;
    if (cubic) {
        weights[0] = -a * (a - 1.0) * (a - 2.0) / 6.0;
        weights[1] = (a - 1.0) * (a + 1.0) * (a - 2.0) / 2.0;
        weights[2] = -a * (a + 1.0) * (a - 2.0) / 2.0;
        weights[3] = a * (a + 1.0) * (a - 1.0) / 6.0;
    } else {
        weights[0] = 0.0;
        weights[1] = 1.0 - a;
        weights[2] = a;
        weights[3] = 0.0;
    }
    const int64_t first = l - 1;
    if (first == 0)
        weights[0] = 0.0;
    if (first + 3 == N)
        weights[3] = 0.0;
    return first;
}

static inline double reading(const double *u, int64_t first, const double *weights)
{
    const double *at = u + GHOST + first;
    return (weights[0] * at[0] + weights[1] * at[1]) + (weights[2] * at[2] + weights[3] * at[3]);
}

static inline void spread(double *restrict u, int64_t first, const double *restrict weights,
                          double amount)
{
    for (int j = 0; j < STENCIL; j++)
        u[GHOST + first + j] += weights[j] * amount;
}

static inline double overlap(int64_t first_p, const double *weights_p, int64_t first_q,
                             const double *weights_q)
{
    const int64_t shift = first_p - first_q;
    double total = 0.0;
    if (-STENCIL < shift && shift < STENCIL)
        for (int64_t j = 0; j < STENCIL; j++) {
            const int64_t at = j + shift;
            if (0 <= at && at < STENCIL)
                total += weights_p[j] * weights_q[at];
        }
    return total;
}
