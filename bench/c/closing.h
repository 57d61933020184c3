/* The contacts' forces, all of one step together. */

#pragma once

#include "contacts.h"

/* ---- closing.py ----------------------------------------------------------------------------- */

/* What closed contacts take from the bow: of its reading (m), and for each newton (m/N). */
struct taken {
    double reading, per_newton;
};

/* A symmetric matrix of two rows. */
struct weight {
    double on_11, on_12, on_22;
};

static inline void note_neighbours(Model m, State s, int near)
{
    s->clear = 1;
    for (int a = 0; a < near; a++) {
        s->meets[a] = 0;
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * s->near[a] + i;
            if (s->shared_with_bridge[p] != 0.0 || !is_apart(s, p, BOW))
                s->clear = 0;
            for (int b = 0; b < a - 1; b++)
                if (!is_apart(s, p, STRINGS * s->near[b] + i))
                    s->clear = 0;
            if (a > 0) {
                const int q = STRINGS * s->near[a - 1] + i;
                const double shared
                    = overlap(s->first[p], s->weights[p], s->first[q], s->weights[q]);
                s->shared[a][i] = m->spread[i] * shared;
                if (shared != 0.0)
                    s->meets[a] = 1;
            }
        }
    }
}

static inline struct weight weigh_fingers(Model m, State s, int near)
{
    const double C_f = m->C_f;
    struct weight Q = {0.0, 0.0, 0.0};
    double W_11 = 0.0, W_12 = 0.0, W_22 = 0.0;
    double Wb_11 = 0.0, Wb_12 = 0.0, Wb_21 = 0.0, Wb_22 = 0.0;
    for (int a = 0; a < near; a++) {
        const int p = STRINGS * s->near[a], q = p + 1;
        double yield_p = s->yields[p] + C_f, across = C_f, yield_q = s->yields[q] + C_f;
        double b_11 = s->bend_at[p], b_12 = 0.0, b_21 = 0.0, b_22 = s->bend_at[q];
        if (s->meets[a]) {
            const double shared_p = s->shared[a][0], shared_q = s->shared[a][1];
            yield_p -= shared_p * shared_p * W_11;
            across -= shared_p * shared_q * W_12;
            yield_q -= shared_q * shared_q * W_22;
            b_11 -= shared_p * Wb_11;
            b_12 = -shared_p * Wb_12;
            b_21 = -shared_q * Wb_21;
            b_22 -= shared_q * Wb_22;
        }
        const double A_p = stiffness(m, s, p), A_q = stiffness(m, s, q);
        const double on_p = 1.0 + A_p * yield_p, on_q = 1.0 + A_q * yield_q;
        W_12 = -A_p * across * A_q;
        const double per_determinant = 1.0 / (on_p * on_q + W_12 * across);
        W_12 *= per_determinant;
        W_11 = A_p * on_q * per_determinant;
        W_22 = A_q * on_p * per_determinant;
        s->W[a][0] = W_11;
        s->W[a][1] = W_12;
        s->W[a][2] = W_22;
        const double held_p = s->g[p] * s->Psi[p], held_q = s->g[q] * s->Psi[q];
        s->held[p] = (held_p * on_q - held_q * A_p * across) * per_determinant;
        s->held[q] = (held_q * on_p - held_p * A_q * across) * per_determinant;
        s->slackens[a][0][0] = b_11;
        s->slackens[a][0][1] = b_12;
        s->slackens[a][1][0] = b_21;
        s->slackens[a][1][1] = b_22;
        Wb_11 = W_11 * b_11 + W_12 * b_21;
        Wb_12 = W_11 * b_12 + W_12 * b_22;
        Wb_21 = W_12 * b_11 + W_22 * b_21;
        Wb_22 = W_12 * b_12 + W_22 * b_22;
        Q.on_11 += b_11 * Wb_11 + b_21 * Wb_21;
        Q.on_12 += b_12 * Wb_11 + b_22 * Wb_21;
        Q.on_22 += b_12 * Wb_12 + b_22 * Wb_22;
    }
    return Q;
}

