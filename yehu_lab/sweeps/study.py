"""A study: strokes that differ in some values; and Schelleng's limits of their bow force.

docs/sweep.md describes its file.
"""

import json
import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.sweeps.axes import Axis, axis_from
from yehu_lab.sweeps.gesture_strokes import GestureBow
from yehu_lab.sweeps.note_strokes import NoteBow
from yehu_server.core.physics.layout import F_N, FINGER_CONTROLS, V_B, X_B
from yehu_server.core.physics.schelleng import lower_limit, resistance, upper_limit
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.scores.gesture import on_instrument
from yehu_server.util.documents import Document, Fields
from yehu_server.util.values import choice, choices, whole

Array = Any

MAX_BYTES = 16 * 2**20
MAX_STROKES = 10**8
MAX_POINTS = 10**8  # of the finest grid
MAX_LEVELS = 8
BORDERS = ("regimes", "helmholtz")
KNOWN = (
    "about", "sample_rate", "duration", "instrument", "stroke", "gesture", "vary", "refine"
)  # fmt: skip


@dataclass(frozen=True)
class Study:
    """A study."""

    # The entries of its file, as JSON values, with what was asked for beside it.
    data: Mapping[str, Any]
    axes: tuple[Axis, ...]  # with all values of the finest grid
    refine: tuple[int, ...]  # axes that are refined where regimes meet
    levels: int  # how often a step may be halved
    border: str  # one of BORDERS: between all regimes, or between Helmholtz motion and all others
    bow: GestureBow | NoteBow  # makes the strokes

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each axis, of the finest grid."""
        return tuple(len(axis.values) for axis in self.axes)

    @property
    def coarse(self) -> int:
        """Number of strokes before any step is halved."""
        step = 2**self.levels
        return math.prod(
            (length - 1) // step + 1 if i in self.refine else length
            for i, length in enumerate(self.shape)
        )

    def as_text(self) -> str:
        """All of it as JSON, from which `study_from_text` makes the same study."""
        return json.dumps(self.data)  # in order, which is that of the axes


def read_study(path: Path, vary: Sequence[Axis] = (), instrument: Path | None = None) -> Study:
    """Read a study (TOML), or a gesture (JSON) that is to be varied.

    `vary` are axes beside those of the file; they replace axes of the same name. What the study has
    of an instrument changes that of the file `instrument`. Raises ScoreError where the file cannot
    be read; ParameterError where it is wrong.
    """
    document = Document(path, "a study", unreadable=ScoreError).read(path, MAX_BYTES)
    if path.suffix == ".json":
        data: Mapping[str, Any] = {"gesture": on_instrument(document.json().data, instrument)}
    else:
        table = document.toml()
        data = table.data
        if isinstance(data.get("gesture"), str):
            gesture = table.read("gesture", _gesture, None, path.parent)
            data = {**data, "gesture": on_instrument(gesture or {}, instrument)}
        elif "gesture" not in data:
            data = on_instrument(data, instrument)
    options = [axis.name for axis in vary]
    return study_of(Fields(with_axes(data, vary), document), path.parent, options)


def _gesture(name: str, folder: Path) -> Mapping[str, Any]:
    return Document(name, "a gesture file").read(folder / name, MAX_BYTES).json().data


def with_axes(data: Mapping[str, Any], axes: Sequence[Axis]) -> dict[str, Any]:
    """The data of a study, with more axes, or others of the same names."""
    vary = data.get("vary", {})
    if axes and isinstance(vary, Mapping):
        vary = dict(vary)
        for axis in axes:
            ends = {"from": axis.values[0], "to": axis.values[-1], "steps": len(axis.values)}
            vary[axis.name] = ends | {"spread": axis.spread} if axis.spread else list(axis.values)
    return {**data, "vary": vary}


def study_of(data: Any, folder: Path = Path(), options: Collection[str] = ()) -> Study:
    """Build a study from the data of its file.

    It has the contents of a gesture file, where it has a gesture; files that it names, such as a
    body, are searched in a folder. Raises ParameterError where an entry is wrong.

    `options`: the axes that come from --vary, for errors.
    """
    table = Fields.of(data)
    table.refuse_others(*KNOWN)
    vary = table.table("vary")
    axes = tuple(Fields(_flat(vary.data), vary.document, "vary", vary.key).each(axis_from).values())
    if not axes:
        vary.add_error("", "nothing is varied: name it under [vary], or by --vary")
    bow = (GestureBow if "gesture" in table.data else NoteBow).of(table, folder)
    refine, levels, border = _refinement(table.table("refine"), axes)
    with table.at("refine"):
        fine = tuple(axis.refined(levels) if i in refine else axis for i, axis in enumerate(axes))
    kept = {**table.data, "folder": str(folder.absolute())}
    study = Study(kept, fine, refine, levels, border, bow)
    with table.at():
        if study.coarse > MAX_STROKES:
            raise ParameterError(f"{study.coarse} strokes are more than {MAX_STROKES}")
        if math.prod(study.shape) > MAX_POINTS:
            raise ParameterError("the finest grid has too many points")
    with table.at("vary"):
        bow.check([axis for axis in fine if axis.name not in options])
    with Fields({}, Document("--vary")).at():
        bow.check(fine)
    return study


def study_from_text(text: str) -> Study:
    """The study of `Study.as_text`, perhaps on another machine."""
    data = json.loads(text)
    folder = Path(data.pop("folder", ""))
    return study_of(data, folder)


def _flat(table: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """Entries by dotted names: TOML makes tables of them, if they are not quoted."""
    found: dict[str, Any] = {}
    for name, entry in table.items():
        path = f"{above}{name}"
        if isinstance(entry, Mapping) and not {"from", "to", "steps"} & entry.keys():
            found |= _flat(entry, f"{path}.")
        else:
            found[path] = entry
    return found


def _refinement(table: Fields, axes: Sequence[Axis]) -> tuple[tuple[int, ...], int, str]:
    names = [axis.name for axis in axes]
    wanted = table.read("axes", choices, [], names)
    levels = table.read("levels", whole, 0, 0, MAX_LEVELS)
    border = table.read("border", choice, BORDERS[0], BORDERS)
    table.refuse_others()
    return tuple(sorted(names.index(name) for name in wanted)), levels if wanted else 0, border


@dataclass(frozen=True)
class Limits:
    """Of one stroke: Schelleng's limits (N), the bow position beta, and the note (Hz)."""

    lower: float
    upper: float
    beta: float
    frequency_hz: float


