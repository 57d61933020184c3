"""What other readers play of scores: onset (quarters) and MIDI note of each, as JSON.

    PYTHON tests/scores/judge_corpora.py READER < files.json > notes.json

READER is abc2midi or abcjs for tunes of ABC, music21 or verovio for files of MusicXML. They are
programs and packages of their own: abc2midi is on the path, PYTHON has the packages music21 and
verovio, and `node` finds abcjs (NODE_PATH). Files that a reader refuses are null. Without input it
only tells by its exit code whether the reader is there.
"""

import base64
import contextlib
import importlib
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings
import zipfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import mido

SECONDS = 60  # for a file
ABCJS = """
const abcjs = require("abcjs"), fs = require("fs");
const played = JSON.parse(fs.readFileSync(0, "utf8")).map((text) => {
  try {
    const audio = abcjs.parseOnly(text)[0].setUpAudio({ chordsOff: true });
    return audio.tracks.flat().filter((e) => e.cmd === "note").map((e) => [4 * e.start, e.pitch]);
  } catch (error) { return null; }
});
console.log(JSON.stringify(played));
"""
# What abcjs plays out, and the others do not.
ORNAMENTS = re.compile(
    r"\{[^}]*\}|[!+](?:trill|roll|turn|(?:upper|lower)?mordent|pralltriller)[!+]|~"
)
Notes = list[tuple[float, float]]


def of_midi(file: mido.MidiFile, rolled: float = 0.0) -> Notes:
    """The notes of a MIDI file; those of a chord may follow each other within `rolled`."""
    found = []
    for track in file.tracks:
        now, last = 0, -1.0
        for message in track:
            now += message.time
            if message.type == "note_on" and message.velocity and message.channel != 9:
                at = now / file.ticks_per_beat
                last = at if at - last >= rolled or last < 0 else last
                found.append((last, float(message.note)))
    return found


def abc2midi(text: str) -> Notes:
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "tune.abc").write_text(text, encoding="utf-8")
        words = ["abc2midi", "tune.abc", "-NGRA", "-NGUI", "-silent", "-o", "tune.mid"]
        subprocess.run(words, cwd=folder, check=True, capture_output=True, timeout=SECONDS)
        return of_midi(mido.MidiFile(Path(folder, "tune.mid")), 0.04)


def plain(path: str) -> str:
    """A file of MusicXML without what readers play each in its own way, or not: small notes."""
    data = Path(path).read_bytes()
    if data.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = [name for name in archive.namelist() if not name.startswith(("META", "__"))]
            data = archive.read(next(each for each in names if each.endswith("xml")))
    root = ET.fromstring(data)  # noqa: S314 - files that one chose
    for parent in [*root.iter()]:
        for child in [*parent]:
            if child.tag == "ornaments" or (child.tag == "note" and _find(child, "grace")):
                parent.remove(child)
            elif child.tag == "note" and (_find(child, "cue") or _find(child, "unpitched")):
                for inner in [*child]:
                    if inner.tag in ("cue", "pitch", "unpitched", "tie", "notations"):
                        child.remove(inner)
                if not _find(child, "chord"):
                    child.insert(0, ET.Element("rest"))
                else:
                    parent.remove(child)
    return ET.tostring(root, encoding="unicode")


def _find(element: ET.Element, name: str) -> bool:
    return element.find(name) is not None


def verovio(path: str) -> Notes:
    import verovio

    verovio.enableLog(verovio.LOG_OFF)
    toolkit = verovio.toolkit()
    if not toolkit.loadData(plain(path)):
        raise ValueError(path)
    data = base64.b64decode(toolkit.renderToMIDI())
    return of_midi(mido.MidiFile(file=io.BytesIO(data)))


def music21(path: str) -> Notes:
    import music21

    warnings.simplefilter("ignore")
    parsed: Any = music21.converter.parse(plain(path), format="musicxml")
    found = []
    for part in parsed.toSoundingPitch().parts:
        for each in part.expandRepeats().stripTies().flatten().notes:
            if each.duration.isGrace or isinstance(each, music21.harmony.ChordSymbol):
                continue
            found += [(float(each.offset), float(one.ps)) for one in each.pitches]
    return found


def abcjs(texts: list[str]) -> list[Notes | None]:
    said = json.dumps([ORNAMENTS.sub("", text) for text in texts])
    made = subprocess.run(
        [shutil.which("node") or "node", "-e", ABCJS],
        input=said.encode(), capture_output=True, check=True, timeout=600,
    )  # fmt: skip
    return list(json.loads(made.stdout.splitlines()[-1]))


def one_by_one(reader: Any, files: list[str]) -> list[Notes | None]:
    return [in_process(reader, file) for file in files]


def in_process(reader: Any, file: str) -> Notes | None:
    """What a reader makes of a file, in a process of its own: it may crash, or never end."""
    source, target = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(SECONDS)
        with contextlib.suppress(Exception), os.fdopen(target, "w") as out:
            json.dump(reader(file), out)
        os._exit(0)
    os.close(target)
    with os.fdopen(source) as made:
        said = made.read()
    os.waitpid(child, 0)
    with contextlib.suppress(ValueError):
        return [(at, pitch) for at, pitch in json.loads(said)]
    return None


def is_there(name: str) -> bool:
    if name == "abc2midi":
        return shutil.which(name) is not None
    if name == "abcjs":
        command = [shutil.which("node") or "node", "-e", 'require("abcjs")']
    else:
        command = [sys.executable, "-c", f"import {name}"]
    with contextlib.suppress(OSError):
        return subprocess.run(command, capture_output=True, check=False).returncode == 0
    return False


def main(name: str) -> int:
    if sys.stdin is None or not (said := sys.stdin.read()):
        return 0 if is_there(name) else 1
    readers = {"abc2midi": abc2midi, "verovio": verovio, "music21": music21}
    if name in ("verovio", "music21"):
        importlib.import_module(name)
    output, files = os.dup(1), json.loads(said)
    os.dup2(2, 1)  # where packages print what they like
    played = abcjs(files) if name == "abcjs" else one_by_one(readers[name], files)
    os.write(output, json.dumps(played).encode())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
