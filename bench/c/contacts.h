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

static inline void place_contacts(Model m, State s, const double *restrict control,
                                  int bowed_string)
{
    const double x_b = control[X_B];
    if (s->placed == 0 || s->x[BOW] != x_b || s->string[BOW] != bowed_string) {
        const int i = bowed_string;
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
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * j + i;
            s->x[p] = x_f;
            s->string[p] = (uint8_t)i;
            const double position = within(x_f / m->h[i], 1.0, (double)m->N[i] - 1.0);
            s->first[p] = (uint16_t)place(position, m->N[i], s->weights[p], true);
            meet_bridge(m, s, p);
        }
    }
    s->placed = 1;
}

static inline void feel(State s, const double (*restrict u_next)[POINTS], int p)
{
    const int i = s->string[p];
    const double bend_at = reading(s->bend[i], s->first[p], s->weights[p]);
    const double at_bridge = s->shared_with_bridge[p] - s->give[i] * s->bend_at_bridge[i] * bend_at;
    s->bend_at[p] = bend_at;
    s->at_bridge[p] = at_bridge;
    for (int j = 0; j < STRINGS; j++)
        s->pull[p][j] = s->S_c_inverse[j][i] * at_bridge;
    s->free[p] = reading(u_next[i], s->first[p], s->weights[p]) + s->slack[i] * bend_at
        + at_bridge * s->f_c[i];
}

static inline double answer(Model m, const struct state *s, int p, int q)
{
    const int i = s->string[p];
    double G = -s->at_bridge[p] * s->pull[q][i];
    if (p == q)
        G += s->yields[p];
    else if (s->string[q] == i)
        G += m->spread[i] * overlap(s->first[p], s->weights[p], s->first[q], s->weights[q]);
    if (s->string[q] == i)
        G -= s->give[i] * s->bend_at[p] * s->bend_at[q];
    return G;
}

static inline void feel_all(Model m, State s, const double (*restrict u_next)[POINTS], int near)
{
    feel(s, u_next, BOW);
    for (int c = 0; c < near; c++) {
        const int p = s->near[c];
        feel(s, u_next, p);
        s->at_bow[p] = answer(m, s, p, BOW);
    }
}

static inline void push(State s, int p, double force)
{
    const int i = s->string[p];
    s->slack[i] += s->give[i] * s->bend_at[p] * force;
    s->f_c[0] += s->pull[p][0] * force;
    s->f_c[1] += s->pull[p][1] * force;
}

static inline void move(Model m, State s, double (*restrict u_next)[POINTS], int touching,
                        bool bowed)
{
    for (int i = 0; i < STRINGS; i++) {
        s->slack[i] -= s->give[i] * s->bend_at_bridge[i] * s->f_c[i];
        if (s->slack[i] != 0.0)
            take_up(u_next[i], s->bend[i], m->N[i], s->slack[i]);
        spread(u_next[i], m->bridge_first[i], m->bridge_weights[i], m->spread[i] * s->f_c[i]);
    }
    for (int c = 0; c < touching; c++) {
        const int p = s->touching[c], i = s->string[p];
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
    for (int j = 0; j < m->fingers; j++) {
        const double press = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j + 1];
        s->U[next][j] = advance_finger(m, s, j, press, now, prev);
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * j + i;
            const double eta = reading(s->u[now][i], s->first[p], s->weights[p]) - s->U[now][j];
            if (s->Psi[p] != 0.0 && (eta <= 0.0 || s->Psi[p] < 0.0)) {
                s->dropped_Psi += 0.5 * s->Psi[p] * s->Psi[p];
                s->Psi[p] = 0.0;
            }
            s->g[p] = 0.0;
            s->f_f[p] = 0.0;
            if (eta > 0.0) {
                s->near[near++] = (uint8_t)p;
                s->ghat[p] = power(m, eta);
                s->eta_prev[p]
                    = reading(s->u[prev][i], s->first[p], s->weights[p]) - s->U[prev][j];
            }
        }
    }
    return near;
}

static inline int press_fingers(Model m, State s, int next, int near, double f_b, double doubt,
                                bool *friction_decides)
{
    int touching = 0;
    *friction_decides = false;
    for (int c = 0; c < near; c++) {
        const int p = s->near[c];
        const double Psi = s->Psi[p], ghat = s->ghat[p], at_bow = s->at_bow[p];
        const double free = s->free[p] - s->U[next][p / STRINGS] - s->eta_prev[p];
        const double travel = free - at_bow * f_b;
        if (4.0 * Psi + ghat * (travel - fabs(at_bow) * doubt) < 0.0 && at_bow != 0.0)
            *friction_decides = true;
        const double g = 4.0 * Psi + ghat * travel < 0.0 ? -4.0 * Psi / travel : ghat;
        s->g[p] = g;
        if (g > 0.0) {
            const double A_f = 0.25 * g * g + 0.5 * m->rate * m->beta * g * Psi;
            s->touching[touching] = (uint8_t)p;
            s->A_f[touching] = A_f;
            s->d[touching] = A_f * free + g * Psi;
            touching++;
        }
    }
    return touching;
}

static inline void close_contacts(Model m, State s, int touching, double *restrict taken_out,
                                  double *restrict taken_per_newton_out)
{
    const int bow = touching;
    for (int row = 0; row < touching; row++) {
        const int p = s->touching[row];
        for (int column = 0; column <= row; column++) {
            const int q = s->touching[column];
            double G = answer(m, s, p, q);
            if (p / STRINGS == q / STRINGS)
                G += m->C_f;
            s->G[column][row] = G;
        }
        s->G[row][bow] = s->at_bow[p];
    }
    double taken = 0.0, taken_per_newton = 0.0;
    for (int row = 0; row < touching; row++) {
        const double per_stiffness = 1.0 / (1.0 + s->A_f[row] * s->G[row][row]);
        const double d = s->d[row] * per_stiffness, A_f = s->A_f[row] * per_stiffness;
        s->d[row] = d;
        s->A_f[row] = A_f;
        for (int other = row + 1; other < touching; other++) {
            const double G = s->G[row][other];
            s->d[other] -= s->A_f[other] * G * d;
            for (int column = other; column <= bow; column++)
                s->G[other][column] -= A_f * G * s->G[row][column];
        }
        const double G = s->G[row][bow];
        taken += G * d;
        taken_per_newton += G * G * A_f;
    }
    *taken_out = taken;
    *taken_per_newton_out = taken_per_newton;
}

static inline void push_fingers(Model m, State s, int next, int touching, double f_b)
{
    for (int row = touching - 1; row >= 0; row--) {
        const int p = s->touching[row];
        double pushed = s->G[row][touching] * f_b;
        for (int other = row + 1; other < touching; other++)
            pushed += s->G[row][other] * s->f_f[s->touching[other]];
        const double f_f = s->d[row] - s->A_f[row] * pushed, g = s->g[p], Psi = s->Psi[p];
        s->f_f[p] = f_f;
        push(s, p, f_f);
        s->U[next][p / STRINGS] += m->C_f * f_f;
        s->Psi[p] += 0.5 * (f_f - g * Psi) / (0.25 * g + 0.5 * m->rate * m->beta * Psi);
    }
}
