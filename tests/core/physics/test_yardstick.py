"""The plain C++ loop that bench/run.py compares speeds with computes the same physics."""

from dataclasses import replace

import numpy as np
import pytest
from kernel_loop import Kernel
from pitch import cents, pitch_of
from yardstick import FORCE, RATE, Yardstick

from yehu_server.core.physics import kernel, layout, time_loop
from yehu_server.core.physics.quantities import Quantities

SECONDS = 1.0


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    try:
        yardstick = Yardstick(tmp_path_factory.mktemp("yardstick"))
    except FileNotFoundError as error:
        pytest.skip(str(error))
    return yardstick.sound(SECONDS)[: round(SECONDS * RATE)]


def by_kernel(**changes):
    model = kernel.prepare(replace(Quantities(), **changes), RATE)
    rows, probes = Kernel(1, 1, FORCE, is_idle=True).rows(round(SECONDS * RATE))
    time_loop.run(model, kernel.at_rest(model), None, rows, probes)
    return probes[:, layout.PRESSURE]


def test_without_tension_modulation_and_felt_its_first_samples_are_the_kernels(plain):
    ours = by_kernel(tension_modulation=0.0, felt_loss=0.0)[:200]
    assert np.abs(plain[:200] - ours).max() < 1e-8 * np.abs(ours).max()


def test_a_stopped_note_has_the_kernels_pitch_and_level(plain):
    ours, plain = by_kernel(felt_loss=0.0)[len(plain) // 2 :], plain[len(plain) // 2 :]
    assert abs(cents(pitch_of(plain, RATE), pitch_of(ours, RATE))) < 5.0
    assert abs(20.0 * np.log10(plain.std() / ours.std())) < 3.0