static inline bool feel_fingers(Model m, State s, const double (*restrict u_next)[POINTS], int next,
                                int near, struct reply of_bow, double f_b, double doubt)
{
    bool leaving = false;
    for (int a = 0; a < near; a++)
        for (int i = 0; i < STRINGS; i++) {
            const int j = s->near[a], p = STRINGS * j + i;
            if (s->clear)
                s->at_bow[p] = -s->bend_at[p] * of_bow.slack[i];
            else
                s->at_bow[p] = answer(m, s, p, BOW, of_bow);
            s->travel[p] = feel(s, u_next, p) - s->U[next][j] - s->eta_prev[p];
            leaving |= may_leave(s, p, f_b, doubt);
        }
    return leaving;
}

static inline struct taken close_in_turn(State s, int near, struct weight Q, struct reply of_bow)
{
    double sum_1 = 0.0, sum_2 = 0.0, f_p = 0.0, f_q = 0.0;
    for (int a = 0; a < near; a++) {
        const int p = STRINGS * s->near[a], q = p + 1;
        const double *W = s->W[a];
        double travel_p = s->travel[p], travel_q = s->travel[q];
        if (s->meets[a]) {
            travel_p -= s->shared[a][0] * f_p;
            travel_q -= s->shared[a][1] * f_q;
        }
        f_p = W[0] * travel_p + W[1] * travel_q + s->held[p];
        f_q = W[1] * travel_p + W[2] * travel_q + s->held[q];
        s->f_f[p] = f_p;
        s->f_f[q] = f_q;
        sum_1 += s->slackens[a][0][0] * f_p + s->slackens[a][1][0] * f_q;
        sum_2 += s->slackens[a][0][1] * f_p + s->slackens[a][1][1] * f_q;
    }
    const double give_11 = s->give[0][0], give_12 = s->give[0][1], give_22 = s->give[1][1];
    const double a = 1.0 - (Q.on_11 * give_11 + Q.on_12 * give_12);
    const double b = Q.on_11 * give_12 + Q.on_12 * give_22;
    const double c = Q.on_12 * give_11 + Q.on_22 * give_12;
    const double d = 1.0 - (Q.on_12 * give_12 + Q.on_22 * give_22);
    const double per_determinant = 1.0 / (a * d - b * c);
    const double bow_1 = of_bow.slack[0], bow_2 = of_bow.slack[1];
    const double by_bow_1 = Q.on_11 * bow_1 + Q.on_12 * bow_2;
    const double by_bow_2 = Q.on_12 * bow_1 + Q.on_22 * bow_2;
    const double of_1 = (d * sum_1 + b * sum_2) * per_determinant;
    const double of_2 = (a * sum_2 + c * sum_1) * per_determinant;
    const double more_1 = (d * by_bow_1 + b * by_bow_2) * per_determinant;
    const double more_2 = (a * by_bow_2 + c * by_bow_1) * per_determinant;
    s->slackened[0] = give_11 * of_1 + give_12 * of_2;
    s->slackened[1] = give_12 * of_1 + give_22 * of_2;
    s->slack_per_newton[0] += give_11 * more_1 + give_12 * more_2;
    s->slack_per_newton[1] += give_12 * more_1 + give_22 * more_2;
    for (int i = 0; i < STRINGS; i++) {
        s->slack[i] += s->slackened[i];
        s->f_c[i] += s->tug[0][i] * of_1 + s->tug[1][i] * of_2;
        s->f_c_per_newton[i] += s->tug[0][i] * more_1 + s->tug[1][i] * more_2;
    }
    return (struct taken){-(bow_1 * of_1 + bow_2 * of_2), bow_1 * more_1 + bow_2 * more_2};
}

