/* The model's time loop in plain C, which the compiled Python is measured against.
 *
 * The mathematics are those of yehu_server/physics, function by function, and so are the names;
 * what they mean is told there. Records and constants come from records.h, which is written
 * from the package when this is compiled, so that both work on the same memory. There is no
 * energy ledger here.
 */

#include "closing.h"
#include "friction.h"

/* ---- radiation.py --------------------------------------------------------------------------- */

static inline double radiate(Model m, State s, double bridge_force)
{
    double pressure = 0.0;
    for (int j = 0; j < MAX_SECTIONS; j++) {
        const double y = m->b_0[j] * bridge_force + s->s_1[j];
        s->s_1[j] = m->b_1[j] * bridge_force - m->a_1[j] * y + s->s_2[j];
        s->s_2[j] = -m->a_2[j] * y;
        pressure += y;
    }
    for (int64_t j = m->last_tap; j > 0; j--)
        s->history[j] = s->history[j - 1];
    s->history[0] = bridge_force;
    for (int64_t j = 0; j <= m->last_tap; j++)
        pressure += m->taps[j] * s->history[j];
    return pressure;
}

/* ---- kernel.py ------------------------------------------------------------------------------ */

static void come_to_rest(Model m, State s)
{
    memset(s->u, 0, sizeof s->u);
    memset(s->q, 0, sizeof s->q);
    memset(s->zeta, 0, sizeof s->zeta);
    memset(s->z, 0, sizeof s->z);
    memset(s->Psi, 0, sizeof s->Psi);
    memset(s->s_1, 0, sizeof s->s_1);
    memset(s->s_2, 0, sizeof s->s_2);
    memset(s->history, 0, sizeof s->history);
    memset(s->slack, 0, sizeof s->slack);
    memset(s->give, 0, sizeof s->give);
    memset(s->bend, 0, sizeof s->bend);
    memset(s->bend_at, 0, sizeof s->bend_at);
    memset(s->eta_prev, 0, sizeof s->eta_prev);
    memset(s->tangent, 0, sizeof s->tangent);
    memset(s->x, 0, sizeof s->x);
    memset(s->still, 0, sizeof s->still);
    for (int t = 0; t < LEVELS; t++)
        for (int j = 0; j < MAX_FINGERS; j++)
            s->U[t][j] = m->rest_height;
    s->v_r = s->f_b = s->stored = 0.0;
    s->placed = 0;
}

static inline void step(Model m, State s, const double *restrict control, int next, int now,
                        int prev)
{
    double (*const u_next)[POINTS] = s->u[next];
    const double half_rate = 0.5 * m->rate, v_b = control[V_B], F_b = control[F_N];
    s->dropped_z = s->dropped_Psi = 0.0;

    for (int i = 0; i < STRINGS; i++)
        advance_string(u_next[i], s->u[now][i], s->u[prev][i], s->bend[i], m->inside[i], m->N[i],
                       m->B[i], m->C[i], &s->square[i], &s->along[i]);
    pull_aside(m, s, control, u_next);
    const double sum = advance_bridge(m, s->q[next], s->q[now], s->q[prev], control[F_HAMMER]);
    close_bridge(m, s, u_next, sum);

    bool bowed;
    const int string = choose_string(m, s, F_b, &bowed);
    const bool moved = place_contacts(m, s, control, string);
    const int64_t were_near = s->are_near;
    const int near = meet_fingers(m, s, control, next, now, prev);
    if (moved || s->are_near != were_near)
        note_neighbours(m, s, near);
    struct weight Q = weigh_fingers(m, s, near);

    s->bend_at[BOW] = reading(s->bend[string], s->first[BOW], s->weights[BOW]);
    const struct reply of_bow = reply(s, BOW);
    for (int i = 0; i < STRINGS; i++) {
        s->zeta[next][i] = m->A_h * s->zeta[now][i] + m->B_h * s->zeta[prev][i];
        s->slack_per_newton[i] = of_bow.slack[i];
        s->f_c_per_newton[i] = of_bow.pull[i];
    }
    double free = feel(s, u_next, BOW) - reading(s->u[prev][string], s->first[BOW], s->weights[BOW]);
    free = half_rate * (free + s->zeta[next][string] - s->zeta[prev][string]) - v_b;
    double compliance = half_rate * (answer(m, s, BOW, BOW, of_bow) + m->C_h);
    struct grip grip = {
        .v_r = free,
        .tangent = {s->tangent[0], s->tangent[1], s->tangent[2]},
        .converged = true,
    };
    int iterations = 0;
    if (near > 0) {
        const double f_b = bowed ? s->f_b : 0.0;
        const double doubt = bowed ? fabs(s->f_b) + FRICTION_REACH * m->mu_S * fabs(F_b) : 0.0;
        if (feel_fingers(m, s, u_next, next, near, of_bow, f_b, doubt)) {
            if (bowed) {
                grip = solve_friction(m, free, compliance, s->z[string], fabs(F_b), grip.tangent,
                                      string);
                iterations = grip.iterations;
            }
            limit_fingers(s, near, grip.f_b);
            Q = weigh_fingers(m, s, near);
        }
        const struct taken taken = close_fingers(m, s, near, Q, of_bow);
        free -= half_rate * taken.reading;
        compliance -= half_rate * taken.per_newton;
        grip.v_r = free;
        grip.f_b = 0.0;
    }
    if (bowed) {
        grip = solve_friction(m, free, compliance, s->z[string], fabs(F_b), grip.tangent, string);
        iterations += grip.iterations;
    }
    for (int i = 0; i < STRINGS; i++) {
        s->slack[i] += s->slack_per_newton[i] * grip.f_b;
        s->f_c[i] += s->f_c_per_newton[i] * grip.f_b;
    }
    push_fingers(m, s, next, near, grip.f_b);

    s->zeta[next][string] -= m->C_h * grip.f_b;
    s->z_bar = s->r = 0.0;
    if (bowed) {
        s->z_bar = grip.z_bar;
        s->r = m->rate * 2.0 * (grip.z_bar - s->z[string]);
        s->z[string] = 2.0 * grip.z_bar - s->z[string];
        s->unconverged += !grip.converged;
    }
    s->f_b = grip.f_b;
    s->v_r = grip.v_r;
    s->iterations = iterations;
    memcpy(s->tangent, grip.tangent, sizeof grip.tangent);
    move(m, s, u_next, near, bowed);
    s->bridge_travel = finish_bridge(m, s->q[next], s->q[prev], s->f_c[0] + s->f_c[1]);
    for (int i = 0; i < STRINGS; i++)
        support(u_next[i], m->N[i]);
}

