"""The model also runs as plain Python, under a debugger: what is compiled is what is written."""

import os
import subprocess
import sys

import numpy as np

from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics.quantities import Quantities

RATE = 44100.0
FRAMES = 40


def step_through() -> np.ndarray:
    """Probes and ledger of some steps: two fingers that share nodes, a third, and a bow."""
    model = kernel.prepare(Quantities(), RATE, 3)
    state = kernel.at_rest(model)
    state["motion"]["U"] = -1e-6
    controls = np.zeros((FRAMES, layout.control_columns(3)))
    controls[:, [layout.F_N, layout.V_B, layout.X_B]] = 0.6, 0.25, 0.255
    controls[:20, layout.F_PLUCK] = -2.0
    controls[:, layout.X_PLUCK] = 0.1
    controls[:, layout.FINGER_CONTROLS :] = 0.1, 2.0, 0.11, 1.0, 0.25, 0.0
    controls[20:, layout.FINGER_CONTROLS] = 0.25  # under the bow: contacts are solved jointly
    probes = np.zeros((FRAMES, layout.probe_columns(3)))
    ledger = np.zeros((FRAMES, len(layout.LEDGER)))
    kernel.advance(model, state, controls, probes, ledger)
    return np.hstack([probes, ledger])


def test_uncompiled_steps_are_those_of_the_compiled_model(tmp_path):
    target = tmp_path / "plain.npy"
    command = [sys.executable, __file__, str(target)]
    subprocess.run(command, env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, check=True)
    compiled, plain = step_through(), np.load(target)
    size = np.abs(compiled).max(axis=0)
    assert (size > 0.0).sum() > 20
    error = np.abs(plain - compiled).max(axis=0)
    terms = layout.probe_columns(3) + np.arange(len(layout.LEDGER))
    balance = terms[layout.LEDGER.index("energy_error") :]  # differences of rounding errors
    assert (np.delete(error, balance) <= 1e-10 * np.delete(size, balance) + 1e-12).all()
    assert np.abs(plain[:, balance]).max() < 1e-9


if __name__ == "__main__":
    np.save(sys.argv[1], step_through())
