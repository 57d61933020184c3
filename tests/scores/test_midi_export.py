"""A written score as a MIDI file: its notes, tempi and bars, and the controllers of `keyboard`."""

import io
from fractions import Fraction

import mido
import pytest

from yehu_server.scores.midi_export import BEND_RANGE, TICKS, midi_file
from yehu_server.scores.score import Metre
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.written.notated import Mark, Note, Part, Sign, Span, Tempo, Written
from yehu_server.scores.written.performed import performed


def note(beat, length, pitch, *marks) -> Note:
    return Note(Fraction(beat), Fraction(length), float(pitch), marks)


@pytest.fixture
def export(tmp_path):
    """Write a score as MIDI; the score as played, as read again, the file, and what is lost."""

    def run(*notes, **more):
        tempi = (Tempo(Fraction(0), 90.0), Tempo(Fraction(2), 72.0))
        metres = (Metre(0.0, 4.0), Metre(4.0, 3.0))
        part = Part("violin", notes, more.pop("spans", ()), more.pop("signs", ()))
        written = Written((part,), tempi, metres, title="Tune")
        played = performed(written)
        data, lost = midi_file(written, played)
        path = tmp_path / "out.mid"
        path.write_bytes(data)
        return played, read_score(path), mido.MidiFile(file=io.BytesIO(data)), lost

    return run


def controls(file, control) -> list[int]:
    return [m.value for m in file if m.type == "control_change" and m.control == control]


def test_the_notes_read_again_are_those_that_are_played(export):
    played, again, _, lost = export(
        note(0, 2, 67), note(2, 2, 69, Mark("trill", 2.0)), note(4, 3, 71, Mark("fermata"))
    )
    assert not again.warnings
    assert not lost
    for one, other in zip(played.notes, again.notes, strict=True):
        assert (one.key, one.velocity) == (other.key, other.velocity)
        assert other.start_s == pytest.approx(one.start_s, abs=2e-3)
        assert other.end_s == pytest.approx(one.end_s, abs=2e-3)


def test_bars_and_beats_line_up_with_the_score(export):
    _, again, file, _ = export(*(note(n, 1, 67) for n in range(7)))
    assert [each.beat for each in again.notes] == list(range(7))
    assert file.ticks_per_beat == TICKS
    signatures = [
        (m.numerator, m.denominator) for m in file.tracks[0] if m.type == "time_signature"
    ]
    assert signatures == [(4, 4), (3, 4)]
    assert [track.name for track in file.tracks] == ["Tune", "violin"]


def test_settings_become_the_controllers_of_keyboard(export):
    signs = (Sign(Fraction(1), "pizz"), Sign(Fraction(2), "arco"))
    _, _, file, lost = export(*(note(n, 1, 67 + n) for n in range(4)), signs=signs)
    assert controls(file, 67) == [127, 0]
    assert lost == {"/body/gain": 1}


def test_bends_and_slides_are_in_the_file(export):
    _, again, file, lost = export(
        note(0, 2, 67, Mark("slide-in-up")),
        note(2, 2, 72),
        spans=(Span("portamento", Fraction(0), Fraction(2)),),
    )
    wheel = [m.pitch for m in file if m.type == "pitchwheel"]
    assert wheel[0] == round(-2 / BEND_RANGE * 8191)
    assert wheel[-1] == 0
    moves = [(m.control, m.value) for m in file if m.type == "control_change"]
    of_range = [move for move in moves if move[0] in (101, 100, 6, 38)]
    assert of_range == [(101, 0), (100, 0), (6, BEND_RANGE), (38, 0)]  # RPN 0, semitones and cents
    assert controls(file, 65) == [127, 0]
    assert again.notes[1].start_s < 2 * 60 / 90
    assert lost == {}
