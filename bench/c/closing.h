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

static inline bool are_apart(const struct state *s, int near)
{
    for (int c = 0; c < near; c++)
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * s->near[c] + i;
            if (s->shared_with_bridge[p] != 0.0 || !is_apart(s, p, BOW))
                return false;
            for (int other = 0; other < c; other++)
                if (!is_apart(s, p, STRINGS * s->near[other] + i))
                    return false;
        }
    return true;
}

static inline struct weight weigh_fingers(Model m, State s, int near)
{
    const double C_f = m->C_f;
    struct weight Q = {0.0, 0.0, 0.0};
    for (int c = 0; c < near; c++) {
        const int j = s->near[c], p = STRINGS * j, q = STRINGS * j + 1;
        const double A_p = stiffness(m, s, p), A_q = stiffness(m, s, q);
        const double on_p = 1.0 + A_p * (s->yields[p] + C_f), on_q = 1.0 + A_q * (s->yields[q] + C_f);
        const double across = A_p * C_f * A_q;
        const double per_determinant = 1.0 / (on_p * on_q - across * C_f);
        const double W_11 = A_p * on_q * per_determinant, W_12 = -across * per_determinant;
        const double W_22 = A_q * on_p * per_determinant;
        const double held_p = s->g[p] * s->Psi[p], held_q = s->g[q] * s->Psi[q];
        const double bend_p = s->bend_at[p], bend_q = s->bend_at[q];
        s->held[p] = (held_p * on_q - held_q * A_p * C_f) * per_determinant;
        s->held[q] = (held_q * on_p - held_p * A_q * C_f) * per_determinant;
        s->W[j][0] = W_11;
        s->W[j][1] = W_12;
        s->W[j][2] = W_22;
        Q.on_11 += bend_p * bend_p * W_11;
        Q.on_12 += bend_p * bend_q * W_12;
        Q.on_22 += bend_q * bend_q * W_22;
    }
    return Q;
}

static inline struct taken close_apart(State s, int near, struct weight Q, struct reply of_bow)
{
    double sum_1 = 0.0, sum_2 = 0.0;
    for (int c = 0; c < near; c++) {
        const int j = s->near[c], p = STRINGS * j, q = STRINGS * j + 1;
        const double *W = s->W[j];
        const double f_p = W[0] * s->travel[p] + W[1] * s->travel[q] + s->held[p];
        const double f_q = W[1] * s->travel[p] + W[2] * s->travel[q] + s->held[q];
        s->f_f[p] = f_p;
        s->f_f[q] = f_q;
        sum_1 += s->bend_at[p] * f_p;
        sum_2 += s->bend_at[q] * f_q;
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

static inline void push_apart(Model m, State s, int next, int near, double f_b)
{
    const double slack_1 = s->slackened[0] + s->slack_per_newton[0] * f_b;
    const double slack_2 = s->slackened[1] + s->slack_per_newton[1] * f_b;
    for (int c = 0; c < near; c++) {
        const int j = s->near[c], p = STRINGS * j, q = STRINGS * j + 1;
        const double *W = s->W[j];
        const double way_p = s->bend_at[p] * slack_1, way_q = s->bend_at[q] * slack_2;
        settle(m, s, next, p, s->f_f[p] + W[0] * way_p + W[1] * way_q);
        settle(m, s, next, q, s->f_f[q] + W[1] * way_p + W[2] * way_q);
    }
}

static inline int close_together(Model m, State s, int near, struct taken *restrict taken)
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
    *taken = (struct taken){0.0, 0.0};
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
        taken->reading += G * d;
        taken->per_newton += G * G * A_f;
    }
    return bow;
}

static inline void push_together(Model m, State s, int next, int touching, double f_b)
{
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
