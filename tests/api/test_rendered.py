"""``yehu.render``: files and lists of notes to sound, as the command renders them."""

import shlex
from pathlib import Path

import numpy as np
import pytest
import soundfile
from fiddles import SLACK, SLACK_TOML
from midi_files import midi_file, notes
from pitch import cents, pitch_of

import yehu_server as yehu
from yehu_server import Note
from yehu_server.api.notes import score_of

RATE = 44100
PHRASE = [("F4", 0.0, 0.3), ("A4", 0.3, 0.3), ("C5", 0.6, 0.4)]


@pytest.fixture
def tune(tmp_path) -> Path:
    return midi_file(tmp_path / "tune.mid", notes((0.0, 0.3, 67, 90), (0.3, 0.3, 72, 60)))


@pytest.fixture
def plain(tmp_path) -> Path:
    """A tune that phrasing shapes: all its notes are alike."""
    pitches = (67, 69, 72, 74, 72, 69)
    rows = ((0.25 * place, 0.25, pitch, 80) for place, pitch in enumerate(pitches))
    return midi_file(tmp_path / "plain.mid", notes(*rows))


# ---------------------------------------------------------------- files


SCALE = next((Path(__file__).parents[2] / "tunings").glob("*.scl"))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, ""),
        ({"dry": True, "mono": True, "sample_rate": 48000}, "--dry --mono --rate 48000"),
        ({"preset": "flautando", "seed": 3}, "--preset flautando --seed 3"),
        ({"settings": {"/playing/vibrato": 20.0}}, "--set /playing/vibrato=20"),
        ({"normalize": True, "phrasing": 0.0}, "--normalize --phrasing 0"),
        ({"loudness_lufs": -31.0}, "--loudness -31"),
        ({"gain_db": -6.0, "tuning": SCALE}, f"--gain-db -6 --tuning {shlex.quote(str(SCALE))}"),
        ({"instrument": SLACK}, "--instrument mine.toml"),
    ],
)
def test_it_is_the_sound_of_the_command(plain, tmp_path, monkeypatch, command, options, words):
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(SLACK_TOML)
    target = tmp_path / "out.wav"
    form = ("--subtype", "float", "--tail", "0.2")
    assert command("render", plain, "-o", target, *form, *shlex.split(words))[0] == 0
    expected, rate = soundfile.read(target, dtype="float32")
    found = yehu.render(plain, tail=0.2, **options)
    assert found.sample_rate == rate
    np.testing.assert_array_equal(found.sound, expected)


def test_what_could_not_be_played_as_written_is_reported(tmp_path):
    low = midi_file(tmp_path / "low.mid", notes((0.0, 0.2, 40, 90)))
    (warning,) = yehu.render(low).warnings
    assert warning.startswith("moved to fit F4 to F6: three octaves up (a deeper fiddle for it")
    damaged = tmp_path / "damaged.mid"
    damaged.write_bytes(low.read_bytes()[:-6])
    assert len(yehu.render(damaged).warnings) > 1


def test_it_is_saved_and_read_again_and_replaces_nothing_unasked(tune, tmp_path, refused):
    found = yehu.render(tune)
    for target in (tmp_path / "a.wav", tmp_path / "a.flac"):
        target.write_text("what was there")
        refused("exists; --overwrite, in Python overwrite=True", found.save, target)
        assert target.read_text() == "what was there"
        found.save(target, overwrite=True)
        found.save(target)  # our own
        again, rate = soundfile.read(target)
        assert (rate, soundfile.info(target).subtype) == (RATE, "PCM_24")
        assert np.abs(again - found.sound).max() < 2.0**-22


def test_what_cannot_be_saved_is_reported(tune, tmp_path, monkeypatch, refused):
    monkeypatch.chdir(tmp_path)
    before, found = sorted(tmp_path.iterdir()), yehu.render(tune, tail=0.0)
    refused("mp3", found.save, "a.mp3")
    refused("nowhere", found.save, "nowhere/a.wav")
    refused("float", found.save, "a.flac", subtype="float")
    refused("subtype", found.save, "a.wav", subtype="8")
    assert sorted(tmp_path.iterdir()) == before


