"""What was played becomes a written score: beats, lengths, slurs, dynamics, keys."""

import random
from fractions import Fraction
from pathlib import Path

import mido
import numpy as np
import pytest

from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import BEGIN, COMMAND, END, EXPRESS, STOP, WRITE
from yehu_server.core.player.parameter_indices import INDEX, PLAYING
from yehu_server.errors import ScoreError
from yehu_server.scores.capture_header import SessionStart
from yehu_server.scores.capture_writer import CaptureWriter
from yehu_server.scores.midi_export import midi_file
from yehu_server.scores.reading import read_any, read_written
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.transcription import read_as_written, written_of_midi
from yehu_server.scores.written.in_range import default_parts
from yehu_server.scores.written.performed import performed

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
RATE = 48000.0


def test_beside_chords_the_part_that_a_render_plays_is_the_one_that_is_shown(tmp_path):
    def track(name, channel, *chords):
        messages = [mido.MetaMessage("track_name", name=name)]
        for chord in chords:
            for kind in ("note_on", "note_off"):
                messages += [mido.Message(kind, channel=channel, note=key) for key in chord]
                messages[-len(chord)].time = 480 if kind == "note_off" else 0
        return mido.MidiTrack(messages)

    path = tmp_path / "band.mid"
    chords = [(60, 64, 67, 71, 74), (62, 65, 69, 72, 76)] * 4  # their highest notes move
    tracks = [track("Piano", 0, *chords), track("Violin", 1, *zip(range(67, 75), strict=True))]
    mido.MidiFile(tracks=tracks).save(path)
    written, _ = read_as_written(path)
    assert default_parts(written) == [1]
    assert read_any(path).remarks[0].startswith("plays Violin; also there: Piano")


def test_a_midi_file_becomes_the_tune_that_it_was_made_from():
    """shi_bei_jiu.mid is that jianpu, with its tempo, bows and accents, played by a script."""
    written, _ = written_of_midi(read_score(EXAMPLES / "shi_bei_jiu.mid"))
    tune = read_written(EXAMPLES / "shi_bei_jiu.jianpu")
    [own], [other] = written.parts, tune.parts
    assert [(note.beat, note.length, note.pitch) for note in own.notes] == [
        (note.beat, note.length, note.pitch) for note in other.notes
    ]
    assert {*own.spans} == {span for span in other.spans if span.name == "slur"}
    assert written.tempi[0].quarters_per_minute == tune.tempi[0].quarters_per_minute
    assert written.metres[-1].quarters == 2.0


def midi(path: Path, notes, ticks=480, channel=0) -> Path:
    """Write notes: from and to a beat, key, velocity."""
    file = mido.MidiFile(ticks_per_beat=ticks)
    track = file.add_track()
    moves = [(begin, 1, key, loud) for begin, _, key, loud in notes]
    moves += [(end, 0, key, 0) for _, end, key, _ in notes]
    now = 0
    for beat, on, key, loud in sorted(moves, key=lambda move: move[:2]):
        tick = round(beat * ticks)
        kind = "note_on" if on else "note_off"
        message = mido.Message(kind, note=key, velocity=loud, channel=channel, time=tick - now)
        track.append(message)
        now = tick
    file.save(path)
    return path


def test_keys_are_those_of_the_file_but_c_that_programs_write_unasked(tmp_path):
    tune = [(beat, beat + 1, key, 80) for beat, key in enumerate((67, 69, 71, 72, 74, 76, 78, 79))]
    wrong = []
    for signatures, expected in [
        ([], [(0, 1)]),  # what the notes fit: G
        ([(0, "C")], [(0, 1)]),
        ([(0, "Eb")], [(0, -3)]),
        ([(0, "Em"), (4, "Bb")], [(0, 1), (4, -2)]),
        ([(4, "F#")], [(0, 0), (4, 6)]),
        ([(0, "Cb"), (4, "C#")], [(0, -7), (4, 7)]),
        ([(0, "F"), (0, "C")], [(0, -1)]),  # as two tracks say it
        ([(0, "Eb"), (4, "Eb"), (8, "C"), (9, "C")], [(0, -3), (8, 0)]),
    ]:
        path = midi(tmp_path / "x.mid", tune)
        file = mido.MidiFile(path)
        track, now = file.add_track(), 0
        for beat, key in signatures:
            track.append(mido.MetaMessage("key_signature", key=key, time=480 * (beat - now)))
            now = beat
        file.save(path)
        written, _ = written_of_midi(read_score(path))
        if (found := [(sign.beat, sign.fifths) for sign in written.keys]) != expected:
            wrong.append((signatures, found))
        (tmp_path / "again.mid").write_bytes(midi_file(written, performed(written))[0])
        again, _ = written_of_midi(read_score(tmp_path / "again.mid"))
        if again.keys != written.keys:
            wrong.append((signatures, again.keys))
    assert not wrong


