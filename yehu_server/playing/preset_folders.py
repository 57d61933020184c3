"""Find, read, save and delete presets: shipped ones, and the user's own."""

import os
import stat
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from unicodedata import normalize

import tomlkit
from platformdirs import user_config_path
from tomlkit.exceptions import TOMLKitError

from yehu_server.errors import OutputError, PresetError, did_you_mean
from yehu_server.params.preset_file import SAVED, VERSION, Preset, document_of, preset_from
from yehu_server.util.files import (
    error_reason,
    is_plain_name,
    path_inside,
    read_text,
    shipped_folder,
    write_text,
)

ENDING = ".toml"
MINE = "mine/"  # prefix of the names of the user's own presets
AND = "+"  # between the names of presets that are taken together
MAX_TOGETHER = 8
# Presets are read while the instrument plays, which must take some milliseconds only.
MAX_OWN = 128  # as many as there are MIDI programs
MAX_BYTES = 1 << 14  # of one preset; all values take under 1000, the rest is for comments
MAX_NAMED = 20  # names in an error message
EMPTY = f'version = {VERSION}\nabout = ""\n\n[values]\n'


def read_preset(path: Path, name: str | None = None) -> Preset:
    """Read a preset from a file; raises PresetError, naming the file, or `name`."""
    return preset_from(document_of(name or path).read(path, MAX_BYTES), name or path.stem)


@lru_cache(maxsize=4 * MAX_OWN)
def _read_once(path: Path, name: str, _mtime_ns: int, _size: int) -> Preset:
    return read_preset(path, name)


def is_name(name_or_path: str) -> bool:
    """Whether a text is the name of a preset, or the names of several, not a path."""
    names = [name.removeprefix(MINE) for name in name_or_path.split(AND)]
    return not name_or_path.endswith(ENDING) and all(map(is_plain_name, names))


def together(presets: Sequence[Preset]) -> Preset:
    """Several presets as one, which sets what each of them sets, the later ones last."""
    values = {address: value for preset in presets for address, value in preset.values.items()}
    return Preset(
        AND.join(preset.name for preset in presets),
        values,
        " ".join(preset.about for preset in presets if preset.about),
        unknown=tuple(dict.fromkeys(each for preset in presets for each in preset.unknown)),
    )


