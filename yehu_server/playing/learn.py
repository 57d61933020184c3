"""Learn a controller: keep the bind of a source that was moved in the user's mapping file."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from yehu_server.compile.cache_folder import data_folder
from yehu_server.errors import MappingError
from yehu_server.params.table import find
from yehu_server.playing.bind import Bind, override_key
from yehu_server.playing.learner import LearnedSource
from yehu_server.playing.mapping import (
    Mapping,
    load,
    mapping_folder,
    shipped_mappings,
    user_folder,
    with_bases,
)
from yehu_server.playing.mapping_file import MappingFile, read_mapping_file, settable_param, text_of
from yehu_server.playing.mapping_writer import as_toml, edited
from yehu_server.playing.sources import OF_ONE_NOTE, is_address
from yehu_server.util.files import error_reason, write_text
from yehu_server.util.processes import machine_lock

LOCK = "learned"  # another server may learn at the same time


def own_file(mapping: Mapping) -> Path:
    """The file of learned binds: the mapping's own, or the user's copy; raises MappingError."""
    if not mapping.files:
        raise MappingError(f"the mapping {mapping.name} comes from no file")
    own = mapping.files[0]
    is_shipped = own.parent.resolve() == mapping_folder().resolve()
    return user_folder() / own.name if is_shipped else own


def current(mapping: Mapping) -> Mapping:
    """A mapping as its file of learned binds has it now: another server may have changed it."""
    path = own_file(mapping)
    if not path.exists():
        return mapping
    # `--mpe` is in no file.
    return replace(with_bases(path, read_mapping_file(path)), mpe=mapping.mpe)


def learn(
    mapping: Mapping, target: str, found: LearnedSource, *, soft: bool, only: bool = False
) -> tuple[Mapping, Path]:
    """Bind a source to a target, over its whole range, and save the bind.

    It moves the target for all notes, on whichever device they are played, beside the sources that
    did so before, or with `only` in their place. It replaces all other binds of its source. What it
    replaces in the user's file is kept with it, for `unlearn`.
    Returns the mapping with the bind, and the file that it was saved to. Raises MappingError where
    the file is wrong or cannot be written; nothing is changed then.
    """
    param = settable_param(target, "learn one")
    bind = Bind(
        found.source,
        param.address,
        curve=param.curve,
        input_range=found.input_range,
        part=found.part,
        is_soft=soft and found.source not in OF_ONE_NOTE,
        is_exclusive=only,
        is_global=not (found.source in OF_ONE_NOTE or is_address(found.source)),
        is_learned=True,
    )
    if bind.is_by_range:  # the bend range still sets its span
        bind = replace(bind, is_soft=False)
    path = own_file(mapping)
    with machine_lock(data_folder(), LOCK):
        contents, text = _own_contents(mapping, path)
        dropped = [own for own in contents.binds if _excludes(bind, own)]
        added = [_replacing(bind, dropped)]
        return _save(mapping, path, edited(contents, text, dropped, added)), path


def unlearn(mapping: Mapping, target: str) -> tuple[Mapping, int]:
    """Remove the learned binds of a target from the user's file, and give back what they replaced.

    One whose control has learned another target since then does not come back with that. Where none
    is learned, those that the user has written are removed. Returns the mapping without
    them, and how many were removed. Raises MappingError as `learn`.
    """
    with machine_lock(data_folder(), LOCK):
        return _unlearned(mapping, find(target).address, own_file(mapping))


def _unlearned(mapping: Mapping, address: str, path: Path) -> tuple[Mapping, int]:
    if not path.exists():
        return mapping, 0
    contents, text = _own_contents(mapping, path)
    of_target = [own for own in contents.binds if own.target == address]
    kept = [one for own in contents.binds for one in own.replaces]
    given_up = [one for one in kept if one.target == address and one.is_learned]
    dropped = [own for own in of_target if own.is_learned] or ([] if given_up else of_target)
    if not (dropped or given_up):
        return mapping, 0
    remaining = [own for own in contents.binds if own not in dropped]
    binds = [
        replace(own, replaces=tuple(one for one in own.replaces if one not in given_up))
        for own in remaining
    ]
    back: list[Bind] = []
    count = len(dropped) + len(given_up)
    for returned in [each for own in dropped for each in own.replaces]:
        # What was learned since then goes first; what the user wrote beside it comes back, too.
        newer = next(
            (
                own
                for own in binds
                if own.is_learned
                and _excludes(own, returned)
                and (own not in back or _is_plain(own))
            ),
            None,
        )
        if newer is None:
            binds.append(returned)
            back.append(returned)
        else:
            binds[binds.index(newer)] = _replacing(newer, [returned])
    removed = [own for own in contents.binds if own not in binds]
    added = [own for own in binds if own not in remaining]
    text = edited(contents, text, removed, added)
    if path.stem in shipped_mappings() and path.parent == user_folder():
        shipped = load(path.stem)
        if text.split() == as_toml(_new_contents(shipped)).split():  # nothing is left of the user
            path.unlink(missing_ok=True)
            return replace(shipped, mpe=mapping.mpe), count
    return _save(mapping, path, text), count


def others(mapping: Mapping, target: str, source: str) -> list[str]:
    """The sources beside one that move a target."""
    movers = dict.fromkeys(bind.source for bind in mapping.binds if bind.target == target)
    return [other for other in movers if other != source]


def added(before: Mapping, after: Mapping, target: str, found: LearnedSource) -> str:
    """What `learn` has changed, in a line: what was added, what stays and what is gone."""
    words = [f"{found} added: {target}"]
    if stay := others(after, target, found.source):
        words.append(f"{', '.join(stay)} still move{'s' * (len(stay) == 1)} it, too")
    words += [f"{lost} no longer moves {of}" for lost, of in changes(before, after)]
    return "; ".join(words)


def changes(before: Mapping, after: Mapping) -> list[tuple[str, str]]:
    """Source and target of each bind of a mapping that is not in another one."""
    kept = {(bind.source, bind.target) for bind in after.binds}
    lost = [(bind.source, bind.target) for bind in before.binds]
    return [pair for pair in dict.fromkeys(lost) if pair not in kept]


def _excludes(learned: Bind, other: Bind) -> bool:
    is_of_target = learned.is_exclusive and learned.target == other.target
    return is_of_target or override_key(learned) == override_key(other)


def _replacing(bind: Bind, dropped: Iterable[Bind]) -> Bind:
    """A learned bind that keeps others: but not what the same target has learned before."""
    kept = list(bind.replaces)
    for other in dropped:
        if not (other.target == bind.target and _is_plain(other)):
            kept.append(replace(other, replaces=()))
        kept += other.replaces
    return replace(bind, replaces=tuple(dict.fromkeys(kept)))


def _is_plain(bind: Bind) -> bool:
    """Whether it is as `learn` makes it: its control can be moved again, nothing else is lost."""
    return bind.is_learned and bind == replace(
        bind, curve=find(bind.target).curve, span=None, invert=False, smoothing_ms=0.0, channels=()
    )


def _own_contents(mapping: Mapping, path: Path) -> tuple[MappingFile, str]:
    """Contents and text of the user's file; where there is none, of a new one with this base."""
    if path.exists():
        return read_mapping_file(path), text_of(path)
    contents = _new_contents(mapping)
    return contents, as_toml(contents)


def _new_contents(mapping: Mapping) -> MappingFile:
    """A file of the user's with a shipped mapping as its base, of which nothing is changed yet."""
    about = f"{mapping.about} With what you have taught it."
    return MappingFile(mapping.name, base=mapping.files[0].stem, about=about)


def _save(mapping: Mapping, path: Path, text: str) -> Mapping:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MappingError(f"{path.parent}: {error_reason(error)}") from error
    write_text(path, text)
    return current(mapping)
