"""Pictures of a sound: its level, its pitch, its spectrogram."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.plot.axes import axes_of
from yehu_server.plot.sound_panels import draw_level, draw_pitch, draw_spectrogram
from yehu_server.rendering.plot_data import TOP_HZ, PlotData

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = Any

MIN_PRESSURE = 1e-9  # Pa; silence is not scaled up


def spectrogram(
    sound: Any,
    sample_rate: float | None = None,
    *,
    pitch: bool = True,
    top_hz: float = TOP_HZ,
    ax: Axes | None = None,
) -> Axes:
    """Draw the spectrogram of a sound, with its pitch track.

    Parameters
    ----------
    sound : Rendering, Simulation or ndarray [shape=(frames,) or (frames, 2)]
        Of a simulation, the radiated pressure, scaled to full scale.
    sample_rate : float, optional
        Of an array, in Hz.
    pitch : bool
        Draw the pitch that is heard.
    top_hz : float
        Upper end of the picture, up to 8000 Hz.
    ax : Axes, optional

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where it is no sound, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> tune = yehu.render([("F4", 0.0, 0.3), ("C5", 0.3, 0.3)])
    >>> yehu.plot.spectrogram(tune, top_hz=5000).get_ylabel()
    'kHz'
    """
    data = _drawn(sound, sample_rate)
    axes = axes_of(ax)
    if not (isinstance(top_hz, Real) and 0.0 < top_hz <= TOP_HZ):
        raise ParameterError(f"top_hz: {top_hz} is not within 0 to {TOP_HZ:g} Hz")
    draw_spectrogram(axes, data, has_pitch=pitch)
    axes.set(xlim=(0.0, data.duration_s), ylim=(0.0, 1e-3 * top_hz), xlabel="s")
    return axes


def level(sound: Any, sample_rate: float | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw level and peak of a sound over time.

    Parameters
    ----------
    sound, sample_rate, ax
        As of `spectrogram`.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where it is no sound, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> yehu.plot.level(yehu.render([("A4", 0.0, 0.3)])).get_ylabel()
    'dB of full scale'
    """
    data = _drawn(sound, sample_rate)
    axes = axes_of(ax)
    draw_level(axes, data)
    axes.set(xlim=(0.0, data.duration_s), xlabel="s")
    return axes


def pitch(
    sound: Any, sample_rate: float | None = None, *, a4: float | None = None, ax: Axes | None = None
) -> Axes:
    """Draw the pitch of a sound over time; of a rendering, also what the player was asked for.

    Parameters
    ----------
    sound, sample_rate, ax
        As of `spectrogram`.
    a4 : float, optional
        Reference pitch (Hz); by default that of the rendering, else 440.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where it is no sound, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> yehu.plot.pitch(yehu.render([("F4", 0.0, 0.3), ("A4", 0.3, 0.3)])).get_ylabel()
    'pitch'
    """
    data = _drawn(sound, sample_rate, a4)
    axes = axes_of(ax)
    draw_pitch(axes, data)
    axes.set(xlim=(0.0, data.duration_s), xlabel="s")
    return axes


def _drawn(sound: Any, sample_rate: float | None, a4: float | None = None) -> PlotData:
    """What is drawn of a sound; raises ParameterError where it has nothing to draw."""
    samples, _ = sound_of(sound, sample_rate)
    if not samples.size or not np.isfinite(samples).all():
        raise ParameterError("expected samples, all of them finite numbers")
    return plot_data_of(sound, sample_rate, a4)


def sound_of(sound: Any, sample_rate: float | None = None) -> tuple[Array, float]:
    """Return the samples and the rate (Hz) of what has a sound, as of `spectrogram`.

    Raises ParameterError where it is no sound, or the rate is missing.
    """
    if hasattr(sound, "arrays") and hasattr(sound, "meta"):
        arrays = sound.arrays
        rate = float(sound.meta["sample_rate"])
        return arrays["sound"] if "sound" in arrays else arrays["pressure"], rate
    if hasattr(sound, "sound") and hasattr(sound, "sample_rate"):
        return sound.sound, float(sound.sample_rate)
    try:
        samples = np.asarray(sound)
        is_sound = samples.dtype.kind in "fi" and samples.ndim in (1, 2)
    except ValueError:
        is_sound = False
    if not is_sound:
        raise ParameterError(f"expected a sound: an array or a result, not {type(sound).__name__}")
    if not isinstance(sample_rate, Real) or not sample_rate > 0.0:
        raise ParameterError("sample_rate: an array of sound needs one (Hz)")
    if samples.dtype.kind == "i":
        raise ParameterError("expected a sound with full scale 1, not one of integers")
    if samples.ndim == 2 and samples.shape[1] not in (1, 2):
        raise ParameterError(f"expected a sound of shape (frames, 2), not {samples.shape}")
    return samples, float(sample_rate)


def is_pressure(sound: Any) -> bool:
    """Whether what is heard of a result is pressure (Pa), which has no full scale."""
    return hasattr(sound, "arrays") and "sound" not in sound.arrays


def plot_data_of(
    sound: Any,
    sample_rate: float | None = None,
    a4: float | None = None,
    step_s: float | None = None,
) -> PlotData:
    """Gather what pictures show of a sound; see `sound_of`."""
    samples, rate = sound_of(sound, sample_rate)
    if is_pressure(sound):
        samples = samples / max(float(np.abs(samples).max(initial=0.0)), MIN_PRESSURE)
    a4 = float(getattr(sound, "a4", 440.0) if a4 is None else a4)
    data = PlotData(rate, len(samples) / rate, 1, a4, step_s)
    times, pitches = getattr(sound, "asked", (np.zeros(0), np.zeros(0)))
    begin = 0
    for end, pitch_asked in zip((rate * times).round().astype(int), pitches, strict=True):
        data.take(samples[begin:end], [float(pitch_asked)])
        begin = end
    data.take(samples[begin:], [None])
    data.finish()
    return data
