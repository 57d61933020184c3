"""The model also runs as plain Python, under a debugger: what is compiled is what is written."""

import os
import subprocess
import sys

import numpy as np

from yehu_server.core.physics import kernel, layout, refined, time_loop
from yehu_server.core.physics.default_quantities import Quantities, override

RATE = 44100.0
FRAMES = 12
REFINED = override(Quantities(), {"torsion": "on", "bow": {"width": 0.008}})


def step_through(quantities: Quantities) -> np.ndarray:
    """Probes and ledger of some steps: two fingers that share nodes, a third, and a bow."""
    model, more = kernel.prepare(quantities, RATE, 3), refined.prepare(quantities, RATE)
    state = kernel.at_rest(model)
    state["motion"]["U"] = -1e-6
    controls = np.zeros((FRAMES, layout.control_columns(3)))
    controls[:, [layout.F_N, layout.V_B, layout.X_B]] = 0.6, 0.25, 0.255
    controls[:6, layout.F_PLUCK] = -2.0
    controls[:, layout.X_PLUCK] = 0.1
    controls[:, layout.FINGER_CONTROLS :] = 0.1, 2.0, 0.11, 1.0, 0.25, 0.0
    controls[6:, layout.FINGER_CONTROLS] = 0.25  # under the bow: contacts are solved jointly
    probes = np.zeros((FRAMES, layout.probe_columns(3)))
    ledger = np.zeros((FRAMES, len(layout.LEDGER)))
    time_loop.run(model, state, more, controls, probes, ledger)
    return np.hstack([probes, ledger])


def all_steps() -> np.ndarray:
    """Those of the plain kernel, and of the one with torsion and wide hair."""
    return np.stack([step_through(Quantities()), step_through(REFINED)])


def test_uncompiled_steps_are_those_of_the_compiled_model(tmp_path):
    target = tmp_path / "plain.npy"
    command = [sys.executable, __file__, str(target)]
    subprocess.run(command, env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, check=True)
    for compiled, plain in zip(all_steps(), np.load(target), strict=True):
        check(compiled, plain)


def check(compiled: np.ndarray, plain: np.ndarray) -> None:
    """Compare the steps of one kernel."""
    size = np.abs(compiled).max(axis=0)
    assert (size > 0.0).sum() > 20
    error = np.abs(plain - compiled).max(axis=0)
    terms = layout.probe_columns(3) + np.arange(len(layout.LEDGER))
    balance = terms[layout.LEDGER.index("energy_error") :]  # differences of rounding errors
    assert (np.delete(error, balance) <= 1e-10 * np.delete(size, balance) + 1e-12).all()
    assert np.abs(plain[:, balance]).max() < 1e-9


if __name__ == "__main__":
    np.save(sys.argv[1], all_steps())
