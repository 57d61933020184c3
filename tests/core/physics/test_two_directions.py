"""Strings in two directions: closed forms, symmetries, and each law as a residual of its own.

What is expected is worked out here, on the grid's displacements, by operators of this file's own.
"""

import numpy as np
import pytest
from core.physics.runs import play, rows
from core.physics.test_energy import balanced, performance
from core.physics.test_hair_width import of_modes

from yehu_server.core.physics import kernel, layout, planes, skin, time_loop
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.errors import ParameterError

YEHU = Quantities()
# A bridge that moves alike in both directions, but in neither by the other.
APART = {"directions": "two", "rocking": 0.0, "bounce": 1.0}
BOTH = override(YEHU, {"directions": "two"})
RATE = 44100.0


def now(run, plane, back=0):
    """Displacements of both strings in a plane [shape=(STRINGS, POINTS)], some samples ago."""
    level = (int(run.state["motion"]["level"][0]) - back) % layout.LEVELS
    motion = run.state["motion"] if plane == planes.BOWING else run.refined["normal"]
    return motion["u"][0, level]


# ---------------------------------------------------------------- what one direction had


def test_fingers_alone_move_the_strings_normal_to_the_bow_as_one_direction_moves_them():
    def tapping(t):
        return {"x_f": [0.1 + 0.05 * t], "press": [2.0 * (t < 0.05)]}

    one = play(tapping, 0.1)
    two = play(tapping, 0.1, quantities=override(YEHU, APART))
    assert np.abs(one.finger(0)[:, 1:]).max() > 0.5
    np.testing.assert_allclose(two.finger(0), one.finger(0), rtol=1e-7, atol=1e-9)
    expected = now(one, planes.BOWING)
    np.testing.assert_allclose(
        now(two, planes.NORMAL), expected, atol=1e-7 * np.abs(expected).max()
    )
    assert not now(two, planes.BOWING).any()
    for name in ("energy", "loss_finger", "loss_bridge", "loss_strings", "power_in"):
        top = np.abs(one[name]).max()
        np.testing.assert_allclose(two[name], one[name], atol=1e-7 * top, err_msg=name)


def plucked(quantities, angle, seconds=0.05, F=3.0):
    """String 1 plucked within a plane turned by an angle, by what starts both planes' motions."""
    model, more = kernel.prepare(quantities, RATE), planes.prepare(quantities, RATE)
    state = kernel.at_rest(model)
    N, h = int(model["N"][0, 0]), float(model["h"][0, 0])
    x = np.arange(N + 1) * h
    shape = 1e-3 * F * np.sin(np.pi * np.clip(x / 0.25, 0.0, 1.0)) ** 4
    level = int(state["motion"]["level"][0])
    for motion, part in ((state["motion"], np.cos(angle)), (more["normal"], np.sin(angle))):
        u = np.zeros(layout.POINTS)
        u[layout.GHOST : layout.GHOST + N + 1] = part * shape
        u[layout.GHOST], u[layout.GHOST + N] = 0.0, 0.0
        u[0], u[N + 2] = -u[2], -u[N]
        motion["u"][0, :, 0] = u
        motion["Delta_u"][0, 0, 1:-1] = u[:-2] - 2.0 * u[1:-1] + u[2:]
        motion["Delta_u"][0, 0, [layout.GHOST, layout.GHOST + N]] = 0.0
    frames = round(seconds * RATE)
    controls = rows(frames, 1, {"x_f": [quantities.bridge_x]})
    probes = np.zeros((frames, layout.probe_columns(1)))
    book = np.zeros((frames, len(layout.LEDGER)))
    time_loop.run(model, state, more, controls, probes, book)
    assert level == 0
    return model, state, more, probes, book


