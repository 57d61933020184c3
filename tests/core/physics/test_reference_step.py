"""The kernel against tests/reference.py: the same equations, dense and slow.

The model is chaotic, so whole runs cannot be compared: single steps from shared random
states can, to rounding, and so can the first 50 samples of a start.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import reference as ref
from core.physics.adapter import kernel_state, reference_params, step_kernel, step_reference

from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics.bow import friction_bound
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.friction import solve_friction

YEHU = Quantities()
RATES = (22050.0, 44100.0, 96000.0)


@cache
def models(rate, modulation=1.0):
    """The reference's instrument, and the kernel's with 1 to 4 fingers."""
    yehu = replace(YEHU, tension_modulation=modulation)
    params = reference_params(yehu, rate)
    prepared = {fingers: kernel.prepare(yehu, rate, fingers) for fingers in (1, 2, 3, 4)}
    for model in prepared.values():
        assert [string.N for string in params.strings] == model["N"][0].tolist()
    return params, prepared


def tied(params, shapes, q):
    """The shapes moved at the bridge to where the modes are: eq. (12) at one instant."""
    out = []
    for string, shape in zip(params.strings, shapes, strict=True):
        reading = ref.interpolate_cubic(string, params.x_c)
        hump = np.sin(np.pi * np.arange(1, string.N) / string.N)
        gap = q.sum() - reading @ shape
        out.append(np.pad(shape + hump * gap / (reading @ hump), 1))
    return out


def contact_places(params, rng, bowed, fingers):
    """Where bow and fingers are: anywhere, next to the bridge, next to each other."""
    h, x_c = params.strings[bowed].h, params.x_c
    nearest = x_c - 1.0000001 * h  # the bow keeps one node from the bridge
    near_bridge = x_c - rng.uniform(1.0, 2.0) * h
    x_b = min(rng.choice([rng.uniform(0.04, 0.29), near_bridge]), nearest)
    x_f = rng.uniform(0.04, x_c, fingers)
    for j in range(fingers):
        kind = rng.random()
        if kind < 0.3:
            x_f[j] = x_b + rng.uniform(-2.0, 2.0) * h
        elif kind < 0.5:
            x_f[j] = x_f[0] + rng.uniform(-2.0, 2.0) * h
    return float(x_b), np.clip(x_f, 0.04, x_c)


def random_problem(params, rng):
    """A state somewhere in a performance, and the controls of its next step."""
    fingers = int(rng.integers(1, 5))
    F_N = float(rng.choice([0.0, 5e-4, *[1.0] * 4, *[-1.0] * 4]) * rng.uniform(0.2, 1.5))
    x_b, x_f = contact_places(params, rng, 0 if F_N >= 0.0 else 1, fingers)
    q = 1e-6 * rng.normal(size=len(params.M))
    q_prev = q + 1e-8 * rng.normal(size=len(q))
    rough = [np.cumsum(rng.normal(size=string.N - 1)) * 3e-5 for string in params.strings]
    shapes = [np.convolve(shape, np.ones(7) / 7.0, "same") for shape in rough]
    u = tied(params, shapes, q)
    u_prev = tied(params, [u + 3e-6 * rng.normal(size=len(u)) for u in shapes], q_prev)
    at_finger = [ref.interpolate_cubic(params.strings[0], x) @ u[0][1:-1] for x in x_f]
    U = np.array(at_finger) + 2e-4 * rng.normal(size=fingers)
    # Some fingers leave at metres a second and some potentials are small: theta < 1.
    left = rng.choice([2e-7, 2e-5], fingers) * np.abs(rng.normal(size=fingers))
    Psi = np.abs(rng.normal(size=(fingers, 2))) * rng.choice([1e-3, 1e-6])
    state = ref.RefState(
        u=u,
        u_prev=u_prev,
        q=q,
        q_prev=q_prev,
        zeta=1e-5 * rng.normal(size=2),
        zeta_prev=1e-5 * rng.normal(size=2),
        z=1e-5 * abs(F_N) * rng.normal(size=2),
        U=U,
        U_prev=U - left,
        Psi=Psi,
    )
    controls = ref.RefControls(
        v_b=float(rng.uniform(-0.5, 0.5)),
        F_N=F_N,
        x_b=x_b,
        f_hammer=float(rng.choice([0.0, rng.normal()])),
        x_f=x_f,
        press=rng.uniform(0.0, 3.0, fingers) * (rng.random(fingers) > 0.3),
        f_pluck=float(rng.choice([0.0, rng.normal()])),
        x_pluck=float(rng.uniform(0.03, 0.3)),
    )
    return state, controls


def natural_scales(expected, controls):
    """The size of each quantity in this step; a quantity near zero has that of its kind."""
    sizes = {name: float(np.abs(value).max(initial=0.0)) for name, value in expected.items()}
    friction = YEHU.bow.mu_S * abs(controls.F_N)
    # The solver's tolerance is absolute below 1 m/s.
    floors = {
        "z": friction / YEHU.bow.epsilon_0,
        "Psi": 1e-6,
        "f_b": friction,
        "v_r": 1.0,
        "f_f": 1e-6,
    }
    return {name: max(size, floors.get(name, 0.0)) for name, size in sizes.items()}


@pytest.fixture(scope="module")
def compared():
    """100 random steps by both: problem, reference (before and after), kernel."""
    rng = np.random.default_rng(9)
    steps = []
    # A thousandfold tension modulation shows its coupling with the contacts.
    for case in [(22050.0, 1.0), (44100.0, 0.0), (44100.0, 1000.0), (96000.0, 1.0)] * 25:
        params, prepared = models(*case)
        state, controls = random_problem(params, rng)
        try:
            after, expected, outputs = step_reference(params, state, controls)
        except ref.SeveralRootsError:
            continue  # then either answer would be right
        model = prepared[len(controls.x_f)]
        ledger = np.zeros((1, len(layout.LEDGER)))
        found = step_kernel(model, kernel_state(model, state), controls, ledger)
        steps.append((params, state, controls, after, expected, outputs, found, ledger[0]))
    return steps


def test_one_step_from_any_state_is_the_references_to_rounding(compared):
    for _, _, controls, _, expected, outputs, found, _ in compared:
        scales = natural_scales(expected, controls)
        for name, value in expected.items():
            if name == "v_r" and outputs.bowed < 0:
                continue  # the reference has none then
            error = np.abs(np.asarray(value) - found[name]).max(initial=0.0)
            assert error <= 1e-12 * scales[name], name


def test_one_row_of_the_ledger_is_the_references(compared):
    """Other tests rely on the kernel's ledger; this one checks it independently."""
    parts = {
        "loss_strings": "q_string",
        "loss_bridge": "q_bridge",
        "loss_finger": "q_finger",
        "loss_hair": "q_hair",
        "loss_friction": "q_friction",
        "loss_bow_lift": "q_reset_z",
        "loss_contact_reset": "q_reset_Psi",
        "power_in": "p",
    }
    for params, state, controls, after, _, outputs, _, row in compared:
        expected = ref.ledger(params, state, after, outputs, controls)
        found = dict(zip(layout.LEDGER, row, strict=True))
        assert found["energy"] == pytest.approx(expected["h_after"], rel=1e-12)
        scale = max(abs(expected[name]) for name in parts.values())
        for name, theirs in parts.items():
            assert abs(found[name] - expected[theirs]) <= 1e-11 * scale, name
        # The kernel keeps the energy of the step before, which is 0 here.
        flow = sum(found[name] for name in parts if name != "power_in") - found["power_in"]
        error = found["energy"] / params.k + flow - expected["h_before"] / params.k
        assert abs(error) <= 1e-11 * max(scale, expected["h_before"] / params.k)