static inline void measure(Model m, State s, double *restrict probe)
{
    const int next = s->level, now = (next + 2) % LEVELS, fingers = (int)m->fingers;
    const int columns = FINGER_PROBES + PROBES_PER_FINGER * fingers;
    const double bridge_force = s->f_c[0] + s->f_c[1];
    probe[BRIDGE_FORCE] = bridge_force;
    probe[BRIDGE_FORCE_1] = s->f_c[0];
    probe[BRIDGE_FORCE_2] = s->f_c[1];
    probe[BRIDGE_VELOCITY] = 0.5 * m->rate * s->bridge_travel;
    probe[PRESSURE] = radiate(m, s, bridge_force);
    probe[FRICTION_FORCE] = s->f_b;
    probe[RELATIVE_VELOCITY] = s->v_r;
    probe[ITERATIONS] = (double)s->iterations;
    double size = fabs(s->bridge_travel);
    for (int column = 0; column < FINGER_PROBES; column++)
        size += fabs(probe[column]);
    for (int i = 0; i < STRINGS; i++)
        size += fabs(s->z[i]) + fabs(s->zeta[next][i]);
    for (int j = 0; j < fingers; j++) {
        double *restrict finger = probe + FINGER_PROBES + PROBES_PER_FINGER * j;
        finger[0] = s->U[now][j];
        size += fabs(s->U[now][j]);
        for (int i = 0; i < STRINGS; i++) {
            const int p = STRINGS * j + i;
            finger[1 + i] = s->f_f[p];
            size += fabs(s->f_f[p]) + fabs(s->Psi[p]);
        }
    }
    if (!(size < LOST_SIZE)) {
        come_to_rest(m, s);
        s->lost++;
        memset(probe, 0, (size_t)columns * sizeof *probe);
        probe[ITERATIONS] = -1.0;
    }
}

void advance(Model m, State s, const double *restrict controls, double *restrict probes,
             int64_t frames)
{
    const int64_t control_columns = FINGER_CONTROLS + CONTROLS_PER_FINGER * m->fingers;
    const int64_t probe_columns = FINGER_PROBES + PROBES_PER_FINGER * m->fingers;
    int now = s->level, next = (now + 1) % LEVELS, prev = (now + 2) % LEVELS;
    for (int64_t n = 0; n < frames; n++) {
        step(m, s, controls + n * control_columns, next, now, prev);
        s->level = (uint8_t)next;
        measure(m, s, probes + n * probe_columns);
        const int oldest = prev;
        prev = now;
        now = next;
        next = oldest;
    }
}
