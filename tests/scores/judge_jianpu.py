"""Writes judged_jianpu.json: what jianpu-ly and LilyPond make of the jianpu texts in it.

    python tests/scores/judge_jianpu.py

Needs `jianpu-ly` and `lilypond` on the path; the notes that are kept are by versions 1.891 and
2.24.1. Keeps the texts and writes the notes anew, each as its beat, its length in quarters, and its
MIDI note.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import mido

JUDGED = Path(__file__).with_name("judged_jianpu.json")


def judged(text: str) -> list[list[float]]:
    """The notes of a text, by the MIDI file that LilyPond writes."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "text").write_text(f"{text}\n", encoding="utf-8")
        made = subprocess.run(
            ["jianpu-ly", "text"],  # noqa: S607
            cwd=folder,
            capture_output=True,
            check=True,
        )
        (folder / "score.ly").write_bytes(made.stdout)
        subprocess.run(["lilypond", "-s", "score.ly"], cwd=folder, check=True)  # noqa: S607
        return sorted(notes_of(mido.MidiFile(min(folder.glob("*.mid*")))))


def notes_of(file: mido.MidiFile) -> list[list[float]]:
    """Beat, length and MIDI note of each note of a file."""
    found = []
    for track in file.tracks:
        tick, begun = 0, {}
        for message in track:
            tick += message.time
            if message.type == "note_on" and message.velocity:
                begun[message.note] = tick
            elif message.type in ("note_on", "note_off") and message.note in begun:
                begin = begun.pop(message.note)
                times = (begin / file.ticks_per_beat, (tick - begin) / file.ticks_per_beat)
                found.append([*(round(each, 4) for each in times), message.note])
    return found


def main() -> int:
    cases = json.loads(JUDGED.read_text(encoding="utf-8"))
    for case in cases.values():
        case["notes"] = judged(case["text"])
    lines = (
        f"{json.dumps(name)}: {json.dumps(case, ensure_ascii=False)}"
        for name, case in cases.items()
    )
    JUDGED.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
