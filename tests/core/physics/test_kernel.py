"""The whole kernel: pitch, independence of block size, lost states."""

from dataclasses import replace

import numpy as np
import pytest
from core.physics.runs import bump, play, rows, shaped
from pitch import cents, pitch_of

from yehu_server.core.physics import kernel, layout, time_loop
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.errors import ParameterError

YEHU = Quantities()
RATE = 44100.0
OPEN = {"F4": (0.7, 349.228), "C5": (-0.7, 523.251)}


# --- sounding -----------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [44100.0, 48000.0, 96000.0])
@pytest.mark.parametrize("string", OPEN)
def test_an_open_string_speaks_at_its_pitch(string, rate):
    """Within 35 cents before any calibration: 0.7 N, 0.3 m/s, x_b 0.255 m."""
    F_N, frequency_hz = OPEN[string]
    run = play({"F_N": F_N, "v_b": 0.3, "x_b": 0.255}, 1.2, rate, ledger=False)
    # It speaks within 0.3 s and stays: the same over each later 0.3 s.
    for start in (0.3, 0.6, 0.9):
        part = run["bridge_force"][round(start * rate) : round((start + 0.3) * rate)]
        assert abs(cents(pitch_of(part, rate), frequency_hz)) < 35.0
        assert part.std() > 0.05


def test_bowing_the_other_way_gives_the_mirrored_sound():
    """Nothing in strings, bridge and friction knows up from down: bit for bit."""
    instrument = override(YEHU, {"finger": {"rest_height": 0.05}})
    for F_N, speed in ((0.7, 0.3), (2.5, 0.9), (-2.5, 0.9)):
        one, other = (
            play({"F_N": F_N, "v_b": v_b}, 0.2, quantities=instrument, ledger=False)
            for v_b in (speed, -speed)
        )
        assert np.abs(one["pressure"]).max() > 0.0
        assert np.array_equal(one["pressure"], -other["pressure"])


def test_a_bow_force_below_the_lift_force_is_a_lifted_bow():
    lift = YEHU.bow.lift_force
    lifted = play({"F_N": 0.999 * lift, "v_b": 0.3}, 0.1, ledger=False)
    assert not lifted["bridge_force"].any()
    touching = play({"F_N": 1.001 * lift, "v_b": 0.3}, 0.1, ledger=False)
    assert touching["bridge_force"].any()


# --- one machine --------------------------------------------------------------------------


def varied(frames, fingers):
    t = np.arange(frames) / RATE
    return rows(
        frames,
        fingers,
        {
            "F_N": 0.7 * np.sin(40.0 * t),
            "v_b": 0.3 * np.cos(17.0 * t),
            "hammer": np.where(t < 1e-3, 1.0, 0.0),
            "x_f": [0.1 + 0.05 * np.sin(9.0 * t + j) for j in range(fingers)],
            "press": [np.maximum(0.0, 2.0 * np.sin(30.0 * t + j)) for j in range(fingers)],
        },
    )


@pytest.mark.parametrize("fingers", [1, 4])
def test_the_size_of_a_block_changes_nothing(fingers):
    """Bit for bit, with and without a ledger."""
    frames = 4096
    model = kernel.prepare(YEHU, RATE, fingers)
    controls = varied(frames, fingers)
    results = []
    for block in (frames, 1, 64, 100, 333):
        state = kernel.at_rest(model)
        probes = np.zeros((frames, layout.probe_columns(fingers)))
        ledger = np.zeros((frames, len(layout.LEDGER)))
        for start in range(0, frames, block):
            part = slice(start, start + block)
            book = ledger[part] if block == 64 else None
            time_loop.run(model, state, None, controls[part], probes[part], book)
        results.append(probes)
    assert results[0].any()
    for other in results[1:]:
        assert np.array_equal(results[0], other)


def test_what_the_kernel_has_no_room_for_is_refused():
    body = YEHU.body
    high = replace(body, frequency_hz=(*body.frequency_hz[:-1], 10.5e3))
    mode = {"frequency_hz": 99.0, "mass": 0.1, "damping": 0.1}
    crowded = replace(body, **{name: (value,) * 65 for name, value in mode.items()})
    for fingers, changed, message in (
        *((fingers, body, "fingers") for fingers in (0, 5, -1)),
        (1, high, "10500 Hz is too high"),
        (1, crowded, "at most 64 bridge modes, not 65"),
        (1, replace(body, sections=body.sections * 3), "at most 64 radiation sections, not 75"),
    ):
        with pytest.raises(ParameterError, match=message):
            kernel.prepare(replace(YEHU, body=changed), 22050.0, fingers)


