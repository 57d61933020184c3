"""The reader of MusicXML agrees with music21, note for note: beat, length and pitch.

`tests/scores/judge_musicxml.py` wrote what music21 reads.
"""

import json
from fractions import Fraction
from pathlib import Path

from yehu_server.scores.musicxml.reader import read_musicxml

CASES = json.loads(Path(__file__).with_name("music21.json").read_text(encoding="utf-8"))


def test_the_notes_are_those_that_music21_reads(tmp_path):
    path, wrong = tmp_path / "tune.musicxml", []
    for name, case in CASES.items():
        path.write_text(case["text"], encoding="utf-8")
        written = read_musicxml(path)
        found = [(each.beat, each.length, each.pitch) for p in written.parts for each in p.notes]
        found.sort(key=lambda note: (note[0], note[2], note[1]))
        expected = [(Fraction(beat), Fraction(length), to) for beat, length, to in case["notes"]]
        if found != expected or written.unknown:
            wrong.append((name, found, expected, written.unknown))
    assert wrong == []