# ---------------------------------------------------------------- lists of notes


def test_a_list_of_notes_is_played_in_time_and_in_tune():
    between_keys, done = [("A4+50", 1.0, 0.5), (67.25, 1.5, 0.5)], []
    options = {"dry": True, "mono": True, "progress": lambda *each: done.append(each)}
    sounds = [yehu.render(PHRASE + between_keys, seed=n, **options).sound for n in (1, 2, 3)]
    done = done[-len(done) // len(sounds) :]
    for note, begin, end in (
        *((65, 0.15, 0.3), (69, 0.45, 0.6), (72, 0.75, 1.0)),
        *((69.5, 1.25, 1.5), (67.25, 1.75, 2.0)),
    ):
        wanted = 440.0 * 2.0 ** ((note - 69.0) / 12.0)
        parts = (sound[round(begin * RATE) : round(end * RATE)] for sound in sounds)
        off = [cents(pitch_of(part, RATE), wanted) for part in parts]
        assert np.median(off) == pytest.approx(0.0, abs=15.0), (note, off)
    assert done == sorted(done)
    assert done[-1][1] == pytest.approx(2.0, abs=0.01)


def test_notes_come_in_any_form():
    expected = yehu.render(PHRASE, tail=0.0).sound
    for same in (
        [Note(*row) for row in PHRASE],
        [list(row) for row in reversed(PHRASE)],
        np.array([[65, 0.0, 0.3, 80], [69, 0.3, 0.3, 80], [72, 0.6, 0.4, 80]]),
        iter(PHRASE),
    ):
        np.testing.assert_array_equal(yehu.render(same, tail=0.0).sound, expected)


def test_a_note_ends_where_the_next_one_of_its_key_begins():
    rows = [("A4", 0.0, 1.0), ("C5", 0.2, 0.1), (69.3, 0.5, 0.2), ("A4", 0.8, 0.3)]
    ends = [each.time_s for each in score_of(rows).events if each.message.type == "note_off"]
    assert ends == pytest.approx([0.3, 0.5, 0.7, 1.1])


# ---------------------------------------------------------------- what is refused


def test_a_wrong_score_is_reported_in_one_line(refused):
    for score, names in (
        ("/no/such.mid", "such.mid"),
        (7, "score"),
        (None, "score"),
        ([], "no notes"),
        ([("A4", 0.0)], "note 0"),
        (
            [("A4", 0.0, 0.5), ("X9", 0.5, 0.5)],
            "note 1: pitch: expected a note such as",
        ),
        ([("A4", -1.0, 0.5)], "start"),
        ([("A4", 0.0, 0.0)], "duration"),
        ([("A4", 0.0, 1e9)], "duration"),
        ([("A4", 0.0, 0.5, 0)], "velocity"),
        (["A4", "C5"], "note 0"),
        (np.zeros((2, 7)), "note 0"),
        (np.array([[65.0, np.nan, 1.0]]), "start"),
    ):
        refused(names, yehu.render, score)


def test_a_wrong_option_is_reported_in_one_line(tune, refused):
    for name, wrong in (
        *(("phrasing", 2.0), ("tail", -1.0), ("gain_db", 90.0), ("channels", [0])),
        *(("channels", 3), ("mapping", 3), ("song", 0), ("song", 5)),
    ):
        refused(name, yehu.render, tune, **{name: wrong})
    for name, wrong in (("out_of_range", "drop"), ("mapping", "no-such"), ("preset", "loud")):
        refused(wrong, yehu.render, tune, **{name: wrong})
    with pytest.raises(TypeError, match="prset"):  # as Python does
        yehu.render(tune, prset="flautando")