# --- a lost state -------------------------------------------------------------------------


def put(name, index, level=None):
    """Write a NaN into one place of a state; `level` counts from now, back in time."""

    def write(state):
        at = index if level is None else ((int(state["motion"]["level"][0]) - level) % 3, *index)
        state["motion"][name][(0, *at)] = np.nan

    return write


PLACES = {
    "string": put("u", (0, 12), 0),
    "string before": put("u", (1, 12), 1),
    "bridge mode": put("q", (3,), 0),
    "hair": put("zeta", (0,), 0),
    "hair of the other string": put("zeta", (1,), 0),
    "bristles": put("z", (0,)),
    "potential": put("Psi", (0,)),
    "pressed finger": put("U", (0,), 0),
    "lifted finger": put("U", (1,), 0),
    "radiation filter": put("s_1", (3,)),
}
PLAYING = {"F_N": 0.7, "v_b": 0.3, "x_f": [0.1, 0.15], "press": [1.0, 0.0]}


def when_lost(probes):
    """The one sample that says it lost the state."""
    samples = np.flatnonzero(probes[:, layout.ITERATIONS] == -1.0).tolist()
    assert len(samples) == 1
    return samples[0]


def test_a_nan_anywhere_is_noticed_counted_and_cleared_and_never_heard(subtests):
    """Within 20 samples: a wave in the string needs that long to reach the bridge."""
    frames = round(0.05 * RATE)
    for place, spoil in PLACES.items():
        with subtests.test(place):
            run = play(PLAYING, 0.1, fingers=2, ledger=False)
            spoil(run.state)
            probes = np.zeros((frames, layout.probe_columns(2)))
            time_loop.run(run.model, run.state, None, rows(frames, 2, PLAYING), probes)
            assert run.state["lost"][0] == 1
            where = when_lost(probes)
            assert where < 20
            assert not np.delete(probes[where], layout.ITERATIONS).any()
            assert np.isfinite(probes).all()
            for name in ("u", "q", "zeta", "z", "U", "Psi", "s_1", "s_2", "history"):
                assert np.isfinite(run.state["motion"][name]).all(), name
            # It starts again from rest.
            after = probes[where + 1 :]
            fresh = play(PLAYING, len(after) / RATE, fingers=2, ledger=False)
            assert np.array_equal(after, fresh.probes)


def test_rows_of_another_shape_are_refused_and_leave_the_state_alone():
    model = kernel.prepare(YEHU, RATE)
    state = kernel.at_rest(model)
    columns, wide = layout.probe_columns(1), rows(20, 2, {})
    for controls, probes, ledger in (
        (wide, np.zeros((20, columns)), None),
        (wide[:, : layout.control_columns(1)], np.zeros((20, columns)), None),
        (rows(20, 1, {}), np.zeros((19, columns)), None),
        (rows(20, 1, {}), np.zeros((20, columns), order="F"), None),
        (rows(20, 1, {}), np.zeros((20, columns)), np.zeros((19, len(layout.LEDGER)))),
    ):
        before = state.copy()
        with pytest.raises(ValueError, match="expected 20 rows of"):
            time_loop.run(model, state, None, controls, probes, ledger)
        assert state == before


def test_a_state_that_blew_up_is_lost_too():
    """A bridge force beyond a meganewton is no sound, though it is a number."""
    model = kernel.prepare(YEHU, RATE)
    state = shaped(model, 0, bump(0.02, 0.26, 1e9))
    probes, ledger = np.zeros((200, layout.probe_columns(1))), np.zeros((200, len(layout.LEDGER)))
    time_loop.run(model, state, None, rows(200, 1, {}), probes, ledger)
    assert state["lost"][0] == 1
    assert np.abs(probes[:, layout.BRIDGE_FORCE]).max() < 1e6
    # At rest from then on: every probe but the finger's height is zero.
    where = when_lost(probes)
    assert not np.delete(probes[where + 1 :], layout.FINGER_PROBES, axis=1).any()
    # The ledger has no numbers for that sample; what comes after is booked from rest.
    assert np.isnan(ledger[where]).all()
    assert np.abs(ledger[where + 1 :, layout.LEDGER.index("energy_error")]).max() < 1e-9
