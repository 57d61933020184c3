"""What free-audio's clap-validator checks of a plug-in, by the small host.

The host itself checks factory, features and texts, and at every sample that is written.
"""

import random

import numpy as np
import pytest

pytestmark = pytest.mark.slow
RATES = (1234.5678, 8000, 12345.678, 22050, 45678.901, 123456.78, 384000, 768000)
BLOCKS = (1, 10, 17, 256, 1536, 2027, 16384)
INTERVALS = (10, 100, 1000)
KEYS, CHANNELS, IDS = range(-1, 128), range(-1, 16), range(-1, 8)


def some_values(chance, shown, *, bounds=False):
    """A value for each parameter, in its range or at one end of it, by number."""
    found = {}
    for each in shown.values():
        value = chance.choice((each.lo, each.hi)) if bounds else chance.uniform(each.lo, each.hi)
        found[each.number] = round(value) if each.steps else value
    return found


def reported_values(reports):
    return {int(number): value for number, value, _ in reports["value"]}


def some_events(chance, frames, count):
    """Notes, expressions and MIDI without order: ends without beginnings, and of any note."""
    lines = []
    for frame in sorted(chance.randrange(frames) for _ in range(count)):
        note = f"{chance.choice(IDS)} {chance.choice(CHANNELS)} {chance.choice(KEYS)}"
        begun = f"{chance.choice(IDS)} {chance.randrange(16)} {chance.randrange(128)}"
        message = chance.randrange(0x80, 0xF0), chance.randrange(128), chance.randrange(128)
        what = chance.choice(
            (
                f"on {begun} {chance.random()}",
                f"off {note}",
                f"choke {note}",
                f"express {chance.randrange(7)} {chance.choice(IDS)} {chance.uniform(-4.0, 4.0)}",
                "midi {} {} {}".format(*message),
                f"time {chance.randrange(2)}",
            )
        )
        lines.append(f"{frame} {what}")
    return lines


def in_order(*lists):
    return sorted(
        (line for lines in lists for line in lines), key=lambda line: int(line.split()[0])
    )


def test_unruly_events_do_no_harm_at_any_rate_and_in_any_block(play):
    chance = random.Random(1)
    cases = [(rate, 0) for rate in RATES] + [(48000, block) for block in BLOCKS]
    for rate, block in cases:
        samples, reports = play(["0 play 1", *some_events(chance, 20000, 400)], 20000, rate, block)
        assert np.abs(samples).max() <= 1.0, (rate, block)
        assert reports["allocated"] == [[0.0]], (rate, block)


def test_any_values_do_no_harm(play, shown):
    chance = random.Random(2)
    lines = []
    for interval in INTERVALS:
        frames = 30 * interval
        own = [
            f"{frame} {chance.choice(('set', 'set', 'modulate'))} {number} {value}"
            for frame in range(0, frames, interval)
            for number, value in some_values(chance, shown, bounds=frame % 20 == 0).items()
        ]
        lines = in_order(own, some_events(chance, frames, 60))
        samples, _ = play(["0 play 1", *lines], frames + 4000, block=512)
        assert np.abs(samples).max() <= 1.0


def test_a_state_comes_back_byte_by_byte(play, shown, tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    values = some_values(random.Random(4), shown)
    own = play([f"0 flush {n} {v}" for n, v in values.items()] + [f"1 save {first}"], 64)[1]
    again = play([f"0 load {first}", f"1 save {second}"], 64)[1]
    values[shown["/preset"].number] = values[shown["/room"].number] = 0.0  # others came after them
    assert reported_values(again) == reported_values(own) == pytest.approx(values, rel=1e-9)
    assert first.read_bytes() == second.read_bytes()


def test_what_is_no_state_is_refused(play, shown, tmp_path):
    state, chance = tmp_path / "state", random.Random(5)
    usual = {each.number: each.default for each in shown.values()}
    for size in (0, 1, 1 << 20):
        state.write_bytes(chance.randbytes(size))
        reports = play([f"0 load {state}"], 64)[1]
        assert reports["loaded"] == [[0.0]], size
        assert reported_values(reports) == usual
