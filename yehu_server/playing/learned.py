"""Keeping what is learned: in the mapping file of the player, with the shipped one as its base."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from yehu_server.errors import MappingError
from yehu_server.files import write_text
from yehu_server.params.table import find
from yehu_server.playing.binds import Bind, replaced
from yehu_server.playing.learner import Found
from yehu_server.playing.mapping import Mapping, mapping_folder, own_folder, with_bases
from yehu_server.playing.mapping_entries import free
from yehu_server.playing.mapping_file import Sheet, read_sheet, text_of
from yehu_server.playing.mapping_writer import as_toml, rebound
from yehu_server.playing.sources import OF_ONE_NOTE, is_address


def own_file(mapping: Mapping) -> Path:
    """The file that keeps what is learned for a mapping: its own, unless that is a shipped one.

    Errors: MappingError where it comes from no file.
    """
    if not mapping.files:
        raise MappingError(f"the mapping {mapping.name} comes from no file")
    own = mapping.files[0]
    is_shipped = own.parent.resolve() == mapping_folder().resolve()
    return own_folder() / own.name if is_shipped else own


def learn(mapping: Mapping, target: str, found: Found, *, soft: bool) -> tuple[Mapping, Path]:
    """Let a source move a target, over its whole range, and keep that; nothing else moves it then.

    It moves it for all notes, whichever box they are played on.

    Returns the mapping as it now is, and the file that keeps it.
    Errors: MappingError where the file is wrong or cannot be written; all is as it was then.
    """
    param = free(target, "learn one")
    bind = Bind(
        found.source,
        param.address,
        curve=param.curve,
        reach=found.reach,
        is_soft=soft and found.source not in OF_ONE_NOTE,
        is_alone=True,
        is_global=not (found.source in OF_ONE_NOTE or is_address(found.source)),
    )
    if bind.is_by_range:  # the wheel keeps its meaning, which its bend range has a say in
        bind = replace(bind, is_soft=False)
    path = own_file(mapping)
    sheet, text = _sheet(mapping, path)
    dropped = [
        own for own in sheet.binds if replaced(own) == replaced(bind) or own.target == bind.target
    ]
    return _keep(mapping, path, rebound(sheet, text, dropped, [bind])), path


def unlearn(mapping: Mapping, target: str) -> tuple[Mapping, int]:
    """Forget what the player's file says of a target; how many binds that were.

    Errors: as `learn`.
    """
    address = find(target).address
    path = own_file(mapping)
    if not path.exists():
        return mapping, 0
    sheet, text = _sheet(mapping, path)
    dropped = [own for own in sheet.binds if own.target == address]
    if not dropped:
        return mapping, 0
    return _keep(mapping, path, rebound(sheet, text, dropped, [])), len(dropped)


def _sheet(mapping: Mapping, path: Path) -> tuple[Sheet, str]:
    """What the player's file says, and its text; of a new one with the shipped one as base."""
    if path.exists():
        return read_sheet(path), text_of(path)
    base = mapping.files[0].stem
    sheet = Sheet(mapping.name, base=base, about=f"{mapping.about} With what you have taught it.")
    return sheet, as_toml(sheet)


def _keep(mapping: Mapping, path: Path, text: str) -> Mapping:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MappingError(f"{path.parent}: {error.strerror}") from error
    write_text(path, text)
    # What `--mpe` added is in no file.
    return replace(with_bases(path, read_sheet(path)), mpe=mapping.mpe)
