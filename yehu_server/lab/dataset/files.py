"""The files of one sound of a data set, and its line of the manifest."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.lab.dataset.description import Description
from yehu_server.lab.dataset.sound import HOP_S, Sound
from yehu_server.rendering.build_records import hash_of
from yehu_server.scores.gesture import CONTROLS
from yehu_server.util.files import replacing

WIDTH = 8  # digits of a number in a name
Line = dict[str, Any]


def names_of(description: Description, number: int) -> tuple[str, str]:
    """The files of a sound within the folder: the sound itself, and its arrays."""
    stem = f"{description.split(number)}/{number:0{WIDTH}}"
    return f"{stem}.wav", f"{stem}.npz"


def write_sound(folder: Path, description: Description, number: int, sound: Sound) -> Line:
    """Write a sound and its arrays; return its line of the manifest.

    Raises OutputError where they cannot be written.
    """
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