def test_beats_are_divided_as_they_were_written(tmp_path):
    chance = random.Random(4)
    groups = [(1,), (Fraction(1, 2),) * 2, (Fraction(1, 3),) * 3, (Fraction(1, 4),) * 4,
              (Fraction(3, 4), Fraction(1, 4)), (Fraction(1, 6),) * 6, (Fraction(1, 8),) * 8,
              (Fraction(2, 3), Fraction(1, 3)), (Fraction(1, 5),) * 5, (2,), (4,)]  # fmt: skip
    wrong = []
    for number in range(40):
        beat, expected = Fraction(0), []
        for _ in range(20):
            for length in chance.choice(groups):
                expected.append((beat, Fraction(length), 60 + chance.randrange(24)))
                beat += length
        # A program lets go a little early; a rest that is a rest stays one.
        notes = [(at, at + length * Fraction(19, 20), key, 80) for at, length, key in expected]
        path = midi(tmp_path / f"{number}.mid", notes)
        found = read_as_written(path)[0].parts[0].notes
        if [(note.beat, note.length, int(note.pitch)) for note in found] != expected:
            wrong.append(number)
    assert not wrong


def test_loudness_overlaps_and_keys_become_dynamics_slurs_and_signatures(tmp_path):
    loud = [50] * 4 + [96, 96, 112, 96] + [50, 52, 48, 50]
    notes = [(at, at + 1.02 - 0.1 * (at % 2), 69 + at % 3, loud[at]) for at in range(12)]
    written, _ = read_as_written(midi(tmp_path / "a.mid", [*notes, (12, 13, 74, 50)]))
    [part] = written.parts
    assert [(sign.beat, sign.name) for sign in part.signs] == [(0, "p"), (4, "f"), (8, "p")]
    assert [note.beat for note in part.notes if note.marks] == [6]
    assert {(span.begin, span.end) for span in part.spans} == {
        (at, at + 1) for at in range(0, 12, 2)
    }
    assert [key.fifths for key in written.keys] == [2]  # D, on which it ends
    plain, left = read_as_written(midi(tmp_path / "b.mid", [(0, 1, 60, 64), (0, 1, 67, 64)]))
    assert [(note.pitch, note.marks) for note in plain.parts[0].notes] == [(67.0, ())]
    assert not plain.parts[0].signs
    assert left == {"lower notes of chords": 1}


def test_a_capture_is_written_as_its_players_played(tmp_path):
    path = tmp_path / "session.jsonl"
    writer = CaptureWriter(path, beginning=SessionStart((InstrumentSpec(RATE),)))
    second = int(RATE)
    commands = [
        (0, EXPRESS, PLAYING.velocity, 80 / 127, 0.0),
        (0, BEGIN, 0, 67.0, 67.0),
        (second, BEGIN, 0, 60.0, 72.0),  # C4, moved into range; it begins while G4 is held
        (second + 500, END, 0, 67.0, 0.0),
        (2 * second - 1, WRITE, INDEX["/bow/force"], 1.0, 0.0),  # which no score has
        (2 * second, STOP, 0, 0.0, 0.0),
    ]
    writer.commands(np.array(commands, COMMAND))
    writer.close(3 * second)
    written, left = read_as_written(path, tempo=60.0)
    [part] = written.parts
    assert [(note.beat, note.length, note.pitch) for note in part.notes] == [
        (0, 1, 67.0),
        (1, 1, 72.0),
    ]
    assert [(span.name, span.begin, span.end) for span in part.spans] == [("slur", 0, 1)]
    assert left == {"moves of bow and fingers": 1}
    assert [tempo.quarters_per_minute for tempo in written.tempi] == [60.0]


def test_what_holds_no_note_is_refused(tmp_path):
    path = tmp_path / "session.jsonl"
    CaptureWriter(path, beginning=SessionStart((InstrumentSpec(RATE),))).close(100)
    file = mido.MidiFile()
    file.add_track().append(mido.Message("control_change", control=11, value=90))
    file.save(tmp_path / "silent.mid")
    for name in ("session.jsonl", "silent.mid"):
        with pytest.raises(ScoreError, match=f"{name}: has no note"):
            read_as_written(tmp_path / name)


def test_a_track_whose_notes_have_no_velocity_is_no_part(tmp_path):
    path = midi(tmp_path / "x.mid", [(0, 1, 60, 80)])
    file = mido.MidiFile(path)
    file.add_track().append(mido.Message("note_on", note=60, velocity=0, channel=1))
    file.save(path)
    written, _ = written_of_midi(read_score(path))
    assert [len(part.notes) for part in written.parts] == [1]
