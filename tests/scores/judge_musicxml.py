"""Writes music21.json: what music21 reads of the MusicXML in it, as other programs write it.

Needs music21 (developed with 10.5), which is too large for every install. Run it with a Python
that has it: PYTHON tests/scores/judge_musicxml.py
"""

import json
import warnings
from fractions import Fraction
from pathlib import Path
from typing import Any

import music21

JUDGED = Path(__file__).with_name("music21.json")


def notes_of(source: str) -> list[list[Any]]:
    """Each note of a text or file as [beat, length, pitch], in order, repeats unfolded."""
    found = []
    parsed: Any = music21.converter.parse(source)
    sounding = parsed.toSoundingPitch()
    for part in sounding.parts:
        unfolded = part.expandRepeats().stripTies()
        for each in unfolded.flatten().notes:
            if each.duration.isGrace or isinstance(each, music21.harmony.ChordSymbol):
                continue
            pitch = max(one.ps for one in each.pitches)
            found.append([_exact(each.offset), _exact(each.quarterLength), float(pitch)])
    return sorted(found, key=lambda one: (Fraction(one[0]), one[2], Fraction(one[1])))


def _exact(value: Any) -> str:
    return str(Fraction(value).limit_denominator(10_000))


def main() -> None:
    warnings.simplefilter("ignore")
    cases = json.loads(JUDGED.read_text(encoding="utf-8"))
    for case in cases.values():
        case["notes"] = notes_of(case["text"])
    lines = (f"{json.dumps(name)}: {json.dumps(case)}" for name, case in cases.items())
    JUDGED.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
