"""Taps of a force hammer: cut out of recordings, checked for faults, written to sound files.

And what the channels of a recording are: names, and how large full scale or a unit is.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from yehu_lab.body.curve import Floats
from yehu_server.errors import MeasurementError
from yehu_server.util.files import error_reason, make_folder, replace_any, replace_none, replacing

# What a channel may be; all but the force are responses.
QUANTITIES = ("force", "velocity", "acceleration", "displacement", "pressure")
SKIPPED = "none"
UNITS = {
    "force": {"n": 1.0, "mn": 1e-3},
    "velocity": {"m/s": 1.0, "mm/s": 1e-3, "um/s": 1e-6},
    "acceleration": {"m/s2": 1.0, "m/s^2": 1.0, "g": 9.80665},
    "displacement": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
    "pressure": {"pa": 1.0, "mpa": 1e-3},
}
HIT = 0.2  # of the largest force in a recording: what is above is a hit
APART_S = 0.2  # between two taps of one recording; nearer, they are one that bounced
BEFORE_S, LONGEST_S = 5e-3, 1.0  # kept before the hit, and in all
OVER = 0.05  # of the peak: the hammer has left
BOUNCE = 0.1  # of the peak: a force after it has left is another hit,
OVER_NOISE = 8.0  # where it stands out of the noise by so many deviations
FLAT, EQUAL = 3, 1e-5  # samples of equal height that a clipped peak has, and how equal
SHORTEST_S = 0.05  # after the hit: less shows nothing of a body
LONGEST_FILE_S = 600.0
MAX_SAMPLES = 2**24  # of all channels, in a file: three minutes of two channels at 48 kHz
LOWEST_RATE, HIGHEST_RATE = 8000, 400_000
SOUND_ENDINGS = (".wav", ".wave", ".flac", ".aif", ".aiff")
SUBTYPE = "PCM_24"


@dataclass(frozen=True)
class Channel:
    """One channel: a quantity or ``none``, and how many SI units a value of 1 is."""

    quantity: str
    scale: float = 1.0


def parse_channels(text: str) -> tuple[Channel, ...]:
    """Read channels as users write them, in their order: ``force=100,velocity=0.5``.

    Raises MeasurementError for an unknown quantity, one that is given twice, or a scale that is
    none.
    """
    channels = []
    for item in text.split(","):
        name, _, scale = item.strip().partition("=")
        if name not in (*QUANTITIES, SKIPPED):
            known = ", ".join((*QUANTITIES, SKIPPED))
            raise MeasurementError(f"channels: unknown quantity {name!r} (known: {known})")
        channels.append(Channel(name, _scale(name, scale or "1")))
    check_channels(channels, "channels")
    return tuple(channels)


def check_channels(channels: list[Channel], where: str) -> None:
    """Refuse a quantity that is given twice. Raises MeasurementError, naming it."""
    names = [channel.quantity for channel in channels if channel.quantity != SKIPPED]
    for name in names:
        if names.count(name) > 1:
            raise MeasurementError(f"{where}: {name} is given twice")


def by_quantity(channels: Sequence[Channel], values: Floats) -> dict[str, Floats]:
    """The values of each quantity, in SI units, of columns [shape=(samples, channels)]."""
    return {
        channel.quantity: values[:, i] * channel.scale
        for i, channel in enumerate(channels)
        if channel.quantity != SKIPPED
    }


def _scale(name: str, text: str) -> float:
    try:
        scale = float(text)
    except ValueError:
        scale = math.nan
    if not (math.isfinite(scale) and scale != 0.0):
        raise MeasurementError(f"channels: {name}={text} is not a number other than 0")
    return scale


def parse_heading(text: str) -> Channel | None:
    """Read the heading of a column: ``force_N``, ``velocity (mm/s)``; None where it is no quantity.

    Raises MeasurementError for a unit that is not known.
    """
    match = re.fullmatch(r"\s*([a-z]+)[\s_]*[(\[]?\s*([^)\]]*?)\s*[)\]]?\s*", text.lower())
    if match is None or match[1] not in QUANTITIES:
        return None
    quantity, unit = match[1], match[2].replace("²", "2").replace("µ", "u").replace("μ", "u")
    if not unit:
        return Channel(quantity)
    if unit not in UNITS[quantity]:
        known = ", ".join(UNITS[quantity])
        raise MeasurementError(f"{quantity} in {unit!r}: unknown unit (known: {known})")
    return Channel(quantity, UNITS[quantity][unit])


@dataclass(frozen=True)
class Tap:
    """One hit of the hammer: force (N), responses in SI units, and the sample rate (Hz)."""

    rate: float
    force: Floats
    responses: Mapping[str, Floats]
    name: str = "tap"
    faults: tuple[str, ...] = field(default=())

    @property
    def velocity(self) -> Floats:
        """Velocity (m/s), where it was measured."""
        return self.responses["velocity"]

    @property
    def pressure(self) -> Floats:
        """Sound pressure (Pa), where it was measured."""
        return self.responses["pressure"]


def cut(rate: float, channels: Mapping[str, Floats], name: str) -> list[Tap]:
    """Cut a recording of one tap or several into taps.

    Channels are ``force`` and responses, each [shape=(samples,)], at a rate (Hz); the name is for
    messages. Raises MeasurementError where there is no hit in it, or something else is measured
    than hammer and response.
    """
    responses = {what: values for what, values in channels.items() if what != "force"}
    if "force" not in channels or not responses:
        raise MeasurementError(f"{name}: a tap needs a force and a response, such as velocity")
    if not all(np.isfinite(values).all() for values in channels.values()):
        raise MeasurementError(f"{name}: holds a number that is not finite")
    force = channels["force"] - np.median(channels["force"])
    hits = _hits(force, rate)
    if not hits:
        raise MeasurementError(f"{name}: no hit of the hammer in its force")
    ends = [*hits[1:], len(force)]
    taps = []
    for i, (hit, end) in enumerate(zip(hits, ends, strict=True)):
        start = max(0, hit - round(BEFORE_S * rate))
        stop = min(end - round(BEFORE_S * rate) if end < len(force) else end,
                   start + round(LONGEST_S * rate))  # fmt: skip
        if stop - hit < SHORTEST_S * rate:
            continue
        own = {what: values[start:stop] for what, values in responses.items()}
        label = name if len(hits) == 1 else f"{name}, tap {i + 1}"
        taps.append(_checked(Tap(rate, force[start:stop], own, label)))
    if not taps:
        raise MeasurementError(f"{name}: ends within {SHORTEST_S * 1e3:g} ms of the hit")
    return taps


def _hits(force: Floats, rate: float) -> list[int]:
    size = np.abs(force)
    peak = size.max(initial=0.0)
    # A hit stands out of the rest, which is noise: by far, since it lasts for a millisecond.
    if peak <= 0.0 or peak < 10.0 * np.sqrt(np.mean(np.sort(size)[: len(size) * 9 // 10] ** 2)):
        return []
    above = np.flatnonzero(size > HIT * peak)
    starts = above[np.diff(above, prepend=-round(rate)) > APART_S * rate]
    return [int(start) for start in starts]


def _checked(tap: Tap) -> Tap:
    """The tap with what is wrong with it."""
    signals = {"force": tap.force, **tap.responses}
    faults = [f"its {what} is clipped" for what in signals if is_clipped(signals[what])]
    if _bounced(tap.force):
        faults.append("the hammer hit twice")
    return replace(tap, faults=tuple(faults))


def is_clipped(values: Floats) -> bool:
    """Whether a signal has a flat top at its largest value, above or below."""
    for signed in (values, -values):
        top = signed.max()
        flat = signed >= top - EQUAL * abs(top)
        near = flat[max(0, int(flat.argmax()) - 1) :][:4096]
        if top > 0.0 and np.convolve(near, np.ones(FLAT)).max() >= FLAT:
            return True
    return False


def pulse(force: Floats) -> tuple[int, int]:
    """The first sample of the first hit, and the first at which the hammer has left again."""
    size = np.abs(force)
    first = int(np.argmax(size > HIT * size.max()))
    left = np.flatnonzero(size[first:] < OVER * size.max())
    return first, first + int(left[0]) if len(left) else len(force)


def _bounced(force: Floats) -> bool:
    size = np.abs(force)
    first, end = pulse(force)
    onset = max(0, first - (end - first))  # where the force rises
    others = np.concatenate([size[:onset], size[end:]])
    noise = 1.4826 * float(np.median(others)) if len(others) else 0.0
    return bool(others.max(initial=0.0) > max(BOUNCE * size.max(), OVER_NOISE * noise))


def read_recording(path: Path, channels: Sequence[Channel] | None) -> list[Tap]:
    """Read the taps of a sound file.

    `channels` says what each is, and how many SI units full scale is. Raises MeasurementError
    where it cannot be read, holds other channels, or no tap.
    """
    import soundfile

    from yehu_server.util.sound_file import opened_sound

    try:
        with opened_sound(path) as file:
            rate = file.samplerate
            if not LOWEST_RATE <= rate <= HIGHEST_RATE or file.frames > LONGEST_FILE_S * rate:
                raise MeasurementError(f"{path}: not a recording of taps: {rate} Hz, or too long")
            count = file.channels
            if channels is None:
                raise MeasurementError(
                    f"{path}: say what its {count} channels are, such as "
                    "--channels force=100,velocity=0.5: their SI units at full scale"
                )
            if len(channels) != count:
                raise MeasurementError(
                    f"{path}: has {count} channels, not {len(channels)} as given"
                )
            if file.frames * count > MAX_SAMPLES:
                raise MeasurementError(
                    f"{path}: has {file.frames * count} samples, more than {MAX_SAMPLES}"
                )
            samples = file.read(dtype="float64", always_2d=True)
    except OSError as error:
        raise MeasurementError(f"{path}: {error_reason(error)}") from error
    except soundfile.LibsndfileError as error:
        raise MeasurementError(f"{path}: not a sound file ({error.error_string})") from error
    return cut(float(rate), by_quantity(channels, samples), path.name)


def write_taps(
    taps: Sequence[Tap], folder: Path, *, overwrite: bool = False
) -> tuple[list[Path], str]:
    """Write a WAV file for each tap.

    Return the files, and what their channels are, as `measurement.read` takes it. Raises
    OutputError where they cannot be written, or are there already.
    """
    import soundfile

    names = [what for what in QUANTITIES if what == "force" or what in taps[0].responses]
    columns = [
        [tap.force if what == "force" else tap.responses[what] for what in names] for tap in taps
    ]
    # Full scale is the next power of two above the largest value: easy to write.
    largest = [max(float(np.abs(row[i]).max()) for row in columns) for i in range(len(names))]
    scales = [2.0 ** math.ceil(math.log2(1.05 * max(peak, 1e-12))) for peak in largest]
    make_folder(folder)
    files = [folder / f"tap{i + 1}.wav" for i in range(len(taps))]
    for file, row, tap in zip(files, columns, taps, strict=True):
        samples = np.stack([values / scale for values, scale in zip(row, scales, strict=True)], 1)
        may_replace = replace_any if overwrite else replace_none
        with replacing(file, may_replace) as partial, partial.open("wb") as stream:
            soundfile.write(stream, samples, round(tap.rate), SUBTYPE, format="WAV")
    channels = ",".join(f"{name}={scale:g}" for name, scale in zip(names, scales, strict=True))
    return files, channels
