"""Keep the binds of MIDI learn in a mapping file of the user, based on the shipped one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from yehu_server.errors import MappingError
from yehu_server.files import write_text
from yehu_server.params.table import find
from yehu_server.playing.binds import Bind, override_key
from yehu_server.playing.learner import Found
from yehu_server.playing.mapping import Mapping, mapping_folder, own_folder, with_bases
from yehu_server.playing.mapping_entries import free
from yehu_server.playing.mapping_file import MappingFile, read_mapping_file, text_of
from yehu_server.playing.mapping_writer import as_toml, edited
from yehu_server.playing.sources import OF_ONE_NOTE, is_address


def own_file(mapping: Mapping) -> Path:
    """The file that keeps learned binds: the mapping's own, or for a shipped one the user's copy.

    Raises
    ------
    MappingError
        Where the mapping comes from no file.
    """
    if not mapping.files:
        raise MappingError(f"the mapping {mapping.name} comes from no file")
    own = mapping.files[0]
    is_shipped = own.parent.resolve() == mapping_folder().resolve()
    return own_folder() / own.name if is_shipped else own


def learn(mapping: Mapping, target: str, found: Found, *, soft: bool) -> tuple[Mapping, Path]:
    """Bind a source to a target, over its whole range, and save the bind.

    It replaces all other binds of the target, and moves it for all notes, on whichever device
    they are played.

    Returns
    -------
    mapping : Mapping
        With the bind.
    path : Path
        The file that it was saved to.

    Raises
    ------
    MappingError
        Where the file is wrong or cannot be written; nothing is changed then.
    """
    param = free(target, "learn one")
    bind = Bind(
        found.source,
        param.address,
        curve=param.curve,
        input_range=found.input_range,
        is_soft=soft and found.source not in OF_ONE_NOTE,
        is_exclusive=True,
        is_global=not (found.source in OF_ONE_NOTE or is_address(found.source)),
    )
    if bind.is_by_range:  # the bend range still sets its span
        bind = replace(bind, is_soft=False)
    path = own_file(mapping)
    contents, text = _own_contents(mapping, path)
    key = override_key(bind)
    dropped = [
        own for own in contents.binds if override_key(own) == key or own.target == bind.target
    ]
    return _save(mapping, path, edited(contents, text, dropped, [bind])), path


def unlearn(mapping: Mapping, target: str) -> tuple[Mapping, int]:
    """Remove the binds of a target from the user's file.

    Returns
    -------
    mapping : Mapping
        Without them.
    count : int
        Number of binds removed.

    Raises
    ------
    MappingError
        As `learn`.
    """
    address = find(target).address
    path = own_file(mapping)
    if not path.exists():
        return mapping, 0
    contents, text = _own_contents(mapping, path)
    dropped = [own for own in contents.binds if own.target == address]
    if not dropped:
        return mapping, 0
    return _save(mapping, path, edited(contents, text, dropped, [])), len(dropped)


def _own_contents(mapping: Mapping, path: Path) -> tuple[MappingFile, str]:
    """Contents and text of the user's file; where there is none, of a new one with this base."""
    if path.exists():
        return read_mapping_file(path), text_of(path)
    about = f"{mapping.about} With what you have taught it."
    contents = MappingFile(mapping.name, base=mapping.files[0].stem, about=about)
    return contents, as_toml(contents)


def _save(mapping: Mapping, path: Path, text: str) -> Mapping:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MappingError(f"{path.parent}: {error.strerror}") from error
    write_text(path, text)
    # `--mpe` is in no file.
    return replace(with_bases(path, read_mapping_file(path)), mpe=mapping.mpe)
