/* Strings, their tension, plucking, and the bridge. */

#pragma once

#include "common.h"

/* ---- string.py and tension.py --------------------------------------------------------------- */

static inline void advance_string(double *restrict u_next, const double *restrict u,
                                  const double *restrict u_prev, double *restrict bend,
                                  const double *restrict inside, int64_t N,
                                  const double *restrict B, const double *restrict C,
                                  double *restrict square_out, double *restrict along_out)
{
    const double b_0 = B[0], b_1 = B[1], b_2 = B[2], c_0 = C[0] + 2.0 * C[1], c_1 = C[1];
    const int64_t inner = whole_vectors(N - 1);
    double square = 0.0, along = 0.0;
    for (int64_t l = GHOST + 1; l < GHOST + 1 + inner; l++) {
        const double beside = u[l - 1] + u[l + 1];
        double star = b_0 * u[l] + b_1 * beside + b_2 * (u[l - 2] + u[l + 2]);
        star += c_0 * u_prev[l] + c_1 * bend[l];
        star *= inside[l];
        const double delta = (beside - 2.0 * u[l]) * inside[l];
        u_next[l] = star;
        bend[l] = delta;
        square += delta * delta;
        along += delta * (star + u_prev[l]);
    }
    *square_out = square;
    *along_out = along;
}

static inline void support(double *u, int64_t N)
{
    u[0] = -u[2];
    u[N + 2] = -u[N];
}

static inline void tighten(Model m, State s, int i, double *restrict slack, double *restrict give,
                           double *restrict stretched)
{
    *stretched = 1.0 + m->taut[i] * s->square[i];
    const double weight = m->taut[i] / *stretched;
    *slack = -s->along[i] * weight;
    *give = m->spread[i] * weight;
}

static inline void take_up(double *restrict u_next, const double *restrict bend, int64_t N,
                           double slack)
{
    const int64_t inner = whole_vectors(N - 1);
    for (int64_t l = GHOST + 1; l < GHOST + 1 + inner; l++)
        u_next[l] += slack * bend[l];
}

/* ---- pluck.py ------------------------------------------------------------------------------- */

static inline void pull_aside(Model m, State s, const double *restrict control,
                              double (*restrict u_next)[POINTS])
{
    const double force = control[F_PLUCK];
    if (force == 0.0)
        return;
    const int i = force > 0.0 ? 0 : 1;
    const double x = control[X_PLUCK];
    if (x != s->x_pluck || i != s->pluck_string) {
        s->x_pluck = x;
        s->pluck_string = (uint8_t)i;
        const double position = within(x / m->h[i], 1.0, (double)m->N[i] - 1.0);
        s->pluck_first = (uint16_t)place(position, m->N[i], s->pluck_weights, true);
    }
    const double moved = m->spread[i] * fabs(force);
    spread(u_next[i], s->pluck_first, s->pluck_weights, moved);
    s->along[i] += moved * reading(s->bend[i], s->pluck_first, s->pluck_weights);
}

/* ---- bridge.py ------------------------------------------------------------------------------ */

static inline double advance_bridge(Model m, double *restrict q_next, const double *restrict q,
                                    const double *restrict q_prev, double f_hammer)
{
    double total = 0.0;
    for (int j = 0; j < whole_vectors(m->modes); j++) {
        q_next[j] = m->A_q[j] * q[j] + m->B_q[j] * q_prev[j] + m->C_q[j] * f_hammer;
        total += q_next[j];
    }
    return total;
}

static inline void close_bridge(Model m, State s, double (*restrict u_next)[POINTS], double Q)
{
    double slack[STRINGS], give[STRINGS], stretched[STRINGS];
    double bend[STRINGS], gap[STRINGS], own[STRINGS];
    for (int i = 0; i < STRINGS; i++) {
        tighten(m, s, i, &slack[i], &give[i], &stretched[i]);
        bend[i] = reading(s->bend[i], m->bridge_first[i], m->bridge_weights[i]);
        gap[i] = Q - reading(u_next[i], m->bridge_first[i], m->bridge_weights[i]);
        gap[i] -= slack[i] * bend[i];
        own[i] = m->S_c[i][i] * stretched[i] - m->taut[i] * m->spread[i] * bend[i] * bend[i];
    }
    const double b = m->S_c[0][1], both = stretched[0] * stretched[1];
    const double per_determinant = 1.0 / (own[0] * own[1] - b * b * both);
    double (*S)[STRINGS] = s->S_c_inverse;
    S[0][0] = own[1] * stretched[0] * per_determinant;
    S[1][1] = own[0] * stretched[1] * per_determinant;
    S[0][1] = S[1][0] = -b * both * per_determinant;
    for (int i = 0; i < STRINGS; i++)
        s->f_c[i] = S[i][0] * gap[0] + S[i][1] * gap[1];
    for (int i = 0; i < STRINGS; i++) {
        const double lead = give[i] * bend[i];
        s->slack[i] = slack[i] - lead * s->f_c[i];
        for (int j = 0; j < STRINGS; j++) {
            s->tug[i][j] = -lead * S[i][j];
            s->give[i][j] = (i == j ? give[i] : 0.0) + lead * S[i][j] * (give[j] * bend[j]);
        }
    }
}

static inline double finish_bridge(Model m, double *restrict q_next, const double *restrict q_prev,
                                   double force)
{
    double travel = 0.0;
    for (int j = 0; j < whole_vectors(m->modes); j++) {
        q_next[j] -= m->C_q[j] * force;
        travel += q_next[j] - q_prev[j];
    }
    return travel;
}
