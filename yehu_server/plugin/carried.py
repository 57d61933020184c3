"""What a plug-in carries: presets, mappings and tunings, as the instrument reads them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from yehu_server.ahead.memory_images import runs
from yehu_server.core.midi.tables import TABLES
from yehu_server.params.table import find
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls
from yehu_server.playing.tuning import shipped_tunings
from yehu_server.util.files import shipped_folder

Array = Any
OF_TUNING = ("is_equal", "pitch")
NO_PRESET, NO_ROOM = "none", "custom"
# Hosts keep the number of a choice: new ones come last. (Presets have numbers: their programs.)
MAPPINGS = (
    DEFAULT, "keyboard-expressive", "mpe", "sustain-pedal-tremolo", "wind", "keyboard-bow-speed",
    "keyboard-articulations", "keyboard-vibrato-wheel",
)  # fmt: skip


@dataclass(frozen=True)
class Carried:
    """Values by address, and runs of words of tables (``ahead.memory_images``), by name."""

    # Values of parameters by address: of each preset of a sound and of a room, and those that each
    # mapping starts with.
    presets: dict[str, dict[str, float]]
    rooms: dict[str, dict[str, float]]
    mappings: dict[str, Array]  # runs of words of ``midi.tables``
    starts: dict[str, dict[str, float]]
    switches: dict[str, int]  # of each mapping: the first key that chooses an articulation; or -1
    tunings: dict[str, Array]  # the same, for the fields OF_TUNING

    @cached_property
    def names(self) -> tuple[tuple[str, ...], ...]:
        """The names of presets, rooms, mappings and tunings."""
        return tuple(map(tuple, (self.presets, self.rooms, self.mappings, self.tunings)))


def carried() -> Carried:
    """Read all that is shipped; raises YehuError where a file is wrong."""
    files = sorted(path.stem for path in shipped_folder("mappings").glob("*.toml"))
    loaded = {name: load(name) for name in (*MAPPINGS, *files)}
    presets = [preset for _, preset in sorted(Presets(user_first=False).programs().items())]
    return Carried(
        {NO_PRESET: {}} | {each.name: dict(each.values) for each in presets if not each.is_room},
        {NO_ROOM: {}} | {each.name: dict(each.values) for each in presets if each.is_room},
        {name: _runs(PlayingOptions(mapping=mapping)) for name, mapping in loaded.items()},
        {
            name: {address: find(address).clamped(value) for address, value in mapping.start}
            for name, mapping in loaded.items()
        },
        {name: -1 if m.key_switches is None else m.key_switches for name, m in loaded.items()},
        {
            name: _runs(PlayingOptions(tuning=tuning), OF_TUNING)
            for name, tuning in shipped_tunings().items()
        },
    )


def _runs(playing: PlayingOptions, fields: tuple[str, ...] = ()) -> Array:
    """The runs of tables: of some fields, or all but those of a tuning and programs."""
    made, kept = playing.tables(Controls()), np.zeros(1, TABLES)
    left_out = {*OF_TUNING, "program_row", "program_value"}
    for name in fields or [name for name in TABLES.names or () if name not in left_out]:
        kept[name] = made[name]
    return np.concatenate([np.zeros(0, np.int64), *runs(kept.view(np.int64))])