@pytest.mark.parametrize("angle", [0.3, np.pi / 4, np.pi / 2])
def test_a_string_on_a_bridge_that_is_alike_in_all_directions_has_no_direction_of_its_own(angle):
    """Tension, which rises with any motion, is part of it."""
    quantities = override(YEHU, {**APART, "felt_loss": 300.0, "finger": {"rest_height": 0.05}})
    *_, along, book_along = plucked(quantities, 0.0)
    _, state, more, turned, book = plucked(quantities, angle)
    assert np.abs(along[:, layout.BRIDGE_FORCE]).max() > 0.1
    np.testing.assert_allclose(
        turned[:, layout.BRIDGE_FORCE], np.cos(angle) * along[:, layout.BRIDGE_FORCE], atol=1e-8
    )
    level = int(state["motion"]["level"][0])
    u, v = state["motion"]["u"][0, level, 0], more["normal"]["u"][0, level, 0]
    np.testing.assert_allclose(v * np.cos(angle), u * np.sin(angle), atol=1e-10)
    np.testing.assert_allclose(book[:, layout.ENERGY], book_along[:, layout.ENERGY], rtol=1e-9)


def test_a_mirrored_bow_on_a_mirrored_bridge_makes_the_mirrored_motion_to_the_last_bit():
    """A bow drawn the other way, on a bridge that rocks the other way, presses the same."""

    def bowed(sign):
        def curves(t):
            return {
                "F_N": 0.7 * np.minimum(t / 0.02, 1.0),
                "v_b": sign * 0.2 * np.minimum(t / 0.03, 1.0),
                "press": [1.5],
            }

        return play(curves, 0.2, quantities=override(BOTH, {"rocking": sign * 0.5}))

    there, back = bowed(1.0), bowed(-1.0)
    assert np.abs(there["f_b"]).max() > 0.3
    np.testing.assert_array_equal(there["f_b"], -back["f_b"])
    np.testing.assert_array_equal(there.finger(0), back.finger(0))
    np.testing.assert_array_equal(now(there, planes.BOWING), -now(back, planes.BOWING))
    np.testing.assert_array_equal(now(there, planes.NORMAL), now(back, planes.NORMAL))


# ---------------------------------------------------------------- closed forms


@pytest.mark.parametrize("F_N", [0.5, -0.5], ids=["F4", "C5"])
def test_a_bow_at_rest_bends_the_string_normal_to_it_as_its_force_says(F_N):
    """Towards the neck string 1, away from it string 2."""
    ideal = {"string_1": {"E": 0.0}, "string_2": {"E": 0.0}}
    quantities = override(YEHU, {**APART, **ideal, "bounce": 0.0})
    run = play({"F_N": F_N, "x_f": [0.3]}, 2.0, quantities=quantities, ledger=False)
    i = 0 if F_N > 0.0 else 1
    x_b, x_c, h = 0.255, quantities.bridge_x, float(run.model["h"][0, i])
    nodes = np.arange(1, int(0.2 / h))
    expected = -F_N * nodes * h * (x_c - x_b) / (x_c * quantities.strings[i].T)
    np.testing.assert_allclose(
        now(run, planes.NORMAL)[i, layout.GHOST + nodes], expected, rtol=0.015
    )
    assert run.refined["f_n"][0, layout.BOW] == pytest.approx(abs(F_N), rel=1e-6)


def skins(**finger):
    quantities = override(BOTH, {"finger": finger})
    return kernel.prepare(quantities, RATE), planes.prepare(quantities, RATE)


def dragged(velocity, f_n, **finger):
    """Force (N) of the skin that is dragged at some velocities (m/s), and what it lost (J)."""
    model, more = skins(**finger)
    m, d, forces, lost = model[0], more[0], [], []
    d["f_n"][0] = f_n
    for v in velocity:
        slack, Z = skin.prepare_skin(m, d, 0)
        before, force = 0.5 * d["K_s"] * d["s"][0] ** 2, Z * (v + slack)
        skin.advance_skin(m, d, 0, v, force)
        forces.append(force)
        lost.append(force * v / RATE - 0.5 * d["K_s"] * d["s"][0] ** 2 + before)
    return np.array(forces), np.array(lost)