def test_the_mean_potential_of_a_contact_is_never_negative(compared):
    """mu_t+ Psi >= 0, the constraint that theta imposes; and no contact loss below zero.

    theta is found with all contacts off, eq. (34): another contact on the same finger or
    the same nodes may still push this one below zero, by what it moves in one step.
    """
    alone = 0
    for params, state, controls, _, _, outputs, found, row in compared:
        _, Psi = ref.after_resets(params, state, controls)
        mean = (found["Psi"] + Psi.ravel()) / 2.0
        allowed = 1e-12 if np.count_nonzero(outputs.g) == 1 else 1e-3
        alone += np.count_nonzero(outputs.g) == 1
        assert mean.min() >= -allowed * max(Psi.max(), 1e-6)
        assert row[layout.LEDGER.index("loss_finger")] >= -1e-8
    assert alone > 5


@pytest.mark.parametrize(("F_N", "fingers"), [(0.7, 2), (-0.7, 1)], ids=["F4", "C5"])
def test_the_first_50_samples_of_a_start_are_the_references(F_N, fingers):
    """Bowed and pressed, the fingers already on the strings, gliding."""
    params, prepared = models(44100.0)
    height = np.full(fingers, -1e-5)  # in touch from the first sample
    state = replace(ref.rest_state(params, fingers), U=height, U_prev=height)
    model, record = prepared[fingers], kernel_state(prepared[fingers], state)
    steps = []
    for n in range(50):
        controls = ref.RefControls(
            v_b=0.3,
            F_N=F_N,
            x_b=0.255,
            f_hammer=0.0,
            x_f=np.array([0.1 + 1e-5 * n + 0.05 * j for j in range(fingers)]),
            press=np.full(fingers, 3.0),
        )
        state, expected, _ = step_reference(params, state, controls)
        found = step_kernel(model, record, controls, np.zeros((1, len(layout.LEDGER))))
        steps.append((expected, found))
    for name in steps[0][0]:
        wanted, got = (
            np.array([np.ravel(step[name]) for step in each]) for each in zip(*steps, strict=True)
        )
        assert np.abs(wanted).max() > 0.0, name
        assert np.abs(got - wanted).max() <= 1e-8 * np.abs(wanted).max(), name


