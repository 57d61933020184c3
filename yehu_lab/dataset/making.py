"""Makes the sounds of a data set with their files, some at a time, in any process or machine."""

import tempfile
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.dataset.description import Description
from yehu_lab.dataset.sound import HOP_S, Sound
from yehu_server.errors import OutputError, YehuError
from yehu_server.rendering import build_records
from yehu_server.rendering.build_records import hash_of
from yehu_server.rendering.workers import Event
from yehu_server.scores.gesture import CONTROLS
from yehu_server.util.files import make_folder, replacing

WIDTH = 8  # digits of a number in a name
Line = dict[str, Any]
TOGETHER = 16  # sounds that are made, and kept in the records, as one


def names_of(description: Description, number: int) -> tuple[str, str]:
    """The files of a sound within the folder: the sound itself, and its arrays."""
    stem = f"{description.split(number)}/{number:0{WIDTH}}"
    return f"{stem}.wav", f"{stem}.npz"


def write_sound(folder: Path, description: Description, number: int, sound: Sound) -> Line:
    """Write a sound and its arrays; return its line of the manifest. Raises OutputError."""
    from yehu_server.util.sound_file import sound_file

    names = names_of(description, number)
    audio, arrays = (folder / name for name in names)
    with sound_file(audio, round(description.rate), "wav", "float") as file:
        file.write(sound.audio)
    with replacing(arrays) as partial, partial.open("wb") as file:
        np.savez(file, allow_pickle=False, **_arrays(description, sound))
    return {
        "file": names[0],
        "arrays": names[1],
        "number": number,
        "split": description.split(number),
        "hash": hash_of(audio),
        "arrays_hash": hash_of(arrays),
        "duration_s": len(sound.audio) / description.rate,
        "drawn": sound.drawn,
        "labels": sound.labels,
    }


def _arrays(description: Description, sound: Sound) -> dict[str, Any]:
    """What is kept: controls now and then, signals at each sample, regimes."""
    every = description.every
    kept: dict[str, Any] = {"time": sound.arrays["time"][::every]}
    kept |= {name: np.asarray(sound.arrays[name][::every]) for name in CONTROLS}
    kept |= {
        f"signal_{name}": np.asarray(sound.arrays[name], np.float32) for name in description.signals
    }
    return kept | dict(sound.found) | {"regime_hop_s": np.array(HOP_S)}


@dataclass(frozen=True)
class Part:
    """Some sounds of a data set, for another process."""

    description: Description
    numbers: range  # those of the sounds
    folder: Path  # of the data set
    key: str  # of description and code
    # A file in it, by which a worker knows whether it sees the folder; None: it does.
    mark: Path | None = None

    @property
    def target(self) -> Path:
        """What stands for all of them among the records."""
        return self.folder / f"sounds-{self.numbers.start:08}"

    @property
    def names(self) -> list[str]:
        """Their files, within the folder."""
        return [name for each in self.numbers for name in names_of(self.description, each)]


def perform(part: Part) -> dict[str, Any]:
    """Make some sounds, where the folder is; where it is not seen, they are sent back.

    Returns ``lines`` of the manifest and ``files``, the bytes of each by its name, where they
    travel.
    """
    if part.mark is None or part.mark.is_file():
        return {"lines": _made(part, part.folder), "files": {}}
    with tempfile.TemporaryDirectory(prefix="yehu-server-") as name:
        folder = Path(name)
        lines = _made(part, folder)
        names = [line[each] for line in lines if "error" not in line for each in ("file", "arrays")]
        return {"lines": lines, "files": {name: (folder / name).read_bytes() for name in names}}


def _made(part: Part, folder: Path) -> list[Line]:
    from yehu_lab.dataset.notes import melody, stroke

    make = stroke if part.description.kind == "strokes" else melody
    lines = []
    for number in part.numbers:
        name = names_of(part.description, number)[0]
        try:
            make_folder((folder / name).parent)
            sound = make(part.description, number)
            lines.append(write_sound(folder, part.description, number, sound))
        except YehuError as error:
            lines.append({"file": name, "number": number, "error": str(error)})
        except MemoryError:
            lines.append({"file": name, "number": number, "error": "not enough memory"})
    return lines