def test_skin_that_hardly_moves_is_a_spring_and_a_dashpot():
    t, f = np.arange(4410) / RATE, 400.0
    forces, _ = dragged(1e-4 * np.cos(2.0 * np.pi * f * t), 1.0, K_s=600.0, R_s=3.0)
    late, turned = slice(2205, 4410), np.exp(-2j * np.pi * f * t)
    impedance = (forces * turned)[late].mean() / (1e-4 * np.cos(2 * np.pi * f * t) * turned)[
        late
    ].mean()
    w = 2.0 * RATE * np.tan(np.pi * f / RATE)  # as the mean of two samples turns it
    assert impedance == pytest.approx(3.0 + 600.0 / (1j * w), rel=2e-3)


@pytest.mark.parametrize("f_n", [0.3, 2.0])
def test_skin_bears_no_more_than_its_friction_for_long(f_n):
    forces, lost = dragged(np.full(1000, 3.0), f_n, K_s=600.0, R_s=10.0, mu_s=0.8)
    assert forces[-1] == pytest.approx(0.8 * f_n, rel=1e-9)
    assert lost.min() >= 0.0
    # Until then it yields along Dahl's curve: f over mu f_n is 1 - exp(-K x/(mu f_n)).
    forces, _ = dragged(np.full(1000, 2e-2), f_n, K_s=600.0, R_s=0.0, mu_s=0.8)
    x = 2e-2 * (np.arange(1000) + 0.5) / RATE
    expected = 0.8 * f_n * -np.expm1(-600.0 * x / (0.8 * f_n))
    np.testing.assert_allclose(forces, expected, atol=2e-5)


def test_skin_never_gives_energy_however_it_is_dragged():
    chance, bad = np.random.default_rng(1), []
    for trial in range(20):
        finger = {
            "K_s": 10.0 ** chance.uniform(0.0, 5.0),
            "R_s": chance.choice([0.0, 10.0 ** chance.uniform(-2.0, 3.0)]),
            "mu_s": 10.0 ** chance.uniform(-2.0, 1.0),
        }
        velocity = chance.normal(0.0, 10.0 ** chance.uniform(-3.0, 1.0), 150)
        forces, lost = dragged(velocity, 10.0 ** chance.uniform(-3.0, 1.0), **finger)
        if lost.min() < -1e-12 * np.abs(forces * velocity).max() / RATE:
            bad.append((trial, finger, lost.min()))
    assert not bad


# ---------------------------------------------------------------- residuals


def string_force(model, i, u_next, u, u_prev):
    """What acts on the nodes of a string beyond its own equation (N per node), by matrices."""
    N, h, k = int(model["N"][0, i]), float(model["h"][0, i]), 1.0 / RATE
    quantity = {
        name: float(model[name][0, i]) for name in ("rho_A", "T", "EI", "sigma_0", "sigma_1")
    }
    D2 = (np.diag(np.ones(N - 2), 1) + np.diag(np.ones(N - 2), -1) - 2.0 * np.eye(N - 1)) / h**2
    inner = slice(layout.GHOST + 1, layout.GHOST + N)
    u_next, u, u_prev = u_next[i, inner], u[i, inner], u_prev[i, inner]
    velocity = (u_next - u_prev) / (2.0 * k)
    held = quantity["rho_A"] * (u_next - 2.0 * u + u_prev) / k**2
    held -= quantity["T"] * D2 @ u - quantity["EI"] * D2 @ D2 @ u
    held += 2.0 * quantity["rho_A"] * quantity["sigma_0"] * velocity
    held -= 2.0 * quantity["rho_A"] * quantity["sigma_1"] * D2 @ (u - u_prev) / k
    return h * held, np.arange(1, N) * h