@pytest.mark.parametrize("rate", RATES)
def test_the_friction_bound_is_that_of_a_bow_on_a_node(rate):
    """1.34 compliance epsilon_0 k/2, the compliance taken from the reference's own step."""
    params, prepared = models(rate)
    bounds = []
    for F_N, string in zip((0.7, -0.7), params.strings, strict=True):
        controls = ref.RefControls(
            v_b=0.3,
            F_N=F_N,
            x_b=10.0 * string.h,
            f_hammer=0.0,
            x_f=np.array([0.05]),
            press=np.zeros(1),
        )
        _, outputs = ref.step(params, ref.rest_state(params, 1), controls)
        bounds.append(1.34 * outputs.scalar_I * params.eps0 * params.k / 2.0)
    assert friction_bound(prepared[1][0]) == pytest.approx(max(bounds), rel=1e-9)


def test_below_that_bound_friction_has_one_solution_and_the_solver_finds_it():
    params, prepared = models(44100.0)
    model = prepared[1][0]
    rng = np.random.default_rng(31)
    for _ in range(150):
        F_N, string = 10.0 ** rng.uniform(-1.0, 0.7), int(rng.integers(2))
        compliance = rng.uniform(0.2, 1.0) / (1.34 * params.eps0 * params.k / 2.0)
        z = rng.uniform(-1.0, 1.0) * params.mu_S * F_N / params.eps0
        free = rng.uniform(-1.0, 1.0) * 10.0 ** rng.uniform(-3.0, 0.5)
        law = ref.Friction(params=params, F_N=F_N, xi=float(params.xi[string]), z=z)
        expected = law.solve(free, compliance)  # raises where there are several
        tangent = rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-1e5, 0.0)
        found = solve_friction(free, compliance, z, F_N, YEHU.bow.mu_S, tangent, model, string)
        assert abs(found[0] - expected) <= 1e-11 * params.mu_S * F_N
