"""The order of playing: repeats with their endings, da capo and dal segno, unfolded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

from yehu_server.errors import ScoreError

MOST_UNFOLDED = 50_000  # notes, rests and dashes of a part
MOST_DEPTH = 8  # repeats within repeats
MOST_TIMES = 100


class Jump(Enum):
    """A sign of the form; its value is its word."""

    FINE = "Fine"
    SEGNO = "Segno"
    TO_CODA = "ToCoda"
    DA_CAPO = "DC"
    DAL_SEGNO = "DS"


BACK = (Jump.DA_CAPO, Jump.DAL_SEGNO)


@dataclass
class Repeat:
    """What is played several times, and the endings, of which each time takes one."""

    times: int
    body: list[object] = field(default_factory=list)
    endings: list[list[object]] = field(default_factory=list)


def unfolded(written: Sequence[object]) -> tuple[list[object], list[str]]:
    """Elements in the order of playing, and warnings.

    After a da capo or dal segno, repeats are not taken again, and of endings the last is played.
    Only the first of several is taken.

    Parameters
    ----------
    written : sequence
        Elements, Repeats and Jumps as written.

    Raises
    ------
    ScoreError
        Where there are more than MOST_UNFOLDED.
    """
    once = _flat(written, repeated=True)
    back = next((at for at, each in enumerate(once) if each in BACK), None)
    if back is None:
        return _without_jumps(once), []
    warnings = []
    if sum(each in BACK for each in _flat(written, repeated=False)) > 1:
        warnings.append("of several DC and DS, only the first is played")
    again = _flat(written, repeated=False)
    turn = next(at for at, each in enumerate(again) if each in BACK)
    start = 0
    if once[back] is Jump.DAL_SEGNO:
        signs = [at for at, each in enumerate(again[:turn]) if each is Jump.SEGNO]
        if not signs:
            warnings.append("a DS without a Segno: played from the beginning")
        start = signs[-1] if signs else 0
    played = once[:back] + _to_the_end(again, start, turn)
    _check(played)
    return _without_jumps(played), warnings


def _to_the_end(again: list[object], start: int, turn: int) -> list[object]:
    """From a place to Fine, or by the coda, or to the end."""
    for at in range(start, len(again)):
        if again[at] is Jump.FINE:
            return again[start:at]
        if again[at] is Jump.TO_CODA and at < turn:
            return again[start:at] + again[turn + 1 :]
    return again[start:]


def _without_jumps(elements: list[object]) -> list[object]:
    return [each for each in elements if not isinstance(each, Jump)]


def _flat(written: Sequence[object], *, repeated: bool) -> list[object]:
    played: list[object] = []
    for each in written:
        if not isinstance(each, Repeat):
            played.append(each)
            continue
        body = _flat(each.body, repeated=repeated)
        endings = [_flat(ending, repeated=repeated) for ending in each.endings]
        times = max(each.times, len(endings))
        if not repeated:
            played += body + (endings[-1] if endings else [])
            continue
        length = len(body) + max(map(len, endings), default=0)
        if length * times > 2 * MOST_UNFOLDED:
            raise _too_long()
        for time in range(times):
            played += body
            if endings:  # with fewer endings than times, the first one comes more often
                played += endings[max(0, time - (times - len(endings)))]
        _check(played)
    return played


def _check(played: list[object]) -> None:
    if len(played) > MOST_UNFOLDED:
        raise _too_long()


def _too_long() -> ScoreError:
    return ScoreError(f"with its repeats, has more than {MOST_UNFOLDED} notes")
