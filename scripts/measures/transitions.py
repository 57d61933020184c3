"""`legato`, `clicks`: what happens where notes meet."""

import numpy as np

from measures.intonation import bound, overtones_off_by
from measures.shares import Share, share, share_line
from measures.take import NOTES, Setup, Take, in_parallel

SPEED_WHEELS = (26, 84, 122)  # 0.14, 0.2 and 0.25 m/s
STEP_S, WINDOW_S, SOON_MS = 0.4, 0.03, 60.0
CLICK = 2.0  # a step between samples this many times as large as inside the notes


def _slurred(setup: Setup, note: int, target: int, wheel: int) -> float:
    """Return the time (ms, at most 200) after which a slurred note stays in tune."""
    take = Take(setup)
    take.wheel(wheel)
    take.on(0.0, note)
    take.on(STEP_S, target)
    take.off(STEP_S + 0.01, note)
    sound = take.play(STEP_S + 0.3)
    late = 0.0
    for ms in range(0, 200, 2):
        error = overtones_off_by(sound, setup.rate, STEP_S + 1e-3 * ms, WINDOW_S, target)
        if abs(error) > bound(target):
            late = ms + 2.0
    return late


def legato(setup: Setup) -> list[Share]:
    """Print how long slurred notes take to be in tune, for each target note."""
    steps = [step for size in range(1, 6) for step in (-size, size)]
    jobs = [
        (target + step, target, wheel)
        for target in NOTES
        for step in steps
        for wheel in SPEED_WHEELS
        if target + step in NOTES
    ]
    times = np.array(in_parallel(setup, _slurred, jobs))
    for target in NOTES:
        own = times[[job[1] == target for job in jobs]]
        soon = 100.0 * (own <= SOON_MS).mean()
        print(f"to {target}: median {np.median(own):3.0f} ms, {soon:3.0f} %")
    print(f"median {np.median(times):.0f} ms")
    return [share("within 60 ms", times <= SOON_MS)]


def _jump(setup: Setup, note: int, target: int, gap_s: float | None) -> float:
    """Return the largest step between samples where notes meet or end.

    It is relative to the largest step inside the notes. A gap of None slurs them.
    """
    take = Take(setup)
    take.on(0.0, note)
    if gap_s is None:
        take.on(0.5, target)
        take.off(0.505, note)
    else:
        take.off(0.5 - gap_s, note)
        take.on(0.5, target)
    take.off(1.0, target)
    steps = np.abs(np.diff(take.play(1.3)))

    def largest(start_s: float, end_s: float) -> float:
        return float(steps[round(start_s * setup.rate) : round(end_s * setup.rate)].max())

    meeting = largest(0.5 - (gap_s or 0.0) - 0.001, 0.58)
    return max(
        meeting / max(largest(0.3, 0.46), largest(0.75, 0.98)),
        largest(0.999, 1.25) / largest(0.75, 0.98),
    )


def clicks(setup: Setup) -> list[Share]:
    """Print the jumps of slurred, rebowed and detached pairs of notes."""
    steps = (-12, -7, -5, -3, -2, -1, 1, 2, 3, 5, 7, 12)
    pairs = [(n, n + step) for n in NOTES for step in steps if n + step in NOTES]
    words = [f"{note} to {target}" for note, target in pairs]
    parts = []
    for name, gap_s in (("slurred", None), ("bow changes", 0.0), ("detached", 0.02)):
        ratios = np.array(in_parallel(setup, _jump, [(*pair, gap_s) for pair in pairs]))
        print(
            f"{name}: median {np.median(ratios):.2f}, 95 % below {np.quantile(ratios, 0.95):.2f}, "
            f"largest {ratios.max():.2f} ({words[int(ratios.argmax())]})"
        )
        parts.append(share_line(name, ratios < CLICK, words))
    return parts
