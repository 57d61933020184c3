/* Bow and friction: bow.py and friction.py. */

#pragma once

#include "common.h"

static inline bool bristles_hold(double v_r, double z_bar, double z_ba)
{
    return v_r * z_bar <= 0.0 || fabs(z_bar) <= z_ba;
}

struct law {
    double r, by_v, by_z;
};

static inline struct law bristle_velocity(Model m, double v_r, double z_bar, double z_ba,
                                          double reach)
{
    if (bristles_hold(v_r, z_bar, z_ba))
        return (struct law){v_r, 1.0, 0.0};
    const double deflection = fabs(z_bar), steepness = 1.0 / (m->v_s * m->v_s);
    const double stribeck = reach * (m->mu_S - m->mu_C) * exponential(-v_r * v_r * steepness);
    const double z_ss = reach * m->mu_C + stribeck;
    const double dz_ss = -2.0 * v_r * steepness * stribeck;
    const double per_z_ss = 1.0 / z_ss, w = deflection * per_z_ss;
    double chi = 1.0, dchi = 0.0, dchi_ss = 0.0;
    if (deflection < z_ss) {
        const double per_width = M_PI / (z_ss - z_ba);
        double sine, cosine;
        sine_and_cosine((deflection - 0.5 * (z_ss + z_ba)) * per_width, &sine, &cosine);
        chi = 0.5 * (1.0 + sine);
        dchi = 0.5 * cosine * per_width;
        dchi_ss = -dchi * (deflection - z_ba) * per_width / M_PI;
    }
    return (struct law){
        v_r * (1.0 - chi * w),
        1.0 - chi * w - v_r * dz_ss * (dchi_ss * w - chi * w * per_z_ss),
        -fabs(v_r) * (dchi * w + chi * per_z_ss),
    };
}

struct grip {
    double f_b, z_bar, v_r, tangent[3];
    int iterations;
    bool converged;
};

static inline struct grip solve_friction(Model m, double free, double compliance, double z,
                                         double F, const double tangent[3], int string)
{
    const double epsilon_0 = m->epsilon_0, epsilon_1 = m->epsilon_1;
    const double rate = 2.0 / m->k, per_compliance = 1.0 / compliance;
    const double per_gamma = epsilon_1 / (m->mu_C * F), reach = F / epsilon_0;
    const double z_ba = m->xi[string] * m->mu_C * reach;
    const double limit = larger(1.2 * m->mu_S * reach, fabs(z));
    double low = free - compliance * (epsilon_0 * limit + epsilon_1 * rate * (limit - z));
    double high = free + compliance * (epsilon_0 * limit + epsilon_1 * rate * (limit + z));

    const double stiffness = epsilon_0 + rate * epsilon_1;
    const double pulled = free + compliance * rate * epsilon_1 * z;
    double v_r = (pulled - compliance * stiffness * z) / (1.0 + compliance * stiffness / rate);
    if (!bristles_hold(v_r, z + v_r / rate, z_ba)) {
        const double per_z = compliance * stiffness / (rate - tangent[2]);
        v_r = (pulled - per_z * (tangent[0] + rate * z)) / (1.0 + per_z * tangent[1]);
    }
    v_r = smaller(larger(v_r, low), high);

    const double per_v
        = M_PI * per_compliance / (stiffness * (m->mu_C * reach - z_ba)) + 2.0 / m->v_s;
    const double curvature = (1.0 + limit / (m->mu_C * reach)) * per_v;

    struct law law;
    double z_bar;
    bool converged = false;
    int iterations = 0;
    for (;;) {
        iterations++;
        const double slower = 1.0 + v_r * per_gamma * (v_r * per_gamma), root = sqrt(slower);
        const double per_stiffness = 1.0 / (epsilon_0 * root + rate * epsilon_1);
        z_bar = ((free - v_r) * per_compliance * root + rate * epsilon_1 * z) * per_stiffness;
        law = bristle_velocity(m, v_r, z_bar, z_ba, reach);
        const double residual = law.r - rate * (z_bar - z);
        if (fabs(residual) <= TOLERANCE * larger(1.0, fabs(law.r))) {
            converged = true;
            break;
        }
        if (iterations == MAX_ITERATIONS)
            break;
        if (residual > 0.0)
            high = v_r;
        else
            low = v_r;
        const double d_damping = epsilon_1 * v_r * per_gamma * per_gamma / slower;
        const double dz_bar
            = (d_damping * rate * (z_bar - z) - per_compliance * root) * per_stiffness;
        const double way = -residual / (law.by_v + (law.by_z - rate) * dz_bar);
        double step = v_r + way;
        const bool is_inside = low < step && step < high;
        const double bend = curvature * (1.0 + fabs(v_r) * per_v);
        if (is_inside && 0.5 * bend * way * way <= TOLERANCE) {
            const bool held = bristles_hold(v_r, z_bar, z_ba);
            v_r = step;
            z_bar += dz_bar * way;
            if (bristles_hold(v_r, z_bar, z_ba) == held) {
                converged = true;
                break;
            }
            continue;
        }
        if (!is_inside || (iterations > 12 && iterations % 2 == 0)) {
            step = 0.5 * (low + high);
            if (!(low < step && step < high)) {
                converged = fabs(residual) <= 1e3 * TOLERANCE * larger(1.0, fabs(law.r));
                break;
            }
        }
        v_r = step;
    }
    return (struct grip){
        .f_b = (free - v_r) * per_compliance,
        .z_bar = z_bar,
        .v_r = v_r,
        .tangent = {rate * (z_bar - z) - law.by_v * v_r - law.by_z * z_bar, law.by_v, law.by_z},
        .iterations = iterations,
        .converged = converged,
    };
}

static inline int choose_string(Model m, State s, double F_b, bool *bowed)
{
    int string = s->string[BOW];
    *bowed = fabs(F_b) >= m->lift_force;
    if (*bowed)
        string = F_b > 0.0 ? 0 : 1;
    for (int i = 0; i < STRINGS; i++)
        if (s->z[i] != 0.0 && !(*bowed && i == string)) {
            s->dropped_z += 0.5 * m->epsilon_0 * s->z[i] * s->z[i];
            s->z[i] = 0.0;
        }
    return string;
}
