"""The reader of MusicXML agrees with music21, note for note: beat, length and pitch.

`tests/scores/judge_musicxml.py` wrote what music21 reads.
"""

import hashlib
import json
from fractions import Fraction
from pathlib import Path

from scores.musicxml_corpus import CORPUS

from yehu_server.scores.musicxml.reader import read_musicxml

REFERENCES = json.loads((Path(__file__).parent / "music21.json").read_text(encoding="utf-8"))


def test_the_notes_are_those_that_music21_reads(subtests, tmp_path):
    path = tmp_path / "tune.musicxml"
    for name, text in CORPUS.items():
        with subtests.test(name):
            assert REFERENCES[name]["text"] == hashlib.sha256(text.encode()).hexdigest()
            path.write_text(text, encoding="utf-8")
            written = read_musicxml(path)
            found = [
                (each.beat, each.length, each.pitch) for p in written.parts for each in p.notes
            ]
            found.sort(key=lambda note: (note[0], note[2], note[1]))
            assert found == [
                (Fraction(beat), Fraction(length), pitch)
                for beat, length, pitch in REFERENCES[name]["notes"]
            ]
            assert not written.unknown
