"""The folders of presets: those that come along, and the player's own."""

from __future__ import annotations

import os
import stat
from collections.abc import Mapping
from pathlib import Path

import tomlkit
from platformdirs import user_config_path
from tomlkit.exceptions import TOMLKitError

from yehu_server.errors import OutputError, PresetError
from yehu_server.files import PLAIN_NAME, inside, read_text, shipped_folder, write_text
from yehu_server.params.preset import SAVED, VERSION, Preset, parse

ENDING = ".toml"
MINE = "mine/"  # before the name of one of the player's own
# What may be asked for while the instrument plays takes some milliseconds to read.
MOST_OWN = 128  # presets: as many as there are MIDI programs
MOST_BYTES = 1 << 14  # of one; it takes under 1000, and the rest are comments
MOST_NAMED = 20  # in an error
EMPTY = f'version = {VERSION}\nabout = ""\n\n[values]\n'
Stamp = tuple[int, int]


def read_preset(path: Path, name: str | None = None) -> Preset:
    """Read a file of any place. Errors: PresetError, naming it."""
    try:
        return parse(read_text(path, MOST_BYTES), name or path.stem)
    except UnicodeDecodeError as error:
        raise PresetError(f"{name or path}: not a preset file ({error})") from error
    except (OSError, ValueError) as error:  # a path may have a NUL
        reason = error.strerror if isinstance(error, OSError) else None
        raise PresetError(f"{name or path}: {reason or error}") from error
    except PresetError as error:
        raise PresetError(*(f"{name or path}: {what}" for what in (error, *error.more))) from error


def is_name(name_or_path: str) -> bool:
    """Whether it is the name of a preset; else it is a path."""
    name = name_or_path.removeprefix(MINE)
    return PLAIN_NAME.fullmatch(name) is not None and not name.endswith(ENDING)


