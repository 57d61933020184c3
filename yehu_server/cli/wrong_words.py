"""Hints at what is wrong with the words of a command line, beside an error that names one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from yehu_server.errors import YehuError, did_you_mean
from yehu_server.system.terminals import quoted
from yehu_server.util.hints import command_name

NO_FILE = ": no such file"
NO_PRESET = re.compile(r"no preset '(\w+)'")
DASHES, QUOTES = "–—", "“”„‘’«»"  # noqa: RUF001
SOUNDS = (b"fLaC", b"OggS", b"FORM", b"RF64", b"ID3")
# What reads files of a kind; the first is hinted at.
READERS = {
    "sound files": ("follow", "body"),
    "captured sessions": ("replay", "score"),
    "scores": ("render", "score"),
}


def hint_at(words: Sequence[str], error: str) -> str:
    """What to add to an error of a command of some words; empty where there is nothing to say."""
    if preset := NO_PRESET.search(error):
        return _articulation(preset[1])
    word = next((word for word in words[1:] if error.startswith(f"{word}:")), "")
    if not word:
        return ""
    return _of_name(words, word) if NO_FILE in error else other_command(words[0], word)


def other_command(command: str, word: str) -> str:
    """A hint at the command that reads a file, where another was given it."""
    kind = _kind_of(Path(word))
    if not kind or command in READERS[kind]:
        return ""
    return f"; {command_name()} {READERS[kind][0]} plays {kind}"


def _kind_of(path: Path) -> str:
    """What a file is by its beginning and its ending; empty where it is none of READERS."""
    from yehu_server.scores.capture_format import FORMAT
    from yehu_server.scores.reading import beginning_of, format_of

    data = beginning_of(path)
    if data.startswith(SOUNDS) or (data.startswith(b"RIFF") and data[8:12] == b"WAVE"):
        return "sound files"
    if FORMAT.encode() in data:
        return "captured sessions"
    return "scores" if data and format_of(path) else ""


def _articulation(name: str) -> str:
    from yehu_server.params.table import assignment

    try:
        assignment(f"articulation={name}")
    except YehuError:
        return ""
    return f"; {name} is an articulation: --set articulation={name}"


def _of_name(words: Sequence[str], word: str) -> str:
    """What is wrong with the name of a file that is not there."""
    if word[0] in DASHES:
        return f"; an option begins with two hyphens: --{word.lstrip(DASHES)}"
    if word[0] in QUOTES:
        return "; these are no quotation marks of a command line, which are \" and '"
    at = words.index(word)
    for end in range(at + 2, len(words) + 1):
        path = " ".join(words[at:end])
        if Path(path).exists():
            return f"; a name with a space is written {quoted(path)}"
    try:
        beside = [str(path) for path in Path(word).parent.iterdir()]
    except OSError:
        return ""
    return did_you_mean(str(Path(word)), beside, 0.85)
