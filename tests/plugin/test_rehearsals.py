"""The plug-in as projects use it: many at once, automated, at other rates, by damaged states."""

import random
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from plugin.conftest import HERE
from plugin.lv2_host import Plugin
from plugin.sounds import PHRASE, frequency, level_db, script
from plugin.test_clap_rules import in_order, reported_values, some_values

from yehu_server.plugin.lv2_texts import FIRST_PARAMETER, in_lv2

pytestmark = pytest.mark.slow
INSTANCES = 16
OLD_STATE = HERE / "old_state.txt"  # saved before articulations were a list, with 128 of them


def test_sixteen_instances_play_what_each_plays_alone(built, shown):
    ports = {FIRST_PARAMETER + i: each.default for i, each in enumerate(in_lv2(shown.values()))}
    frames = 24000

    def played(transposed):
        plugin = Plugin(built / "Yehu.lv2" / "Yehu.so", 48000.0, ports)
        phrase = [
            (at // 3, kind, one - transposed if kind in (0x80, 0x90) else one, two)
            for at, kind, one, two in PHRASE
        ]
        samples = plugin.play(phrase, frames, 128 + transposed).copy()
        plugin.close()
        return samples

    alone = [played(key) for key in range(4)]
    with ThreadPoolExecutor(INSTANCES) as together:
        for number, samples in enumerate(together.map(played, [i % 4 for i in range(INSTANCES)])):
            assert np.array_equal(samples, alone[number % 4]), number


def test_every_parameter_moves_at_its_frame(play, shown):
    """As it does in blocks of one frame."""
    chance = random.Random(6)
    moves = []
    for number, value in some_values(chance, shown).items():
        at = 4801 + 2 * chance.randrange(9000)
        moves += [f"{at} set {number} {value}"]
    lines = in_order(script(PHRASE), moves, ["30000 midi 144 81 100"])
    wanted, reports = play(["0 play 1", *lines], 36000, block=1)
    moved = reported_values(reports)
    assert len(moved) == len(shown)
    for block in (64, 1024, 0):
        samples, reports = play(["0 play 1", *lines], 36000, block=block)
        assert reported_values(reports) == moved, block
        assert np.array_equal(samples, wanted), block


def test_loops_and_tempi_change_no_sample(play):
    begins = ["0 play 1", *script(PHRASE)]
    wanted, _ = play(begins, 90000)
    jumps = [f"{frame} play 1 {tempo}" for frame, tempo in ((9000, 60), (33000, 240), (61000, 9.5))]
    assert np.array_equal(play(in_order(begins, jumps), 90000)[0], wanted)


def test_another_rate_and_a_reset_keep_what_was_set(play, shown):
    gain, preset = shown["/output/gain"], shown["/preset"]
    choice = preset.choices.index("ordinary")
    own = [f"0 set {preset.number} {choice}", f"0 set {gain.number} -20"]
    note = ["{} midi 144 69 100", "{} midi 128 69 0"]
    lines = [line.format(at) for line, at in zip(2 * note, (100, 20000, 48100, 90000), strict=True)]
    samples, reports = play(
        [*own, *lines[:2], "24000 reset", "48000 rate 96000", *lines[2:]], 88000
    )
    values = reported_values(reports)
    assert (values[gain.number], values[preset.number]) == (-20.0, choice)
    assert np.abs(samples[24000:48000]).max() < 1e-6  # nothing is left after the reset
    before, after = samples[8000:18000], samples[66000:86000]
    assert 1200.0 * abs(np.log2(frequency(after, 96000) / frequency(before, 48000))) < 3.0
    assert level_db(after) == pytest.approx(level_db(before), abs=1.0)


def test_a_state_of_an_older_version_opens_as_it_was(play, shown, tmp_path):
    state = tmp_path / "state"
    kept = OLD_STATE.read_text()
    state.write_text(kept)
    _, reports = play([f"0 load {state}", f"1 save {state}"], 64)
    assert reports["loaded"] == [[1.0]]
    old = dict(line.split("=") for line in kept.splitlines()[1:])
    new = dict(line.split("=") for line in state.read_text().splitlines()[1:])
    for address in "string", "direction", "pizzicato", "portamento":  # which had no names then
        each = shown[f"/playing/{address}"]
        old[each.address] = each.choices[int(float(old[each.address]) - each.lo)]
    assert {address: new[address] for address in old} == old
    state.write_text(kept.replace("=spiccato", "=77"))  # one of those without a name
    values = reported_values(play([f"0 load {state}"], 64)[1])
    assert values[shown["/playing/articulation"].number] == 0.0


def test_states_that_someone_damaged_do_no_harm(play, shown, tmp_path):
    chance = random.Random(7)
    kept = OLD_STATE.read_bytes()
    odd = (
        b"=",
        b"\0",
        b"\n",
        b"1e999",
        b"-1e308",
        b"nan",
        b"0x7fffffff",
        b", changed",
        b"A" * 70000,
    )
    lines = []
    for number in range(300):
        data = bytearray(kept)
        for _ in range(chance.randrange(1, 20)):
            at = chance.randrange(len(data))
            data[at : at + chance.randrange(9)] = chance.choice((*odd, chance.randbytes(4)))
        (tmp_path / f"{number}").write_bytes(data)
        lines.append(f"{64 * number} load {tmp_path / str(number)}")
    heading, *rest = kept.decode().splitlines()
    wrong = [f"{line.split('=')[0]}={chance.choice(('1e308', '-1e308', '999'))}" for line in rest]
    (tmp_path / "last").write_text("\n".join([heading, *wrong]))
    lines.append(f"{64 * 300} load {tmp_path / 'last'}")
    samples, reports = play(["0 midi 144 69 100", *lines], 64 * 300 + 4000, block=64)
    assert len(reports["loaded"]) == 301
    assert np.abs(samples).max() <= 1.0
    limits = {each.number: (each.lo, each.hi) for each in shown.values()}
    for number, value in reported_values(reports).items():
        assert limits[number][0] <= value <= limits[number][1]


def test_values_come_by_flushes_as_by_blocks_and_not_from_other_spaces(play, shown):
    values = some_values(random.Random(8), shown)
    by_blocks = play(
        [f"{i} set {n} {v}" for i, (n, v) in enumerate(values.items())], 4000, block=64
    )
    idle = play([f"{64 * i} idle {n} {v}" for i, (n, v) in enumerate(values.items())], 8000)
    assert reported_values(by_blocks[1]) == reported_values(idle[1])
    foreign = play([f"0 foreign {n} {v}" for n, v in values.items()], 64)[1]
    usual = {each.number: each.default for each in shown.values()}
    assert reported_values(foreign) == usual