class Presets:
    """Presets by plain name, or by ``mine/`` and the name of one of the player's own.

    Files are read again when they have changed.

    Parameters
    ----------
    own : Path, optional
        The player's folder, made when something is saved; by default among the settings that
        the system keeps for this program.
    own_first : bool
        Whether one of the player's own hides a shipped one of its name or program, as it does
        live. Else the shipped one counts, and own ones have no program.
    """

    def __init__(self, own: Path | None = None, *, own_first: bool = True) -> None:
        self._own_first = own_first
        self.own = own or user_config_path("yehu-server") / "presets"
        self.shipped = shipped_folder("presets")
        # What was read, or why it could not be.
        self._known: dict[Path, tuple[Stamp, Preset | str]] = {}

    def names(self) -> list[str]:
        """All names, sorted."""
        return sorted({*_names(self.own)[:MOST_OWN], *_names(self.shipped)})

    def is_own(self, name: str) -> bool:
        """Whether it is the player's own."""
        return self._own_file(name).is_file()

    def file(self, name: str) -> Path:
        """Where one of them is. Errors: PresetError."""
        places = [self._own_file, self._shipped_file]
        if name.startswith(MINE):
            del places[1]
        for place in places if self._own_first else reversed(places):
            path = place(name.removeprefix(MINE))
            if _is_there(path):
                return path
        names = self.names()
        more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
        raise PresetError(f"no preset {name!r} (there are: {', '.join(names[:MOST_NAMED])}{more})")

    def load(self, name: str) -> Preset:
        """Read one of them. Errors: PresetError."""
        return self._read(self.file(name), name.removeprefix(MINE))

    def find(self, name_or_path: str) -> Preset:
        """Read one of them, or a file of any place. Errors: PresetError."""
        if is_name(name_or_path):
            return self.load(name_or_path)
        return read_preset(Path(name_or_path))

    def find_file(self, name_or_path: str) -> Path:
        """The file that `find` reads. Errors: PresetError."""
        return self.file(name_or_path) if is_name(name_or_path) else Path(name_or_path)

    def all(self) -> tuple[list[Preset], list[PresetError]]:
        """All of them by name, and what is wrong with files that cannot be read."""
        presets, errors = [], []
        excess = len(_names(self.own)) - MOST_OWN
        if excess > 0:
            errors.append(PresetError(f"{self.own}: {excess} more than {MOST_OWN}, left out"))
        for name in self.names():
            try:
                presets.append(self.load(name))
            except PresetError as error:
                errors.append(error)
        return presets, errors

    def _is_only_own(self, name: str) -> bool:
        return not self._shipped_file(name).is_file()

    def of_program(self, program: int) -> Preset | None:
        """The preset of a MIDI program, 1 to 128: the player's own first, then by name."""
        found = [
            preset
            for preset in self.all()[0]
            if preset.program == program and (self._own_first or not self._is_only_own(preset.name))
        ]
        return min(found, key=lambda preset: not self.is_own(preset.name), default=None)

    def save(self, name: str, values: Mapping[str, float]) -> None:
        """Keep those of the values that make up a sound, as one of the player's own.

        The rest of an older file of this name (comments, `about`, `program`, what it names
        besides) stays; it is as it was where writing fails.
        Errors: PresetError for a shipped one's name, an older file that cannot be read, or where
        there are MOST_OWN already.
        """
        path = self._own_file(name)
        text = EMPTY
        if path.exists():
            read_preset(path, name)
            text = read_text(path, MOST_BYTES)
        elif self._shipped_file(name).exists():
            raise PresetError(f"{name!r} comes with the program; save under another name")
        elif len(_names(self.own)) >= MOST_OWN:
            raise PresetError(f"there are {MOST_OWN} presets of your own; delete one first")
        try:
            document = tomlkit.parse(text)
        except TOMLKitError as error:
            raise PresetError(f"{name}: {error}") from error
        table = document.setdefault("values", tomlkit.table())
        for address in SAVED:
            value = float(f"{values[address]:.7g}")  # what a 32-bit float of OSC was meant to be
            if table.get(address) != value:
                table[address] = value
        try:
            self.own.mkdir(parents=True, exist_ok=True)
            write_text(path, tomlkit.dumps(document))
        except OSError as error:
            raise PresetError(f"{self.own}: {error.strerror}") from error

    def delete(self, name: str) -> None:
        """Remove one of the player's own. Errors: PresetError."""
        path = self._own_file(name)
        if not path.is_file():
            shipped = self._shipped_file(name).exists()
            why = f"{name!r} comes with the program" if shipped else f"no preset {name!r}"
            raise PresetError(why)
        try:
            path.unlink()
        except OSError as error:
            raise PresetError(f"{name}: {error.strerror}") from error

    def _read(self, path: Path, name: str) -> Preset:
        """Read a file, unless it is known as it is now. Errors: PresetError."""
        try:
            status = path.stat()
        except OSError as error:
            self._known.pop(path, None)
            raise PresetError(f"{name}: {error.strerror}") from error
        stamp = (status.st_mtime_ns, status.st_size)
        known = self._known.get(path)
        if known is None or known[0] != stamp:
            known = self._known[path] = (stamp, _tried(path, name))
        if isinstance(known[1], str):
            raise PresetError(known[1])
        return known[1]

    def _own_file(self, name: str) -> Path:
        """Where one of the player's own is. Errors: PresetError, as of `inside`."""
        try:
            return inside(self.own, name, ENDING)
        except OutputError as error:
            raise PresetError(str(error)) from error

    def _shipped_file(self, name: str) -> Path:
        """Where a shipped one is: by a link, as some installers have it, or not."""
        return self.shipped / f"{name}{ENDING}"


def _is_there(path: Path) -> bool:
    """Whether there is a file, or something whose trouble reading it will tell."""
    try:
        return stat.S_ISREG(path.stat().st_mode)
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError:  # such as a ring of links
        return True


def _tried(path: Path, name: str) -> Preset | str:
    try:
        return read_preset(path, name)
    except PresetError as error:
        return str(error)


def _names(folder: Path) -> list[str]:
    """The names of the presets of a folder, sorted."""
    try:
        files = os.listdir(folder)  # noqa: PTH208 - names are enough
    except OSError:
        return []
    names = (file.removesuffix(ENDING) for file in files if file.endswith(ENDING))
    return sorted(name for name in names if PLAIN_NAME.fullmatch(name))
