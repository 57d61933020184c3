"""Scores of others are read as other readers play them: those files in which two of them agree.

Corpora are no part of the project. YEHU_CORPORA names a folder that has one in each of its folders
(docs/scores.md names those that were read), YEHU_READERS a Python that has mido, music21 and
verovio; abcjs is found by NODE_PATH.
"""

import json
import os
import random
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from yehu_server.errors import ScoreError
from yehu_server.scores.abc.reader import read_abc
from yehu_server.scores.musicxml.reader import read_musicxml
from yehu_server.scores.written.notated import Written

CORPORA = os.environ.get("YEHU_CORPORA", "")
PYTHON = os.environ.get("YEHU_READERS", sys.executable)
SEED = int(os.environ.get("YEHU_CORPORA_SEED", "1"))
MOST = 50  # scores of a corpus
MOST_BYTES = 1 << 20  # of a file: music21 takes minutes for more
NEAR = 0.06  # quarters
ENOUGH = 0.95  # of the files in which two readers agree; docs/scores.md names the others
LEFT_OUT = re.compile(
    r"D\.\s*[CS]\.|(?m:^R: *hornpipe)", re.IGNORECASE
)  # no two readers play these
JUDGE = Path(__file__).with_name("judge_corpora.py")
READERS = {"abc": ("abc2midi", "abcjs"), "xml": ("music21", "verovio")}

Notes = list[tuple[float, float]]


def scores_of(corpus: Path) -> list[tuple[str, Path, str]]:
    """Some scores of a corpus: a name, the file, and the tune of ABC."""
    found = []
    for path in sorted(corpus.rglob("*")):
        if path.suffix == ".abc":
            text = path.read_bytes().decode("utf-8", "replace").replace("\r\n", "\n")
            head, *tunes = re.split(r"(?m)^(?=X:)", text)
            fields = "".join(re.findall(r"(?m)^(?:[A-Z]:|%%).*\n", head))
            for number, tune in enumerate(tunes, 1):
                whole = re.split(r"\n\s*\n", tune)[0]
                whole = re.sub(r"^X:.*", f"X:1\n{fields}".rstrip(), whole)
                if not LEFT_OUT.search(whole):
                    found.append((f"{path.name} {number}", path, f"{whole}\n"))
        elif path.suffix in (".xml", ".musicxml", ".mxl") and path.stat().st_size < MOST_BYTES:
            found.append((path.name, path, ""))
    return random.Random(SEED).sample(found, min(MOST, len(found)))


def played_by(name: str, files: list[str]) -> list[Notes | None] | None:
    """What a reader plays of each file; None where it is not there."""
    command = [PYTHON, str(JUDGE), name]
    if subprocess.run(command, check=False, stdin=subprocess.DEVNULL).returncode:
        return None
    said = json.dumps(files).encode()
    made = subprocess.run(command, check=True, input=said, stdout=subprocess.PIPE)
    return [
        notes and [tuple(note) for note in notes]
        for note in [0]
        for notes in json.loads(made.stdout)
    ]


def notes_of(written: Written) -> Notes:
    return [(float(note.beat), note.pitch) for part in written.parts for note in part.notes]


def top(notes: Notes) -> Notes:
    """The highest note of each onset, in order."""
    found: Notes = []
    for at, pitch in sorted(notes):
        if found and at - found[-1][0] < NEAR:
            found[-1] = found[-1][0], max(pitch, found[-1][1])
        else:
            found.append((at, pitch))
    return found


def agree(one: Notes, other: Notes) -> bool:
    one, other = top(one), top(other)
    return len(one) == len(other) and all(
        abs(a - b) < NEAR and abs(p - q) < 0.6 for (a, p), (b, q) in zip(one, other, strict=True)
    )


@pytest.mark.slow
@pytest.mark.skipif(not CORPORA, reason="YEHU_CORPORA names no folder of corpora")
def test_scores_of_others_are_read_as_two_readers_agree(subtests, tmp_path):
    counts: Counter[str] = Counter()
    for corpus in sorted(path for path in Path(CORPORA).iterdir() if path.is_dir()):
        scores = scores_of(corpus)
        for kind, names in READERS.items():
            own = [score for score in scores if (score[1].suffix == ".abc") == (kind == "abc")]
            if not own:
                continue
            ours: list[Notes | str] = []
            for _, path, text in own:
                try:
                    if text:
                        (tmp_path / "tune.abc").write_text(text, encoding="utf-8")
                        ours.append(notes_of(read_abc(tmp_path / "tune.abc")))
                    else:
                        ours.append(notes_of(read_musicxml(path)))
                except ScoreError as error:  # none of its readers has notes either, perhaps
                    ours.append([] if "no notes" in str(error) else str(error))
            others = [
                played_by(name, [text or str(path) for _, path, text in own]) for name in names
            ]
            if any(each is None for each in others):
                pytest.skip(f"{' and '.join(names)} are not both there")
            differ = []
            table: Counter[str] = Counter(scores=len(own))
            for (name, *_), mine, *two in zip(own, ours, *others, strict=True):
                one, other = two
                both = one is not None and other is not None and agree(one, other)
                same = [
                    their is not None and not isinstance(mine, str) and agree(mine, their)
                    for their in two
                ]
                for reader, is_same in zip(names, same, strict=True):
                    table[f"as {reader}"] += is_same
                table["as neither"] += not any(same)
                table["both agree"] += both
                if both and not any(same):
                    differ.append((name, mine if isinstance(mine, str) else ""))
                elif not any(same):
                    table[f"{name}: {mine if isinstance(mine, str) else ''}"] += 1
            print(corpus.name, kind, dict(table), "differ:", differ)  # noqa: T201 - shown by -s
            counts["both"] += table["both agree"]
            counts["differ"] += len(differ)
            with subtests.test(f"{corpus.name} {kind}"):
                assert len(differ) <= max((1.0 - ENOUGH) * table["both agree"], 1), differ
    assert counts["both"] > 0