def test_strings_bridge_and_contacts_obey_their_equations():
    """At sample after sample, with bow and finger on: Newton's law, by what the grid shows."""
    changes = {"directions": "two", "tension_modulation": 0.0, "felt_loss": 0.0, "bounce": 0.7}
    quantities = override(YEHU, changes)

    def curves(t):
        return {"F_N": -0.8 * np.minimum(t / 0.02, 1.0), "v_b": 0.3, "press": [2.0], "x_f": [0.08]}

    run = play(curves, 0.12, quantities=quantities)
    model, state, more = run.model, run.state, run.refined
    body, k, seen = quantities.body, 1.0 / RATE, []
    M, R = np.array(body.mass), np.array(body.damping)
    K = M * (2.0 / k * np.tan(np.array(body.omega) * k / 2.0)) ** 2
    one = run.controls[-1:].copy()
    for _ in range(200):
        probes, book = np.zeros((1, run.probes.shape[1])), np.zeros((1, len(layout.LEDGER)))
        time_loop.run(model, state, more, one, probes, book)
        found = {"q": 0.0, "p": 0.0}
        for plane in (planes.BOWING, planes.NORMAL):
            levels = [now(run, plane, back) for back in range(3)]
            for i in range(2):
                force, x = string_force(model, i, *levels)
                parts = (x < 0.15, (x > 0.2) & (x < 0.275), x > 0.275)
                finger, bow, bridge = (force[part].sum() for part in parts)
                assert np.abs(force[(x > 0.15) & (x < 0.2)]).max() < 1e-9
                contact = float(probes[0, layout.FINGER_PROBES + 1 + i])
                if plane == planes.NORMAL:
                    hair = float(more["f_n"][0, layout.BOW]) if i == 1 else 0.0
                    expected = -contact, hair
                    found["q"] -= float(more["rocking"][0, i]) * bridge
                    found["p"] -= 0.7 * bridge
                else:
                    friction = float(probes[0, layout.FRICTION_FORCE]) if i == 1 else 0.0
                    expected = -float(more["skin_force"][0, i]), -friction
                    found["q"] -= bridge
                assert (finger, bow) == pytest.approx(expected, abs=1e-9)
                seen.append([abs(finger), abs(bow), abs(bridge)])
        level = int(state["motion"]["level"][0])
        for name, motion in (("q", state["motion"]), ("p", more["normal"])):
            q_next, q, q_prev = (motion["q"][0, (level - b) % 3, : len(M)] for b in range(3))
            law = M * (q_next - 2.0 * q + q_prev) / k**2 + R * (q_next - q_prev) / (2.0 * k)
            law += K * (q_next + 2.0 * q + q_prev) / 4.0
            np.testing.assert_allclose(law, found[name], atol=1e-8)
    assert np.max(seen, axis=0).min() > 0.05


# ---------------------------------------------------------------- energy


def test_torsion_wide_hair_and_four_fingers_balance_in_two_directions():
    bow = {"width": 0.008, "points": 3, "friction": "thermal"}
    quantities = override(BOTH, {"torsion": "on", "bow": bow})

    def curves(t):
        return performance(t) | {
            "x_f": [np.full(len(t), x) for x in (0.05, 0.11, 0.12, 0.25)],
            "press": [1.0, np.where(t % 0.1 < 0.05, 2.0, 0.0), 0.5, 3.0 * (t > 0.3)],
        }

    balanced(play(curves, 0.6, fingers=4, quantities=quantities))


@pytest.mark.parametrize("changes", [{"directions": "two"}, {"scheme": "modal"}])
def test_a_lost_state_comes_back_at_rest_in_both_directions_and_in_modes(changes):
    quantities = override(YEHU, changes)
    run = play({"F_N": 0.5, "v_b": 0.2, "press": [1.0]}, 0.05, quantities=quantities)
    motion = run.refined["normal"]["u"] if "directions" in changes else run.refined["a"]
    motion[0, :, 0, 5] = np.nan
    probes, book = np.zeros_like(run.probes[:3]), np.zeros((3, len(layout.LEDGER)))
    time_loop.run(run.model, run.state, run.refined, run.controls[:3], probes, book)
    assert run.state["lost"][0] == 1
    assert np.isfinite(motion).all()
    assert np.isfinite(probes).all()
    assert probes[0, layout.ITERATIONS] == -1.0


def test_only_simulations_take_strings_in_two_directions():
    from yehu_server.core.physics import refined

    with pytest.raises(ParameterError, match="only for simulate and sweeps"):
        refined.prepare(BOTH, RATE)
    assert planes.prepare(YEHU, RATE) is None


def test_bodies_of_many_modes_balance_in_two_directions():
    from dataclasses import replace

    quantities = replace(override(BOTH, {"rocking": 3.0, "bounce": 4.0}), body=of_modes(64, 3))
    balanced(play(performance, 0.5, quantities=quantities))
