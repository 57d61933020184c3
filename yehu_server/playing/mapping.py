"""Mappings: which controllers move which parameters. Found by name, with the base each names.

A plain name is a shipped mapping's first, so that what a render or a file names is the same for
everyone; ``mine/NAME`` is the user's own. Only who plays live looks among their own first, where
what was learned is kept.

The format of the files is described in mappings/README.md.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from platformdirs import user_config_path

from yehu_server.errors import MappingError
from yehu_server.files import shipped_folder
from yehu_server.playing.binds import Bind, replaced
from yehu_server.playing.mapping_file import Complaints, Sheet, read_sheet, text_of
from yehu_server.playing.sources import is_address

DEFAULT, MPE = "keyboard", "mpe"
MINE = "mine/"  # before the name of one of the user's own


def mapping_folder() -> Path:
    """Where the shipped mappings are."""
    return shipped_folder("mappings")


def own_folder() -> Path:
    """Where the user's mappings are, if there are any."""
    return user_config_path("yehu-server") / "mappings"


@dataclass(frozen=True)
class Mapping:
    """A named set of binds; several may share a source or a target (the last move counts).

    `start` are parameters with the values they begin with; `mpe` is whether every port begins
    as an MPE zone; `about` says in a line what it is for; `files` are what it was read from,
    its own first and then its bases'.
    """

    name: str
    binds: tuple[Bind, ...]
    start: tuple[tuple[str, float], ...] = ()
    mpe: bool = False
    about: str = ""
    files: tuple[Path, ...] = field(default=(), compare=False)

    def of(self, source: str) -> tuple[Bind, ...]:
        """The binds of one source."""
        return self._by_source.get(source, ())

    @property
    def sources(self) -> tuple[str, ...]:
        """All that moves something."""
        return tuple(self._by_source)

    @cached_property
    def addresses(self) -> tuple[str, ...]:
        """The sources that are OSC addresses."""
        return tuple(source for source in self._by_source if is_address(source))

    @cached_property
    def has_global(self) -> bool:
        """Whether a bind is global."""
        return any(bind.is_global for bind in self.binds)

    @cached_property
    def _by_source(self) -> dict[str, tuple[Bind, ...]]:
        found: dict[str, tuple[Bind, ...]] = {}
        for bind in self.binds:
            found[bind.source] = (*found.get(bind.source, ()), bind)
        return found


def shipped_mappings() -> list[str]:
    """Names of the mappings that come with the package."""
    return _names(mapping_folder())


def own_mappings() -> list[str]:
    """Names of the mappings in the user's folder."""
    return _names(own_folder())


def _names(folder: Path) -> list[str]:
    return sorted(file.stem for file in folder.glob("*.toml"))


def is_own(mapping: Mapping) -> bool:
    """Whether it comes from the user's folder."""
    return any(_is_same(file.parent, own_folder()) for file in mapping.files[:1])


def load(name_or_path: str, *, own_first: bool = False) -> Mapping:
    """Read a mapping by its name, or from a file.

    Parameters
    ----------
    name_or_path : str
        A name, ``mine/`` and the name of one of the user's own, or a path.
    own_first : bool
        Whether a plain name is one of the user's own first; else a shipped one's.

    Errors: MappingError, naming file and line.
    """
    path = find_file(name_or_path, own_first=own_first)
    return with_bases(path, read_sheet(path))


def find_file(name_or_path: str, *, own_first: bool = False) -> Path:
    """The file of a mapping; what is no name is a path. Errors: MappingError."""
    if not _is_name(name_or_path):
        return Path(name_or_path)
    found = _named(name_or_path, own_first=own_first)
    if found is None:
        raise MappingError(_unknown(name_or_path, "; or name a file"))
    return found


def with_bases(path: Path, sheet: Sheet) -> Mapping:
    """What a file says, over what its base and the bases of that say. Errors: MappingError."""
    sheets, files = [sheet], [path]
    while (base := sheets[-1].base) is not None:
        wrong = Complaints(files[-1], text_of(files[-1]))
        below = _named(base, files[-1]) if _is_name(base) else None
        if below is None:
            wrong.add(("base",), f"base: {_unknown(base)}")
        elif any(_is_same(below, file) for file in files):
            chain = ", ".join(file.stem for file in (*files, below))
            wrong.add(("base",), f"base: the bases go round in a circle ({chain})")
        wrong.end()
        assert below is not None  # noqa: S101 - or the line before has raised
        files.append(below)
        sheets.append(read_sheet(below))
    mapping = Mapping(sheet.name, (), about=sheet.about, files=tuple(files))
    for each in reversed(sheets):
        mapping = _over(mapping, each)
    return mapping


def _over(below: Mapping, sheet: Sheet) -> Mapping:
    """A mapping with what a file adds; its binds replace those of the same controller.

    A bind that is alone also replaces what else moves its target.
    """
    own = {replaced(bind) for bind in sheet.binds}
    taken = {bind.target for bind in sheet.binds if bind.is_alone}
    kept = [b for b in below.binds if replaced(b) not in own and b.target not in taken]
    return Mapping(
        below.name,
        (*kept, *sheet.binds),
        tuple((dict(below.start) | dict(sheet.start)).items()),
        below.mpe if sheet.mpe is None else sheet.mpe,
        below.about,
        below.files,
    )


def _is_name(text: str) -> bool:
    name = text.removeprefix(MINE)
    path = Path(name)
    return path.suffix == "" and path.name == name


def _named(name: str, of: Path | None = None, *, own_first: bool = False) -> Path | None:
    """The file of a name; as the base `of` a file never that file itself."""
    folders = [mapping_folder(), own_folder()]
    if name.startswith(MINE):
        del folders[0]
    for folder in reversed(folders) if own_first else folders:
        file = folder / f"{name.removeprefix(MINE)}.toml"
        try:
            if file.is_file() and not (of is not None and _is_same(file, of)):
                return file
        except (OSError, ValueError):  # a name that no file could have
            return None
    return None


def _is_same(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError:
        return one == other


def _unknown(name: str, hint: str = "") -> str:
    known = ", ".join(shipped_mappings())
    if own := own_mappings():
        known += f"; yours: {', '.join(MINE + name for name in own)}"
    return f"no mapping {name!r} (shipped: {known}{hint})"