def set_up(rate: float) -> None:
    """Compile what sounds need, once before all processes do, and load the calibration."""
    from yehu_lab.dataset.description import description_of
    from yehu_lab.dataset.notes import melody, stroke
    from yehu_server.core.engine.warming import warm_up

    warm_up()
    strokes = {"duration": 0.1}
    notes = {"length": 0.1, "tail": 0.0}
    for make, kind, draw in ((stroke, "strokes", strokes), (melody, "notes", notes)):
        make(description_of({"kind": kind, "sample_rate": rate, "draw": draw}), 0)


def parts_of(description: Description, folder: Path, key: str) -> list[Part]:
    """All sounds of a data set, in parts."""
    starts = range(0, description.count, TOGETHER)
    ends = (min(start + TOGETHER, description.count) for start in starts)
    return [
        Part(description, range(start, end), folder, key)
        for start, end in zip(starts, ends, strict=True)
    ]


def split_up_to_date(parts: Iterable[Part]) -> tuple[list[Part], list[Line]]:
    """The parts that have to be made, and the lines of those that are up to date."""
    left, lines = [], []
    for part in parts:
        results = [part.folder / name for name in part.names]
        line = build_records.up_to_date(part.target, part.key, results)
        if line is None or len(line.get("lines", ())) != len(part.numbers):
            left.append(part)
        else:
            lines += line["lines"]
    return left, lines


def make_all(
    parts: Sequence[Part], perform_all: Callable[[Sequence[Part]], Iterable[Event]]
) -> Generator[Sequence[Line]]:
    """Make all parts; yield the lines of the sounds of each as it is over.

    `perform_all` does them, as ``rendering.cluster.Cluster.perform_all`` does. Raises OutputError
    where what has travelled cannot be written.
    """
    for event in perform_all(parts):
        part = parts[event.job]
        if event.died:
            why = f"the process that made it was {event.died}"
            yield [
                {"file": names_of(part.description, number)[0], "number": number, "error": why}
                for number in part.numbers
            ]
        else:
            yield received(part, event.result)


def received(part: Part, returned: Any) -> Sequence[Line]:
    """Put files that have travelled in their places, and keep a record where all is well.

    `returned` is what `perform` returned; anybody who reaches a cluster may have made it. Raises
    OutputError where it is something else, or cannot be written.
    """
    lines, files = _checked(part, returned)
    for name, data in files.items():
        make_folder((part.folder / name).parent)
        with replacing(part.folder / name) as partial:
            partial.write_bytes(data)
    if not any("error" in line for line in lines):
        results = [part.folder / name for name in part.names]
        build_records.make_folder_for(part.target)
        build_records.keep(part.target, part.key, (), results, {"lines": lines})
    return lines


def _checked(part: Part, returned: Any) -> tuple[list[Line], dict[str, bytes]]:
    try:
        lines = []
        for number, line in zip(part.numbers, returned["lines"], strict=True):
            name = names_of(part.description, number)[0]
            lines.append(build_records.checked_line(line, file=name, number=number))
            if "error" not in line and not isinstance(line["labels"]["regime"], str):
                raise TypeError  # noqa: TRY301 - as where entries are missing
        files = dict(returned["files"])
        made = [line["number"] for line in lines if "error" not in line]
        names = {name for number in made for name in names_of(part.description, number)}
        if not all(name in files or (part.folder / name).is_file() for name in names):
            raise ValueError  # noqa: TRY301
        if not files.keys() <= set(part.names) or any(type(x) is not bytes for x in files.values()):
            raise ValueError  # noqa: TRY301
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise OutputError("a worker's answer is not a result") from error
    return lines, files
