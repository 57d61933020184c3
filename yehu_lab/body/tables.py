"""Taps or responses from tables of numbers (CSV), whose first line names the columns.

The first column is the time in seconds, for a tap, or the frequency in hertz, for a response.
"""

import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.body.curve import KINDS, OTHER_NAMES, RADIATION, Curve, Floats
from yehu_lab.body.tap import SKIPPED, Channel, Tap, by_quantity, check_channels, cut, parse_heading
from yehu_server.errors import MeasurementError
from yehu_server.util.files import MAX_TEXT_BYTES, error_reason, read_lines

MIN_LINES = 20
MAX_NUMBERS = 2**23
UNEVEN = 1e-3  # relative: how much steps of time may differ


@dataclass(frozen=True)
class Response:
    """A response over frequency as it was measured, and what it is (see `curve.KINDS`)."""

    curve: Curve
    kind: str


def read_table(
    path: Path, channels: Sequence[Channel] | None, kind: str | None
) -> list[Tap] | list[Response]:
    """Read a table: the taps in it, or a response over frequency.

    What the columns after the time are, `channels`, and what a response is, `kind`, the headings
    say by default. Raises MeasurementError where it cannot be read, or what it holds is not given.
    """
    try:
        headings, numbers = _numbers(path, _lines(path))
    except OSError as error:
        raise MeasurementError(f"{path}: {error_reason(error)}") from error
    except UnicodeDecodeError as error:
        raise MeasurementError(f"{path}: not a table of text") from error
    first = headings[0].lower()
    if first.startswith("t"):
        return _taps(path, headings, numbers, channels)
    if first.startswith("f"):
        return _response(path, headings, numbers, kind)
    raise MeasurementError(
        f"{path}: its first column is {headings[0]!r}, neither time nor frequency"
    )


def _lines(path: Path) -> Iterator[str]:
    """The lines that hold something; one at a time, since all would take some times the file."""
    for number, text in enumerate(read_lines(path, MAX_TEXT_BYTES)):
        line = text.lstrip("\ufeff") if number == 0 else text
        # A file of a system whose lines end in CR alone is one line to the reader.
        for part in line.splitlines():
            if part.strip() and not part.lstrip().startswith("#"):
                yield part


def _numbers(path: Path, lines: Iterator[str]) -> tuple[list[str], Floats]:
    """The headings, and the numbers [shape=(lines, columns)]."""
    first = next(lines, "")
    mark = next((mark for mark in ("\t", ";", ",") if mark in first), None)
    headings = [cell.strip().strip('"') for cell in first.split(mark)]
    if headings and re.fullmatch(r"[-+.\deE]+", headings[0]):
        raise MeasurementError(
            f"{path}: its first line names no columns, such as time_s,force_N,velocity_m/s"
        )
    found = array("d")
    for line in lines:
        cells = line.split(mark)
        if mark in ("\t", ";"):
            cells = [cell.replace(",", ".") for cell in cells]
        try:
            found.extend([float(cell) for cell in cells])
        except ValueError:
            raise MeasurementError(f"{path}: no numbers in {line[:40]!r}") from None
        if len(cells) != len(headings):
            raise MeasurementError(f"{path}: {len(headings)} columns, but not in {line[:40]!r}")
        if len(found) > MAX_NUMBERS:
            raise MeasurementError(f"{path}: has more than {MAX_NUMBERS} numbers")
    count = 1 + len(found) // len(headings) if headings else 0
    if count < MIN_LINES:
        raise MeasurementError(f"{path}: has {count} lines, too few for a measurement")
    numbers = np.frombuffer(found).reshape(-1, len(headings))
    if not np.isfinite(numbers).all():
        raise MeasurementError(f"{path}: holds a number that is not finite")
    return headings, numbers


def _taps(
    path: Path, headings: list[str], numbers: Floats, channels: Sequence[Channel] | None
) -> list[Tap]:
    steps = np.diff(numbers[:, 0])
    step = float(np.median(steps))
    if step <= 0.0 or np.abs(steps - step).max() > UNEVEN * step + 1e-9:
        raise MeasurementError(f"{path}: its times are not evenly spaced")
    if channels is None:
        try:
            found = [parse_heading(heading) for heading in headings[1:]]
        except MeasurementError as error:
            raise MeasurementError(f"{path}: {error}") from error
        channels = [channel or Channel(SKIPPED) for channel in found]
        check_channels(list(channels), str(path))
    if len(channels) != len(headings) - 1:
        raise MeasurementError(
            f"{path}: has {len(headings) - 1} columns beside the time, not {len(channels)} as given"
        )
    rate = (len(numbers) - 1) / float(numbers[-1, 0] - numbers[0, 0])
    return cut(rate, by_quantity(channels, numbers[:, 1:]), path.name)


def _response(path: Path, headings: list[str], numbers: Floats, kind: str | None) -> list[Response]:
    words = [re.findall(r"[a-zμµ²]+", heading.lower()) for heading in headings]
    kind = kind or kind_in(" ".join(headings))
    if kind is None:
        raise MeasurementError(
            f"{path}: name what it is by --kind: {', '.join((*KINDS, RADIATION))}"
        )
    at = {name: i for i, cells in enumerate(words) for name in cells}
    if "real" in at and ("imag" in at or "imaginary" in at):
        values = numbers[:, at["real"]] + 1j * numbers[:, at.get("imag", at.get("imaginary", 0))]
    else:
        values = _polar(path, at, numbers)
    coherence = numbers[:, at["coherence"]].clip(0.0, 1.0) if "coherence" in at else None
    return [Response(rising(Curve(numbers[:, 0], values, coherence), str(path)), kind)]


def _polar(path: Path, at: dict[str, int], numbers: Floats) -> Any:
    """Values of magnitude and phase, in the units that the headings name."""
    size = next((at[name] for name in ("magnitude", "mag", "abs", "level") if name in at), None)
    if size is None or "phase" not in at:
        raise MeasurementError(
            f"{path}: needs columns named real and imag, or magnitude and phase_deg"
        )
    magnitude, phase = numbers[:, size], numbers[:, at["phase"]]
    if at.get("db") == size or at.get("level") == size:
        magnitude = 10.0 ** (magnitude / 20.0)
    if at.get("rad") != at["phase"]:
        if at.get("deg") != at["phase"] and np.abs(phase).max() < 7.0:
            raise MeasurementError(f"{path}: name its phase phase_deg or phase_rad")
        phase = np.radians(phase)
    return magnitude * np.exp(1j * phase)


def kind_in(text: str) -> str | None:
    """The kind of response that a text names, if it names one."""
    words: list[str] = re.findall(r"[a-z]+", text.lower())
    for word in words:
        if word in KINDS or word == RADIATION:
            return word
        if word in OTHER_NAMES:
            return OTHER_NAMES[word]
    return None


def rising(curve: Curve, where: str) -> Curve:
    """The curve by rising frequency, above 0 Hz.

    Raises MeasurementError where two lines have one frequency, or too few are left.
    """
    order = np.argsort(curve.frequency_hz, kind="stable")
    found = curve.at(order[curve.frequency_hz[order] > 0.0])
    if len(found.values) < MIN_LINES or np.diff(found.frequency_hz).min() <= 0.0:
        raise MeasurementError(f"{where}: too few lines, or two at one frequency")
    return found
