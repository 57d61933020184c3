/* Where bow and fingers touch the strings, and the fingers. */

#pragma once

#include "strings_and_bridge.h"

/* ---- contacts.py ---------------------------------------------------------------------------- */

static inline void meet_bridge(Model m, State s, int p)
{
    const int i = s->string[p];
    const double *weights = s->weights[p];
    s->yields[p] = m->spread[i] * overlap(s->first[p], weights, s->first[p], weights);
    s->shared_with_bridge[p] = m->spread[i]
        * overlap(m->bridge_first[i], m->bridge_weights[i], s->first[p], weights);
}

static inline void sort_fingers(Model m, State s)
{
    for (int j = 0; j < m->fingers; j++) {
        int k = j;
        for (; k > 0 && s->x[STRINGS * s->order[k - 1]] > s->x[STRINGS * j]; k--)
            s->order[k] = s->order[k - 1];
        s->order[k] = (uint8_t)j;
    }
}

static inline bool place_contacts(Model m, State s, const double *restrict control,
                                  int bowed_string)
{
    bool moved = false;
    const double x_b = control[X_B];
    if (s->placed == 0 || s->x[BOW] != x_b || s->string[BOW] != bowed_string) {
        const int i = bowed_string;
        moved = true;
        s->x[BOW] = x_b;
        s->string[BOW] = (uint8_t)i;
        const double position = within(x_b / m->h[i], 1.0, m->bridge_x / m->h[i] - 1.0);
        s->first[BOW] = (uint16_t)place(position, m->N[i], s->weights[BOW], false);
        meet_bridge(m, s, BOW);
    }
    for (int j = 0; j < m->fingers; j++) {
        const double x_f = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j];
        if (s->placed != 0 && s->x[STRINGS * j] == x_f)
            continue;
        moved = true;
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * j + i;
            s->x[p] = x_f;
            s->string[p] = (uint8_t)i;
            const double position = within(x_f / m->h[i], 1.0, (double)m->N[i] - 1.0);
            s->first[p] = (uint16_t)place(position, m->N[i], s->weights[p], true);
            meet_bridge(m, s, p);
        }
    }
    if (moved)
        sort_fingers(m, s);
    s->placed = 1;
    return moved;
}

/* What a newton at a contact does: slack of both strings (1/N), and f_c (1). */
struct reply {
    double slack[STRINGS], pull[STRINGS];
};

static inline double feel(State s, const double (*restrict u_next)[POINTS], int p)
{
    const int i = s->string[p];
    return reading(u_next[i], s->first[p], s->weights[p]) + s->slack[i] * s->bend_at[p]
        + s->shared_with_bridge[p] * s->f_c[i];
}

static inline struct reply reply(State s, int q)
{
    const int i = s->string[q];
    const double bend = s->bend_at[q], shared = s->shared_with_bridge[q];
    struct reply of_q;
    for (int j = 0; j < STRINGS; j++) {
        of_q.slack[j] = s->give[j][i] * bend + s->tug[j][i] * shared;
        of_q.pull[j] = s->tug[i][j] * bend + s->S_c_inverse[j][i] * shared;
    }
    return of_q;
}

static inline double answer(Model m, const struct state *s, int p, int q, struct reply of_q)
{
    const int i = s->string[p];
    double G = -s->bend_at[p] * of_q.slack[i] - s->shared_with_bridge[p] * of_q.pull[i];
    if (p == q)
        G += s->yields[p];
    else if (s->string[q] == i)
        G += m->spread[i] * overlap(s->first[p], s->weights[p], s->first[q], s->weights[q]);
    return G;
}

static inline bool is_apart(const struct state *s, int p, int q)
{
    const int distance = (int)s->first[p] - (int)s->first[q];
    return s->string[p] != s->string[q] || distance <= -STENCIL || distance >= STENCIL;
}

static inline void move(Model m, State s, double (*restrict u_next)[POINTS], int near, bool bowed)
{
    for (int i = 0; i < STRINGS; i++) {
        if (s->slack[i] != 0.0)
            take_up(u_next[i], s->bend[i], m->N[i], s->slack[i]);
        spread(u_next[i], m->bridge_first[i], m->bridge_weights[i], m->spread[i] * s->f_c[i]);
    }
    for (int c = 0; c < near; c++)
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * s->near[c] + i;
            spread(u_next[i], s->first[p], s->weights[p], -m->spread[i] * s->f_f[p]);
        }
    if (bowed) {
        const int i = s->string[BOW];
        spread(u_next[i], s->first[BOW], s->weights[BOW], -m->spread[i] * s->f_b);
    }
}

