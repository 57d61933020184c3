"""The reader of MusicXML agrees with music21, note for note: beat, length and pitch.

`tests/scores/judge_musicxml.py` wrote what music21 reads.
"""

from __future__ import annotations

import hashlib
import json
from fractions import Fraction
from pathlib import Path

import pytest
from scores.musicxml_corpus import CORPUS

from yehu_server.scores.musicxml.reader import read_musicxml

REFERENCES = json.loads((Path(__file__).parent / "music21.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", CORPUS)
def test_the_notes_are_those_that_music21_reads(name, tmp_path):
    path = tmp_path / "tune.musicxml"
    path.write_text(CORPUS[name], encoding="utf-8")
    written = read_musicxml(path)
    notes = [(note.beat, note.length, note.pitch) for part in written.parts for note in part.notes]
    notes.sort(key=lambda note: (note[0], note[2], note[1]))
    expected = [
        (Fraction(beat), Fraction(length), pitch)
        for beat, length, pitch in REFERENCES[name]["notes"]
    ]
    assert notes == expected
    assert not written.unknown


def test_the_references_are_of_these_texts():
    digests = {name: hashlib.sha256(text.encode()).hexdigest() for name, text in CORPUS.items()}
    assert {name: each["text"] for name, each in REFERENCES.items()} == digests
