"""The CLAP plug-in in a small host."""

import numpy as np
import pytest
from plugin.sounds import FRAMES, PHRASE, by_library, frequency, level_db, script

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.playing.preset_folders import Presets

pytestmark = pytest.mark.slow
PLAYS = ["0 play 1"]


def test_it_plays_the_samples_of_the_library_in_blocks_of_any_size(play, library):
    wanted = by_library(library, PHRASE, FRAMES)
    assert np.abs(wanted).max() > 0.1
    for block in (1, 32, 441, 4096, 0):
        samples, reports = play(PLAYS + script(PHRASE), FRAMES, block=block)
        assert np.array_equal(samples, wanted), block
        assert reports["allocated"] == [[0.0]]
        assert reports["latency"] == [[0.0]]


def test_resampled_sound_is_that_of_the_own_rate_but_late(play):
    usual, _ = play(PLAYS + script(PHRASE), FRAMES)
    double, reports = play(PLAYS + script(PHRASE, 2.0), 2 * FRAMES, rate=96000, block=0)
    late = int(reports["latency"][0][0])
    begin = slice(0, 20000)  # before rounding of times can matter
    difference = double[late::2][begin] - usual[begin]
    assert level_db(difference) < level_db(usual[begin]) - 35.0


def test_a_parameter_moves_at_its_frame(play, shown):
    gain = shown["/output/gain"].number
    plays = [*PLAYS, f"0 set {shown['/room/level'].number} 0"]  # nothing rings on
    still, _ = play(plays + script(PHRASE), FRAMES)
    for block in (64, 4096):
        moved, _ = play([*plays, *script(PHRASE[:2]), f"14461 set {gain} -40"], FRAMES, block=block)
        assert np.array_equal(moved[:14461], still[:14461])
        assert not np.array_equal(moved[14461:14480], still[14461:14480])
        later = slice(26000, 28000)
        assert level_db(moved[later]) < level_db(still[later]) - 30.0


def test_keys_that_choose_articulations_have_names(play, shown):
    mapping = shown["/mapping"]
    switches = mapping.choices.index("keyboard-articulations")
    _, reports = play(PLAYS, 256)
    assert reports["names"] == [[0, -1, 0]]
    _, reports = play([*PLAYS, f"0 set {mapping.number} {switches}"], 1024)
    last = 36 + len(ARTICULATIONS) - 1
    assert reports["names"] == [[len(ARTICULATIONS), last, 1]]
    assert f"last-{ARTICULATIONS[-1].name}" in reports


def test_a_preset_moves_what_it_names_and_reports_it(play, shown):
    hall = shown["/room"].choices.index("hall")
    _, reports = play([*PLAYS, f"100 set {shown['/room'].number} {hall}"], 2000)
    moved = {int(number): value for number, value in reports["moved"]}
    preset = Presets(user_first=False).find("hall").values
    assert moved[shown["/room/size"].number] == preset["/room/size"]
    values = {int(number): value for number, value, _ in reports["value"]}
    assert values[shown["/room/decay"].number] == preset["/room/decay"]
    assert values[shown["/playing/speed"].number] == shown["/playing/speed"].default
    assert values[shown["/preset"].number] == shown["/preset"].default


def test_an_old_value_that_comes_again_does_not_undo_a_preset(play, shown):
    preset, plucks = shown["/preset"], shown["/playing/pizzicato"].number
    choice = preset.choices.index("pizzicato")
    chosen = [*PLAYS, f"1000 set {preset.number} {choice}"]

    def last(*lines, frames=4000):
        _, reports = play([*chosen, *lines], frames, block=128)
        found = {int(number): value for number, value, _ in reports["value"]}
        return found[plucks], found[preset.number]

    assert last(f"1010 set {plucks} 0") == (1.0, choice)  # not heard of yet
    again = [f"{frame} set {plucks} 0" for frame in range(0, 4000, 128)]
    _, reports = play([*again[:8], *chosen[1:], *again[8:]], 4000, block=128)
    assert dict(map(tuple, (row[:2] for row in reports["value"])))[plucks] == 1.0
    # Later it is a command; the preset is none as long as it holds.
    assert last(f"2000 set {plucks} 0") == (0.0, 0.0)
    assert last(f"2000 set {plucks} 0", f"3000 set {plucks} 1") == (1.0, choice)
    assert last(f"2000 flush {plucks} 0") == (0.0, 0.0)