/* ---- finger.py ------------------------------------------------------------------------------ */

static inline double advance_finger(Model m, State s, int j, double press, int now, int prev)
{
    const double U = s->U[now][j], U_prev = s->U[prev][j];
    if (press > 0.0)
        s->f_ext[j] = -press;
    else
        s->f_ext[j] = m->K_lift * (m->rest_height - U) - m->R_lift * m->rate * (U - U_prev);
    return 2.0 * U - U_prev + m->C_f * s->f_ext[j];
}

static inline int meet_fingers(Model m, State s, const double *restrict control, int next, int now,
                               int prev)
{
    int near = 0;
    double x_f = -1.0, reading_1 = 0.0, reading_2 = 0.0;
    s->are_near = 0;
    for (int k = 0; k < m->fingers; k++) {
        const int j = s->order[k];
        const double press = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j + 1];
        const double U = s->U[now][j];
        if (s->still[j] && press <= 0.0) {
            const int p = STRINGS * j, q = p + 1;
            if (s->x[p] != x_f) {
                x_f = s->x[p];
                reading_1 = reading(s->u[now][0], s->first[p], s->weights[p]);
                reading_2 = reading(s->u[now][1], s->first[q], s->weights[q]);
            }
            if (reading_1 <= U && reading_2 <= U) {
                s->U[next][j] = U;
                continue;
            }
        }
        bool is_near = false;
        s->U[next][j] = advance_finger(m, s, j, press, now, prev);
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * j + i, first = s->first[p];
            const double *weights = s->weights[p];
            const double eta = reading(s->u[now][i], first, weights) - U;
            if (s->Psi[p] != 0.0 && (eta <= 0.0 || s->Psi[p] < 0.0)) {
                s->dropped_Psi += 0.5 * s->Psi[p] * s->Psi[p];
                s->Psi[p] = 0.0;
            }
            double ghat = 0.0;
            if (eta > 0.0) {
                is_near = true;
                ghat = power(m, eta);
                s->bend_at[p] = reading(s->bend[i], first, weights);
                s->eta_prev[p] = reading(s->u[prev][i], first, weights) - s->U[prev][j];
            }
            s->g[p] = s->ghat[p] = ghat;
            s->f_f[p] = 0.0;
        }
        s->still[j] = 0;
        if (is_near) {
            s->near[near++] = (uint8_t)j;
            s->are_near |= 1 << j;
        } else if (press <= 0.0 && s->U[next][j] == U && U == s->U[prev][j]) {
            s->still[j] = 1;
        }
    }
    return near;
}

static inline bool may_leave(const struct state *s, int p, double f_b, double doubt)
{
    const double at_bow = s->at_bow[p];
    const double travel = s->travel[p] - at_bow * f_b - fabs(at_bow) * doubt;
    return 4.0 * s->Psi[p] + s->ghat[p] * travel < 0.0;
}

static inline void limit_fingers(State s, int near, double f_b)
{
    for (int c = 0; c < near; c++)
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * s->near[c] + i;
            const double travel = s->travel[p] - s->at_bow[p] * f_b;
            const double ghat = s->ghat[p];
            s->g[p] = 4.0 * s->Psi[p] + ghat * travel < 0.0 ? -4.0 * s->Psi[p] / travel : ghat;
        }
}

static inline double stiffness(Model m, const struct state *s, int p)
{
    const double g = s->g[p];
    return 0.25 * g * g + 0.5 * m->rate * m->beta * g * s->Psi[p];
}

static inline void settle(Model m, State s, int next, int p, double f_f)
{
    const double g = s->g[p], Psi = s->Psi[p];
    s->f_f[p] = f_f;
    s->U[next][p / STRINGS] += m->C_f * f_f;
    if (g > 0.0)
        s->Psi[p] += 0.5 * (f_f - g * Psi) / (0.25 * g + 0.5 * m->rate * m->beta * Psi);
}
