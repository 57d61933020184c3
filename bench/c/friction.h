/* Bow and friction: bow.py and friction.py. */

#pragma once

#include "common.h"

static inline bool bristles_hold(double v_r, double z_bar, double z_ba)
{
    return v_r * z_bar <= 0.0 || fabs(z_bar) <= z_ba;
}

struct imbalance {
    double residual, slope, curve, by_z, room, closing;
};

static inline struct imbalance imbalance(Model m, double v_r, double z, double turn, double other,
                                         double turn_other, double z_ba, double reach)
{
    if (bristles_hold(v_r, z, z_ba))
        return (struct imbalance){v_r - other, 1.0 - turn_other, 0.0, 0.0, 1.0, 0.0};
    const double deflection = fabs(z), steepness = m->per_v_s * m->per_v_s;
    turn = copysign(1.0, z) * turn;
    const double stribeck
        = reach * (m->mu_S - m->mu_C) * power_of_2(v_r * v_r * (-PER_LN_2 * steepness));
    const double z_ss = reach * m->mu_C + stribeck, fall = -2.0 * v_r * steepness;
    const double dz_ss = fall * stribeck, ddz_ss = (fall * fall - 2.0 * steepness) * stribeck;
    const double per_z_ss = 1.0 / z_ss, w = deflection * per_z_ss;
    const double dw = (turn - w * dz_ss) * per_z_ss;
    const double ddw = (-2.0 * dw * dz_ss - w * ddz_ss) * per_z_ss;
    const double room = z_ss - deflection, closing = dz_ss - turn;
    double per_width = 0.0, sine = 1.0, cosine = 0.0, dangle = 0.0, ddangle = 0.0;
    if (room > 0.0) {
        per_width = 1.0 / (stribeck + (reach * m->mu_C - z_ba));
        const double place = (deflection - 0.5 * (z_ss + z_ba)) * per_width, part = place + 0.5;
        sine_and_cosine(place, &sine, &cosine);
        dangle = M_PI * (turn - part * dz_ss) * per_width;
        ddangle = (-M_PI * part * ddz_ss - 2.0 * dangle * dz_ss) * per_width;
    }
    const double rise = 1.0 + sine, half = 0.5 * (v_r * w), dhalf = 0.5 * (w + v_r * dw);
    const double swing = half * dangle;
    return (struct imbalance){
        .residual = PAIRED(v_r - other) - half * rise,
        .slope = PAIRED(1.0 - turn_other - swing * cosine) - dhalf * rise,
        .curve = PAIRED(-0.5 * (swing * dangle)
                        - PAIRED(dangle * dhalf + 0.5 * (half * ddangle)) * cosine)
                 + 0.5 * PAIRED(swing * dangle - dw - 0.5 * (v_r * ddw)) * rise,
        .by_z = -0.5 * fabs(v_r) * (M_PI * w * per_width * cosine + per_z_ss * rise),
        .room = room,
        .closing = closing,
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
    const double epsilon_0 = m->epsilon_0, stiffness = m->stiffness;
    const double rate = 2.0 * m->rate, half_k = 0.5 * m->k, damping = rate * m->epsilon_1;
    const double per_F = 1.0 / F, per_gamma = m->epsilon_1 / m->mu_C * per_F;
    const double per_gamma_2 = per_gamma * per_gamma, reach = F / epsilon_0;
    const double z_ba = m->xi[string] * m->mu_C * reach, per_compliance = 1.0 / compliance;

    const double pulled = free - compliance * epsilon_0 * z;
    const double firmness = 1.0 + compliance * stiffness * half_k, per_firmness = 1.0 / firmness;
    double v_r = pulled * per_firmness;
    if (bristles_hold(pulled, firmness * z + pulled * half_k, firmness * z_ba)) {
        const double excess = compliance * m->epsilon_1 * per_firmness;
        const double over = pulled * (per_firmness * per_gamma), slow = slowing(over * over);
        const double step = v_r + v_r * excess * slow, z_bar = z + step * half_k;
        if (400.0 * fabs(v_r) * (excess * slow) * (excess * slow) <= TOLERANCE
            && bristles_hold(step, z_bar, z_ba))
            return (struct grip){
                .f_b = PAIRED((free - v_r) * per_compliance)
                       - v_r * (excess * per_compliance) * slow,
                .z_bar = z_bar,
                .v_r = step,
                .tangent = {0.0, 1.0, 0.0},
                .iterations = 1,
                .converged = true,
            };
    } else {
        const double per_z = stiffness / (rate - tangent[2]);
        v_r = free + compliance * (damping * z - per_z * (tangent[0] + rate * z));
        v_r *= 1.0 / (1.0 + compliance * (per_z * tangent[1]));
    }
    const double limit = larger(1.2 * m->mu_S * reach, fabs(z));
    double low = free - compliance * (epsilon_0 * limit + damping * (limit - z));
    double high = free + compliance * (epsilon_0 * limit + damping * (limit + z));
    v_r = smaller(larger(v_r, low), high);

    const double per_v = m->sharpness[string] * per_F * per_compliance + 2.0 * m->per_v_s;
    const double jolt = (1.0 + limit * epsilon_0 / m->mu_C * per_F) * per_v * per_v / 6.0;
    const double fastest = larger(high, -low);
    const double sag = damping * rate * (limit + per_compliance * fastest / epsilon_0)
                       * (per_gamma_2 / epsilon_0);

    struct imbalance at;
    const double at_rest = free * per_compliance - epsilon_0 * z;
    double f_b, z_bar, turn;
    bool converged = false;
    int iterations = 0;
    for (;;) {
        iterations++;
        const double slow = slowing(v_r * v_r * per_gamma_2);
        const double ease = 1.0 / (stiffness - damping * slow);
        const double moved = (at_rest - v_r * per_compliance) * ease, r = rate * moved;
        const double fast = 1.0 - slow, dslow = fast * fast * fast * per_gamma_2 * v_r;
        z_bar = z + moved;
        turn = (moved * damping * dslow - per_compliance) * ease;
        at = imbalance(m, v_r, z_bar, turn, r, rate * turn, z_ba, reach);
        f_b = (free - v_r) * per_compliance;
        if (fabs(at.residual) <= TOLERANCE * larger(1.0, fabs(r))) {
            converged = true;
            break;
        }
        if (iterations == MAX_ITERATIONS)
            break;
        if (at.residual > 0.0)
            high = v_r;
        else
            low = v_r;
        const double steep_2 = at.slope * at.slope;
        const double way = -at.residual * at.slope
                           / larger(steep_2 - at.residual * at.curve, 0.5 * steep_2);
        double step = v_r + way;
        const bool is_inside = low < step && step < high;
        double missed = at.curve * at.curve * fabs(at.residual);
        missed += (jolt * (1.0 + fabs(v_r) * per_v) * fabs(way) + sag) * steep_2;
        missed *= way * way;
        if (is_inside && missed <= TOLERANCE * steep_2
            && at.room * (at.room + at.closing * way) > 0.0) {
            const bool held = bristles_hold(v_r, z_bar, z_ba);
            v_r = step;
            z_bar += way * turn;
            if (bristles_hold(v_r, z_bar, z_ba) == held) {
                f_b -= way * per_compliance;
                converged = true;
                break;
            }
            continue;
        }
        if (!is_inside || (iterations > 12 && iterations % 2 == 0)) {
            step = 0.5 * (low + high);
            if (!(low < step && step < high)) {
                converged = fabs(at.residual) <= 1e3 * TOLERANCE * larger(1.0, fabs(r));
                break;
            }
        }
        v_r = step;
    }
    const double by_v = at.slope + (rate - at.by_z) * turn;
    return (struct grip){
        .f_b = f_b,
        .z_bar = z_bar,
        .v_r = v_r,
        .tangent = {rate * (z_bar - z) - by_v * v_r - at.by_z * z_bar, by_v, at.by_z},
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