def test_state_opens_in_a_new_instance(play, shown, tmp_path):
    state = tmp_path / "state"
    wind = shown["/mapping"].choices.index("wind")
    wanted = {"/mapping": wind, "/tuning": 1, "/playing/bow_position": 0.2, "/room/level": 0}
    changed = [f"0 set {shown[address].number} {value}" for address, value in wanted.items()]
    # The phrase, with breath, after a reset.
    later = script([(frame + 2000, *rest) for frame, *rest in [(0, 0xB0, 2, 90), *PHRASE]])
    first, reports = play([*changed, f"2000 save {state}", "2000 reset", *later], FRAMES)
    assert reports["saved"] == [[1.0]]
    second, again = play([f"0 load {state}", "2000 reset", *later], FRAMES)
    assert again["loaded"] == [[1.0]]
    assert again["value"] == reports["value"]
    assert np.array_equal(first[2000:], second[2000:])
    assert np.abs(first).max() > 0.01
    # One of another version opens as far as it is known.
    state.write_text(
        "yehu 9\n/playing/nothing=3\n/mapping=theremin\n/playing/press=2.5\n"
        "/playing/direction=-1\n/playing/string=outer\nand more"
    )
    values = {int(number): value for number, value, _ in play([f"0 load {state}"], 64)[1]["value"]}
    assert values[shown["/playing/press"].number] == 2.5
    assert values[shown["/mapping"].number] == 0.0
    assert values[shown["/playing/direction"].number] == -1.0  # by its number, as once
    assert values[shown["/playing/string"].number] == 2.0
    state.write_text("yehu 1\n/preset=vibrato, changed\n/playing/vibrato=40\n")
    assert play([f"0 load {state}", f"1 save {state}"], 64)[1]["saved"] == [[1.0]]
    assert "/preset=vibrato, changed\n" in state.read_text()
    state.write_text("RIFF")
    assert play([f"0 load {state}"], 64)[1]["loaded"] == [[0.0]]


def test_a_bounce_sounds_like_the_last_one(play, shown):
    once = script(PHRASE)
    again = [f"{int(line.split()[0]) + 100000} {line.partition(' ')[2]}" for line in once]
    end = ["95000 midi 176 121 0", "95000 midi 176 1 64", "95000 play 0", "100000 play 1"]
    begin = ["0 play 1", "0 midi 176 1 64"]
    samples, _ = play([*begin, *once, *end, *again], 100000 + FRAMES, block=256)
    assert np.array_equal(samples[:FRAMES], samples[100000:])
    live = [f"0 set {shown['/chance'].number} 0", *begin]
    samples, _ = play([*live, *once, *end, *again], 100000 + FRAMES, block=256)
    assert not np.array_equal(samples[:FRAMES], samples[100000:])


def test_notes_with_expressions_bend_one_by_one_and_pedals_hold_them(play, shown):
    straight = [f"0 set {shown['/playing/vibrato'].number} 0"]
    notes = ["0 on 7 0 69 0.7", "24000 express 2 7 1.5", "40000 off 7 0 69", "44000 on 8 0 69 0.7"]
    samples, _ = play(straight + notes, 64000)
    bent, plain = (frequency(samples[a : a + 10000], 48000) for a in (28000, 52000))
    assert 1200.0 * np.log2(bent / plain) == pytest.approx(150.0, abs=8.0)
    held, _ = play(["0 midi 176 64 127", *notes[:1], "24000 off -1 0 69"], 64000)
    assert level_db(held[50000:]) > level_db(held[10000:20000]) - 6.0