class Presets:
    """All presets, by plain name, or ``mine/NAME`` for one of the user's own.

    Files are read again when they have changed.

    `own`: the user's folder, created by the first `save`; by default in the user's configuration
    folder for this program.
    `user_first`: whether the user's own presets take precedence over shipped ones of the same name
    or program, as in live playing. Else shipped ones do, and own ones have no program.
    """

    def __init__(self, own: Path | None = None, *, user_first: bool = True) -> None:
        self._own_first = user_first
        self.own = own or user_config_path("yehu-server", appauthor=False) / "presets"
        self.shipped = shipped_folder("presets")

    def names(self) -> list[str]:
        """All names, sorted."""
        return sorted({*_names(self.own)[:MAX_OWN], *_names(self.shipped)})

    def is_own(self, name: str) -> bool:
        """Whether the user has a preset of this name."""
        return self._own_file(name).is_file()

    def file(self, name: str) -> Path:
        """The file of a preset; raises PresetError where there is no such preset."""
        lookups = [self._own_file, self._shipped_file]
        if name.startswith(MINE):
            del lookups[1]
        for lookup in lookups if self._own_first else reversed(lookups):
            path = lookup(name.removeprefix(MINE))
            if _is_there(path):
                return path
        names = self.names()
        more = f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else ""
        there = f"{', '.join(names[:MAX_NAMED])}{more}"
        raise PresetError(f"no preset {name!r} (there are: {there}){did_you_mean(name, names)}")

    def load(self, name: str) -> Preset:
        """Read a preset by its name, or several by names with a plus between them.

        Of several, each sets what it names, the later ones last: ``sul-tasto+hall``. Raises
        PresetError where there is no such preset, it is wrong, or they are too many.
        """
        names = name.split(AND)
        if len(names) > MAX_TOGETHER:
            raise PresetError(f"{len(names)} presets: at most {MAX_TOGETHER} go together")
        found = [self._read(self.file(each), each.removeprefix(MINE)) for each in names]
        return found[0] if len(found) == 1 else together(found)

    def find(self, *names_or_paths: str) -> Preset:
        """Read a preset by its name or path, or several as one; raises PresetError as `load`."""
        found = [
            self.load(each) if is_name(each) else read_preset(Path(each)) for each in names_or_paths
        ]
        return found[0] if len(found) == 1 else together(found)

    def find_file(self, name_or_path: str) -> Path:
        """The file that `find` reads, of several the first; raises PresetError as `file`."""
        if is_name(name_or_path):
            return self.file(name_or_path.split(AND, maxsplit=1)[0])
        return Path(name_or_path)

    def all(self) -> tuple[list[Preset], list[PresetError]]:
        """All presets by name, and the errors in files that cannot be read."""
        presets, errors = [], []
        excess = len(_names(self.own)) - MAX_OWN
        if excess > 0:
            errors.append(PresetError(f"{self.own}: {excess} more than {MAX_OWN}, left out"))
        for name in self.names():
            try:
                presets.append(self.load(name))
            except PresetError as error:
                errors.append(error)
        return presets, errors

    def programs(self) -> dict[int, Preset]:
        """The presets of MIDI programs, 1 to 128: the user's own first, then by name."""
        found: dict[int, Preset] = {}
        for preset in sorted(self.all()[0], key=lambda preset: not self.is_own(preset.name)):
            is_known = self._own_first or self._shipped_file(preset.name).is_file()
            if preset.program is not None and is_known:
                found.setdefault(preset.program, preset)
        return found

    def save(self, name: str, values: Mapping[str, float]) -> None:
        """Save the values that make up a sound as one of the user's own presets.

        The rest of an older file of this name (comments, `about`, `program`, other entries) stays,
        and the whole file where writing fails. Raises PresetError where the name is a shipped
        preset's, an older file cannot be read, there are MAX_OWN already, or writing fails.
        """
        path = self._own_file(name)
        text = EMPTY
        if path.exists():
            read_preset(path, name)
            text = read_text(path, MAX_BYTES)
        elif self._shipped_file(name).exists():
            raise PresetError(f"{name!r} comes with the program; save under another name")
        elif len(_names(self.own)) >= MAX_OWN:
            raise PresetError(f"there are {MAX_OWN} presets of your own; delete one first")
        try:
            document = tomlkit.parse(text)
        except TOMLKitError as error:
            raise PresetError(f"{name}: {error}") from error
        table = document.setdefault("values", tomlkit.table())
        for address in SAVED:
            value = float(f"{values[address]:.7g}")  # undoes the rounding to a 32-bit float of OSC
            if table.get(address) != value:
                table[address] = value
        try:
            self.own.mkdir(parents=True, exist_ok=True)
            write_text(path, tomlkit.dumps(document))
        except OSError as error:
            raise PresetError(f"{self.own}: {error_reason(error)}") from error

    def delete(self, name: str) -> None:
        """Delete one of the user's own presets; raises PresetError if not there, or it fails."""
        path = self._own_file(name)
        if not path.is_file():
            shipped = self._shipped_file(name).exists()
            why = f"{name!r} comes with the program" if shipped else f"no preset {name!r}"
            raise PresetError(why)
        try:
            path.unlink()
        except OSError as error:
            raise PresetError(f"{name}: {error_reason(error)}") from error

    def _read(self, path: Path, name: str) -> Preset:
        """Read a file, unless it is unchanged since it was read; raises PresetError."""
        try:
            status = path.stat()
        except OSError as error:
            raise PresetError(f"{name}: {error_reason(error)}") from error
        return _read_once(path, name, status.st_mtime_ns, status.st_size)

    def _own_file(self, name: str) -> Path:
        """The path of an own preset; raises PresetError for what is no plain name, as `inside`."""
        try:
            return path_inside(self.own, name, ENDING)
        except OutputError as error:
            raise PresetError(str(error)) from error

    def _shipped_file(self, name: str) -> Path:
        """The path of a shipped preset, which may be a link, as some installers make them."""
        return self.shipped / f"{name}{ENDING}"


def _is_there(path: Path) -> bool:
    """Whether there is a file, or something that reading will give an error for."""
    try:
        return stat.S_ISREG(path.stat().st_mode)
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError:  # such as a loop of links
        return True


def _names(folder: Path) -> list[str]:
    """The names of the presets of a folder, sorted."""
    try:
        files = os.listdir(folder)  # noqa: PTH208 - names are enough
    except OSError:
        return []
    # Some file systems of Macs take accents apart.
    names = (normalize("NFC", file.removesuffix(ENDING)) for file in files if file.endswith(ENDING))
    return sorted(filter(is_plain_name, names))