def limits_of(study: Study, at: Mapping[str, int]) -> Limits:
    """Schelleng's limits at a point of a study, for the bow's speed at the end.

    `at` is the place on each axis, by name; 0 where it has none.
    """
    index = np.array([[at.get(axis.name, 0) for axis in study.axes]])
    instruments, strokes, hands = study.bow.strokes(study.axes, index)
    model, stroke = instruments.models[0], strokes[0]

    def end(column: int) -> float:
        move = stroke["moves"][column]
        curve = slice(hands.first[column], hands.first[column + 1])
        time = (stroke["frames"] / model["rate"] - move["start"]) * move["pace"]
        times, values = hands.times[curve], hands.values[curve]
        return float(move["scale"] * np.interp(time, times, values)) if len(times) else 0.0

    string = 0 if end(F_N) >= 0.0 else 1
    bridge = float(model["bridge_x"])
    press = end(FINGER_CONTROLS + 1)
    stop = end(FINGER_CONTROLS) if press > 0.0 else 0.0
    beta = (bridge - end(X_B)) / (bridge - stop)
    Z = float(np.sqrt(model["T"][string] * model["rho_A"][string]))  # noqa: N806 - as in physics
    grip = float(model["mu_S"] - model["mu_C"])
    frequency = float(stroke["frequency_hz"])
    R = resistance(model, string, frequency, stop, press)  # noqa: N806
    speed = abs(end(V_B))
    return Limits(
        lower_limit(Z, grip, R, speed, beta), upper_limit(Z, grip, speed, beta), beta, frequency
    )
