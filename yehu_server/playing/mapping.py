"""Mappings: which controllers move which parameters; found by name and merged with their bases.

A plain name means a shipped mapping first, so that it means the same to every user;
``mine/NAME`` is the user's own. Live playing alone searches the user's own mappings first, as
MIDI learn keeps its binds there.

The format of the files is described in mappings/README.md.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from platformdirs import user_config_path

from yehu_server.core.midi.tables import MAX_BINDS, MAX_POINTS
from yehu_server.errors import MappingError, did_you_mean
from yehu_server.playing.bind import Bind, Breakpoints, override_key
from yehu_server.playing.mapping_file import MAX_BYTES, MappingFile, document_of, read_mapping_file
from yehu_server.playing.sources import is_address
from yehu_server.util.files import shipped_folder

DEFAULT, MPE = "keyboard", "mpe"
MINE = "mine/"  # prefix of the names of the user's own mappings


def mapping_folder() -> Path:
    """The folder of the shipped mappings."""
    return shipped_folder("mappings")


def user_folder() -> Path:
    """The folder of the user's mappings, which need not exist."""
    return user_config_path("yehu-server", appauthor=False) / "mappings"


@dataclass(frozen=True)
class Mapping:
    """A named set of binds; several may share a source or a target (the last move counts).

    `start` (tuple of (address, value)): values that parameters start with.
    `mpe`: whether every port starts as an MPE zone.
    `key_switches`: the lowest of the keys that choose an articulation (MIDI note).
    `about`: what it is for, in a line.
    `files`: the file it was read from, then those of its bases.
    """

    name: str
    binds: tuple[Bind, ...]
    start: tuple[tuple[str, float], ...] = ()
    mpe: bool = False
    key_switches: int | None = None
    about: str = ""
    files: tuple[Path, ...] = field(default=(), compare=False)

    def of(self, source: str) -> tuple[Bind, ...]:
        """The binds of one source."""
        return self._by_source.get(source, ())

    @cached_property
    def addresses(self) -> tuple[str, ...]:
        """The sources that are OSC addresses."""
        return tuple(source for source in self._by_source if is_address(source))

    @cached_property
    def _by_source(self) -> dict[str, tuple[Bind, ...]]:
        found: dict[str, tuple[Bind, ...]] = {}
        for bind in self.binds:
            found[bind.source] = (*found.get(bind.source, ()), bind)
        return found


def shipped_mappings() -> list[str]:
    """Names of the mappings that come with the package."""
    return sorted(file.stem for file in mapping_folder().glob("*.toml"))


def user_mappings() -> list[str]:
    """Names of the mappings in the user's folder."""
    return sorted(file.stem for file in user_folder().glob("*.toml"))


def is_own(mapping: Mapping) -> bool:
    """Whether a mapping comes from the user's folder."""
    return any(_is_same(file.parent, user_folder()) for file in mapping.files[:1])


def load(name_or_path: str, *, user_first: bool = False) -> Mapping:
    """Read a mapping by its name, or from a file.

    Raises MappingError, naming file and line.

    `name_or_path`: a name, ``mine/NAME`` for one of the user's own, or a path.
    `user_first`: whether a plain name means the user's own mapping before a shipped one.
    """
    path = find_file(name_or_path, user_first=user_first)
    return with_bases(path, read_mapping_file(path))


def find_file(name_or_path: str, *, user_first: bool = False) -> Path:
    """Find the file of a mapping, by name or path; raises MappingError for no such name."""
    if not _is_name(name_or_path):
        return Path(name_or_path)
    found = _named(name_or_path, user_first=user_first)
    if found is None:
        raise MappingError(_unknown(name_or_path, "; or name a file"))
    return found


def with_bases(path: Path, contents: MappingFile) -> Mapping:
    """Merge the contents of a file with those of its base, and of the base's base.

    Raises MappingError where a base is missing, wrong, or based on this file.
    """
    layers, files = [contents], [path]
    while (base := layers[-1].base) is not None:
        table = document_of(files[-1]).read(files[-1], MAX_BYTES).toml()
        below = _named(base, files[-1]) if _is_name(base) else None
        if below is None:
            table.add_error("base", _unknown(base))
        elif any(_is_same(below, file) for file in files):
            chain = ", ".join(file.stem for file in (*files, below))
            table.add_error("base", f"the bases go round in a circle ({chain})")
        table.document.raise_errors()
        assert below is not None  # noqa: S101 - or the line before has raised
        files.append(below)
        layers.append(read_mapping_file(below))
    mapping = Mapping(contents.name, (), about=contents.about, files=tuple(files))
    for layer in reversed(layers):
        mapping = _merged(mapping, layer)
    _check_size(path, mapping)
    return mapping


def _check_size(path: Path, mapping: Mapping) -> None:
    """Refuse a mapping that a part's tables have no room for."""
    curves = [bind.curve for bind in mapping.binds]
    points = sum(len(curve.points) for curve in curves if isinstance(curve, Breakpoints))
    for what, count, most in (("binds", len(curves), MAX_BINDS), ("points", points, MAX_POINTS)):
        if count > most:
            raise MappingError(f"{path}: {count} {what}, those of its bases too: at most {most}")


def _merged(below: Mapping, layer: MappingFile) -> Mapping:
    """A mapping overridden by a file's binds of the same controller, or target if exclusive."""
    overridden = {override_key(bind) for bind in layer.binds}
    exclusive = {bind.target for bind in layer.binds if bind.is_exclusive}
    remaining = [
        bind
        for bind in below.binds
        if override_key(bind) not in overridden and bind.target not in exclusive
    ]
    return replace(
        below,
        binds=(*remaining, *layer.binds),
        start=tuple((dict(below.start) | dict(layer.start)).items()),
        mpe=below.mpe if layer.mpe is None else layer.mpe,
        key_switches=below.key_switches if layer.key_switches is None else layer.key_switches,
    )


def _is_name(text: str) -> bool:
    name = text.removeprefix(MINE)
    path = Path(name)
    return path.suffix == "" and path.name == name


def _named(name: str, of: Path | None = None, *, user_first: bool = False) -> Path | None:
    """The file of a name; where it is the base `of` a file, not that file itself."""
    folders = [mapping_folder(), user_folder()]
    if name.startswith(MINE):
        del folders[0]
    for folder in reversed(folders) if user_first else folders:
        file = folder / f"{name.removeprefix(MINE)}.toml"
        try:
            if file.is_file() and not (of is not None and _is_same(file, of)):
                return file
        except (OSError, ValueError):  # no possible file name
            return None
    return None


def _is_same(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError:
        return one == other


def _unknown(name: str, hint: str = "") -> str:
    shipped, own = shipped_mappings(), [MINE + each for each in user_mappings()]
    known = ", ".join(shipped) + (f"; yours: {', '.join(own)}" if own else "")
    near = did_you_mean(name, [*shipped, *own])
    return f"no mapping {name!r} (shipped: {known}{hint}){near}"
