"""What a command tells a person when it is done."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from yehu_server.playing.fingering import RangePolicy
from yehu_server.render import Summary
from yehu_server.simulate import Simulation

NOTABLE_BOUND = 1.2
FATE = {
    RangePolicy.TRANSPOSE: "moved by octaves",
    RangePolicy.CLAMP: "played as the nearest there is",
    RangePolicy.SKIP: "left out",
}


def decibels(level: float) -> str:
    """A level of full scale in dB, for reading."""
    return f"{20.0 * math.log10(level):.1f} dBFS" if level > 0.0 else "silence"


def counted(number: int, thing: str) -> str:
    """A number of things, in words."""
    return f"{number} {thing}" + ("" if number == 1 else "s")


def render_report(target: Path, summary: Summary) -> str:
    """A few lines on a rendering."""
    pace = f"{summary.duration_s:.1f} s, {summary.real_time_factor:.0f} x real time"
    lines = [f"{target}: {pace}, peak {decibels(summary.peak)}, rms {decibels(summary.rms)}"]
    heard = ", ".join(
        f"{channel + 1} ({counted(notes, 'note')})"
        for channel, notes in summary.notes_by_channel.items()
    )
    lines.append(f"channels: {heard}" if heard else "no notes to play")
    if summary.notes_out_of_range:
        notes = counted(summary.notes_out_of_range, "note")
        lines.append(f"{notes} outside F4 to F6, {FATE[summary.policy]}")
    if summary.unconverged_solves:
        lines.append(f"{counted(summary.unconverged_solves, 'friction solve')} did not converge")
    if summary.lost_states:
        lines.append(f"lost state, put back to rest: {counted(summary.lost_states, 'time')}")
    lines += _friction_notice(summary.friction_bound)
    return "\n".join(lines)


def simulate_report(target: Path, result: Simulation) -> str:
    """A few lines on a simulation."""
    meta, arrays = result.meta, result.arrays
    intervals = " and ".join(str(N) for N in meta["grid_intervals"])
    size = f"{meta['frames']} samples at {meta['sample_rate']:g} Hz, {intervals} grid intervals"
    iterations = float(np.mean(arrays["iterations"]))
    lines = [f"{target}: {size}, {iterations:.1f} friction iterations a sample"]
    if "energy_error" in arrays:
        flow = max(float(np.abs(arrays["power_in"]).max()), 1e-300)
        error = float(np.abs(arrays["energy_error"]).max())
        lines.append(f"energy error at most {error:.1e} W, {error / flow:.1e} of the power in")
    if meta["unconverged_solves"] or meta["lost_states"]:
        lines.append(
            f"{meta['unconverged_solves']} unconverged solves, {meta['lost_states']} lost states"
        )
    lines += _friction_notice(meta["friction_bound"])
    return "\n".join(lines)


def _friction_notice(bound: float) -> list[str]:
    # The measured instrument at 44.1 kHz is at 1.02, without trouble.
    if bound < NOTABLE_BOUND:
        return []
    return [f"note: at this rate and epsilon_0 friction may have several solutions ({bound:.1f})"]