static inline void push_in_turn(Model m, State s, int next, int near, double f_b)
{
    const double slack_1 = s->slackened[0] + s->slack_per_newton[0] * f_b;
    const double slack_2 = s->slackened[1] + s->slack_per_newton[1] * f_b;
    double f_p = 0.0, f_q = 0.0;
    for (int a = near - 1; a >= 0; a--) {
        const int p = STRINGS * s->near[a], q = p + 1;
        const double *W = s->W[a];
        double way_p = s->slackens[a][0][0] * slack_1 + s->slackens[a][0][1] * slack_2;
        double way_q = s->slackens[a][1][0] * slack_1 + s->slackens[a][1][1] * slack_2;
        if (a + 1 < near && s->meets[a + 1]) {
            way_p -= s->shared[a + 1][0] * f_p;
            way_q -= s->shared[a + 1][1] * f_q;
        }
        f_p = s->f_f[p] + W[0] * way_p + W[1] * way_q;
        f_q = s->f_f[q] + W[1] * way_p + W[2] * way_q;
        settle(m, s, next, p, f_p);
        settle(m, s, next, q, f_q);
    }
}

static inline struct taken close_together(Model m, State s, int near)
{
    int bow = 0;
    for (int c = 0; c < near; c++)
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * s->near[c] + i;
            if (s->g[p] > 0.0) {
                s->touching[bow] = (uint8_t)p;
                s->A_f[bow] = stiffness(m, s, p);
                s->d[bow] = s->A_f[bow] * s->travel[p] + s->g[p] * s->Psi[p];
                bow++;
            }
        }
    s->contacts = bow;
    for (int row = 0; row < bow; row++) {
        const int p = s->touching[row];
        const struct reply of_p = reply(s, p);
        for (int column = 0; column <= row; column++) {
            const int q = s->touching[column];
            double G = answer(m, s, q, p, of_p);
            if (p / STRINGS == q / STRINGS)
                G += m->C_f;
            s->G[column][row] = G;
        }
        s->G[row][bow] = s->at_bow[p];
    }
    struct taken taken = {0.0, 0.0};
    for (int row = 0; row < bow; row++) {
        const double per_stiffness = 1.0 / (1.0 + s->A_f[row] * s->G[row][row]);
        const double d = s->d[row] * per_stiffness, A_f = s->A_f[row] * per_stiffness;
        s->d[row] = d;
        s->A_f[row] = A_f;
        for (int other = row + 1; other < bow; other++) {
            const double G = s->G[row][other];
            s->d[other] -= s->A_f[other] * G * d;
            for (int column = other; column <= bow; column++)
                s->G[other][column] -= A_f * G * s->G[row][column];
        }
        const double G = s->G[row][bow];
        taken.reading += G * d;
        taken.per_newton += G * G * A_f;
    }
    return taken;
}

static inline void push_together(Model m, State s, int next, double f_b)
{
    const int touching = (int)s->contacts;
    for (int row = touching - 1; row >= 0; row--) {
        const int p = s->touching[row];
        double pushed = s->G[row][touching] * f_b;
        for (int other = row + 1; other < touching; other++)
            pushed += s->G[row][other] * s->f_f[s->touching[other]];
        const double f_f = s->d[row] - s->A_f[row] * pushed;
        settle(m, s, next, p, f_f);
        const struct reply of_p = reply(s, p);
        for (int i = 0; i < STRINGS; i++) {
            s->slack[i] += of_p.slack[i] * f_f;
            s->f_c[i] += of_p.pull[i] * f_f;
        }
    }
}

static inline struct taken close_fingers(Model m, State s, int near, struct weight Q,
                                         struct reply of_bow)
{
    return s->clear ? close_in_turn(s, near, Q, of_bow) : close_together(m, s, near);
}

static inline void push_fingers(Model m, State s, int next, int near, double f_b)
{
    if (s->clear)
        push_in_turn(m, s, next, near, f_b);
    else
        push_together(m, s, next, f_b);
}
