"""Keys of a MIDI file that a mapping takes as key switches are no notes, whatever reads them."""

from dataclasses import replace

import mido
import numpy as np
import pytest
from midi_files import midi_file, notes

from yehu_server.errors import ScoreError
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.tuning import RangePolicy
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.rendering.to_files import render
from yehu_server.scores.reading import ReadOptions, part_of, read_any
from yehu_server.scores.score import Score
from yehu_server.scores.transcription import read_as_written

PLAYING = PlayingOptions(mapping=load("keyboard-articulations")).shaping(0.5)
FIRST = 36  # C2
CHOSEN = ((0.0, 0), (0.5, 9))  # times (s), articulations: ordinary, pizzicato
# Leaps that slide where they are bowed; an octave lower still above C♯4.
TUNE = ((0.05, 0.5, 74), (0.55, 0.5, 81), (1.05, 0.5, 74))


def tune(lower: int = 0, channel: int = 1):
    return notes(*((at, long, key - lower, 80) for at, long, key in TUNE), channel=channel)


def switches(channel: int = 1):
    return notes(*((at, 0.04, FIRST + number, 100) for at, number in CHOSEN), channel=channel)


def controllers(channel: int = 1):
    cc = {"type": "control_change", "control": 32, "channel": channel - 1}
    return [(at, mido.Message(value=number, **cc)) for at, number in CHOSEN]


@pytest.fixture
def read(tmp_path):
    """Read messages of a file as the mapping has them."""

    def run(*messages, playing: PlayingOptions = PLAYING, all_parts: bool = False) -> Score:
        path = midi_file(tmp_path / "tune.mid", messages)
        return read_any(path, ReadOptions.by(playing, all_parts=all_parts))

    return run


def sound(score: Score) -> tuple[np.ndarray, dict[int, int]]:
    how = Options(rate=22050, is_dry=True, is_mono=True, tail_s=0.1)
    performance = Performance([Part.shaped([score], PLAYING)], how)
    samples = np.concatenate(list(performance.blocks()))
    return samples, dict(performance.player.notes_by_channel)


@pytest.mark.parametrize("lower", [0, 12])
def test_key_switches_sound_as_the_controller_does(read, lower):
    by_keys = read(*switches(), *tune(lower))
    by_controller = read(*controllers(), *tune(lower))
    taken = "notes taken as key switches: 2 (articulations: 2)"
    assert by_keys.remarks == (taken, *by_controller.remarks)
    assert len(by_controller.remarks) == lower // 12  # "moved to fit"
    samples, channels = sound(by_keys)
    assert channels == {0: len(TUNE)}
    assert samples.any()
    np.testing.assert_array_equal(samples, sound(by_controller)[0])


def test_a_channel_of_key_switches_is_no_part_and_moves_no_other(read):
    """Nor do the switches of parts that are not played choose anything."""
    score = read(*switches(2), *tune(12))
    assert [part.channel for part in score.parts] == [0]
    assert {note.channel for note in score.notes} == {0}
    low = [(at + 0.01, message) for at, message in tune(12, channel=2)]
    chosen = read(*tune(), *low, *switches(2))
    assert chosen.remarks[1].startswith("plays ")
    assert not [each for each in chosen.events if each.message.type == "setting"]
    every = read(*tune(), *low, *switches(2), all_parts=True)
    second = part_of(every, 1)
    assert [each.message.value for each in second.events if each.message.type == "setting"] == [
        0,
        9,
    ]
    assert [note.key for note in second.notes] == [key for *_, key in TUNE]


def test_other_mappings_and_percussion_have_notes_there(read):
    usual = replace(PLAYING, mapping=load("keyboard"))
    assert len(read(*switches(), *tune(), playing=usual).notes) == len(TUNE) + len(CHOSEN)
    assert len(read(*switches(10), *tune()).notes) == len(TUNE) + len(CHOSEN)
    drummer = replace(PLAYING, channels=frozenset({0, 9}))
    assert len(read(*switches(10), *tune(), playing=drummer).notes) == len(TUNE)


def test_keys_of_another_library_far_below_are_left_out_and_the_tune_moves(read, tmp_path):
    """Those of a mapping are read before."""
    skips = replace(PLAYING, mapping=load("keyboard"), policy=RangePolicy.SKIP)
    score = read(*switches(), *tune(12), playing=skips)
    assert [note.key for note in score.notes] == [key for *_, key in TUNE]
    assert score.remarks[0] == "notes far below the tune left out, as key switches: 2"
    assert "an octave up" in score.remarks[1]
    line = "may be key switches, far below the tune: 2 notes (--range skip)"
    shown, _ = read_as_written(tmp_path / "tune.mid")
    assert shown.remarks == (line,)
    assert read(*switches(), *tune(), playing=replace(skips, policy=PLAYING.policy)).remarks == (
        line,
    )


def test_a_rendering_without_a_note_is_an_error_and_writes_nothing(read, tmp_path):
    clamps = replace(PLAYING, mapping=load("keyboard"), policy=RangePolicy.CLAMP)
    part = Part.shaped([read(*tune(36), playing=clamps)], replace(clamps, policy=RangePolicy.SKIP))
    with pytest.raises(ScoreError, match="tune: none of its notes is played"):
        render([part], tmp_path / "out.wav", Options(rate=22050, tail_s=0.0))
    assert not (tmp_path / "out.wav").exists()


def test_a_tune_that_is_all_key_switches_is_refused(read):
    with pytest.raises(ScoreError, match=r"no other note: .* 3 \(articulations: 2\)"):
        read(*tune(36))
