"""Mapping files: which controller moves which parameter, how far and along which curve.

The format is described in mappings/README.md.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from yehu_server.errors import MappingError, ParameterError
from yehu_server.files import read_text, shipped_folder
from yehu_server.params.spec import Curve, Place
from yehu_server.params.table import find

SOURCES = ("bend", "pressure", "poly-pressure", "velocity")
# Data entry, RPN and NRPN, channel mode messages: see messages.py.
# Sustain (64) has its meaning unless a mapping gives it another.
RESERVED = {6, 38, *range(96, 102), *range(120, 128)}
_CC = re.compile(r"cc (0|[1-9][0-9]{0,2})")
DEFAULT, MPE = "keyboard", "mpe"
ENTRIES = ("name", "about", "mpe", "start", "bind")


def mapping_folder() -> Path:
    """Where the shipped mappings are."""
    return shipped_folder("mappings")


@dataclass(frozen=True)
class Bind:
    """One controller that moves one parameter.

    `source` is ``cc N``, ``bend``, ``pressure``, ``poly-pressure`` or ``velocity``. The
    controller's way, 0 to 1, is spread over `span` along `curve`; a span from high to low
    inverts. Without a span the bend is in semitones, by the bend range.
    """

    source: str
    target: str
    span: tuple[float, float] | None = None
    curve: Curve = Curve.LIN

    @property
    def is_by_range(self) -> bool:
        """Whether it spans what the bend range (RPN 0) says."""
        return self.source == "bend" and self.span is None and self.target == "/playing/bend"

    @property
    def ends(self) -> tuple[float, float]:
        """The target's values at the two ends of the controller's way."""
        param = find(self.target)
        return self.span or (param.lo, param.hi)

    def apply(self, unit: float) -> float:
        """Map the controller's place, 0 to 1, to the target's value."""
        return self.curve.bend(unit, *self.ends)


@dataclass(frozen=True)
class Mapping:
    """A named set of binds; several may share a source or a target (the last move counts).

    `start` are parameters with the values they begin with; `mpe` is whether every port begins
    as an MPE zone; `about` says in a line what it is for.
    """

    name: str
    binds: tuple[Bind, ...]
    start: tuple[tuple[str, float], ...] = ()
    mpe: bool = False
    about: str = ""

    def of(self, source: str) -> tuple[Bind, ...]:
        """The binds of one source."""
        return tuple(bind for bind in self.binds if bind.source == source)


def shipped_mappings() -> list[str]:
    """Names of the mappings that come with the package."""
    return sorted(file.stem for file in mapping_folder().glob("*.toml"))


def load(name_or_path: str) -> Mapping:
    """Read a mapping by the name of a shipped one, or from a file.

    Errors: MappingError, naming the file and the bind.
    """
    path = Path(name_or_path)
    is_name = path.suffix == "" and path.name == name_or_path
    if is_name:
        shipped = mapping_folder() / f"{name_or_path}.toml"
        if not shipped.exists():
            names = ", ".join(shipped_mappings())
            raise MappingError(f"no mapping {name_or_path!r} (shipped: {names}; or name a file)")
        path = shipped
    try:
        data = tomllib.loads(read_text(path))
    except OSError as error:
        raise MappingError(f"{path}: {error.strerror}") from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise MappingError(f"{path}: not a mapping file ({error})") from error
    unknown = set(data) - set(ENTRIES)
    if unknown:
        known = ", ".join(ENTRIES)
        raise MappingError(f"{path}: unknown entry {min(unknown)!r} (known: {known})")
    entries = data.get("bind", [])
    if not isinstance(entries, list):
        raise MappingError(f"{path}: write each bind as [[bind]]")
    binds = []
    for number, entry in enumerate(entries, start=1):
        try:
            binds.append(_bind(entry))
        except ParameterError as error:
            raise MappingError(f"{path}: bind {number}: {error}") from error
    mpe = data.get("mpe", False)
    if not isinstance(mpe, bool):
        raise MappingError(f"{path}: mpe: expected true or false, got {mpe!r}")
    try:
        start = _start(data.get("start", {}))
    except ParameterError as error:
        raise MappingError(f"{path}: start: {error}") from error
    about = data.get("about", "")
    if not isinstance(about, str):
        raise MappingError(f"{path}: about: expected a line of text, got {about!r}")
    return Mapping(str(data.get("name", path.stem)), tuple(binds), start, mpe, about)


def _start(entries: Any) -> tuple[tuple[str, float], ...]:
    if not isinstance(entries, dict):
        raise ParameterError("expected a table of addresses and values")
    for address, value in entries.items():
        param = find(address)
        if param.place is not Place.PLAYER:
            raise ParameterError(f"{address} is moved by the player; set one under /playing")
        if param.accept(value) != value:
            raise ParameterError(f"{address}: {value} is not within {param.range_text}")
    return tuple((address, float(value)) for address, value in entries.items())


def _bind(entry: Any) -> Bind:
    known = ("source", "target", "span", "curve")
    if not isinstance(entry, dict):
        raise ParameterError("expected a table")
    for name in entry:
        if name not in known:
            raise ParameterError(f"unknown entry {name!r} (known: {', '.join(known)})")
    source, target = entry.get("source"), entry.get("target")
    if not isinstance(source, str) or not isinstance(target, str):
        raise ParameterError("needs a source and a target")
    controller = _CC.fullmatch(source)
    if source not in SOURCES and not (controller and int(controller[1]) <= 127):
        raise ParameterError(f"unknown source {source!r} (cc 0-119, {', '.join(SOURCES)})")
    if controller and int(controller[1]) in RESERVED:
        raise ParameterError(f"{source} has a meaning of its own in MIDI")
    param = find(target)
    if param.place is not Place.PLAYER:
        raise ParameterError(f"{target} is moved by the player; map to one under /playing")
    try:
        curve = Curve(entry.get("curve", param.curve.value))
    except ValueError:
        names = ", ".join(curve.value for curve in Curve)
        raise ParameterError(f"unknown curve {entry['curve']!r} (known: {names})") from None
    span = _span(entry.get("span"), param.lo, param.hi)
    lo, hi = span or (param.lo, param.hi)
    if curve is Curve.EXP and min(lo, hi) <= 0.0:
        raise ParameterError("an exp curve needs a span above zero")
    return Bind(source, target, span, curve)


def _span(value: Any, lo: float, hi: float) -> tuple[float, float] | None:
    if value is None:
        return None
    numbers = isinstance(value, list) and all(
        isinstance(end, int | float) and not isinstance(end, bool) for end in value
    )
    if not numbers or len(value) != 2:
        raise ParameterError(f"span: expected [from, to], got {value!r}")
    for end in value:
        if not lo <= end <= hi:  # also refuses NaN
            raise ParameterError(f"span: {end} is not within {lo:g} to {hi:g}")
    return float(value[0]), float(value[1])
