"""A voice or a recording, followed: what was heard as arrays, and the performance it becomes."""

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from yehu_server.api.checks import PathLike, number, path_of, whole
from yehu_server.api.rendered import Rendering, render
from yehu_server.errors import ParameterError
from yehu_server.following.frames import HOP_S
from yehu_server.following.heard import hear
from yehu_server.following.notes import midi_of, strokes_of
from yehu_server.following.performance import STYLES, FollowOptions, performed
from yehu_server.following.recording import (
    HIGHEST_RATE,
    LOWEST_RATE,
    recording_of_file,
    recording_of_samples,
)
from yehu_server.params.table import HIGHEST_A4, LOWEST_A4
from yehu_server.playing.tuning import EQUAL, read_tuning
from yehu_server.scores.score import Score

Floats = NDArray[np.float64]
Style = Literal["exact", "gentle", "even"]

MAX_SEMITONES = 60.0


@dataclass(frozen=True)
class Followed:
    """What was heard of a recording, and what is played of it.

    Attributes
    ----------
    times : ndarray [shape=(frames,)]
        Seconds, one each 5 ms.
    pitch : ndarray [shape=(frames,)]
        What was heard (fractional MIDI note at an A4 of 440 Hz); NaN where there is no pitch.
    level : ndarray [shape=(frames,)]
        A-weighted level (dB of full scale).
    onsets : ndarray [shape=(notes,)]
        When notes begin (s).
    transposed : float
        Semitones by which it is played higher.
    score : Score
        The performance.
    warnings : tuple of str
        What makes it unsure.
    """

    times: Floats
    pitch: Floats
    level: Floats
    onsets: Floats
    transposed: float
    score: Score
    warnings: tuple[str, ...]

    def __repr__(self) -> str:
        seconds = len(self.times) * HOP_S
        return f"<yehu_server.Followed, {len(self.onsets)} notes in {seconds:.2f} s>"

    def render(self, **options: Any) -> Rendering:
        """Play it; see `render` for the options."""
        return render(self.score, **options)


def follow(
    recording: PathLike | NDArray[Any],
    sample_rate: float | None = None,
    *,
    transpose: float | None = None,
    correct: float = 0.0,
    keep_vibrato: bool = False,
    style: Style = "exact",
    a4: float = 440.0,
    tuning: PathLike | None = None,
) -> Followed:
    """Listen to a voice, or one instrument, and make a performance of what is heard.

    It needs ``pip install yehu-server[follow]``.

    Parameters
    ----------
    recording : path, or ndarray [shape=(frames,) or (frames, channels)]
        One voice. Integers are scaled by their largest value.
    sample_rate : float, optional
        Of an array (Hz).
    transpose : float, optional
        Semitones; by default by octaves, into the range of the instrument.
    correct : float
        How far notes are moved to the tuning, 0 to 1.
    keep_vibrato : bool
        With `correct`, move notes as they are; else their vibrato and slides get narrower, too.
    style : "exact", "gentle" or "even"
        How much of the loudness and of the attacks is played.
    a4 : float
        Reference pitch (Hz) of what is played, 390 to 480.
    tuning : path, optional
        A Scala scale, or the name of a shipped one; by default equal temperament.

    Returns
    -------
    Followed

    Raises
    ------
    YehuError
        Where it cannot be read, an argument is wrong, or no single voice is heard.

    Examples
    --------
    >>> import numpy as np, yehu_server as yehu
    >>> time = np.arange(24000) / 16000
    >>> partials = [np.sin(2 * np.pi * 220.0 * n * time) / n for n in (1, 2, 3)]
    >>> hum = np.pad(0.25 * np.sum(partials, axis=0), (8000, 0))  # after half a second
    >>> heard = yehu.follow(hum, 16000)
    >>> heard.onsets.round(1).tolist(), heard.transposed, round(float(np.nanmedian(heard.pitch)), 1)
    ([0.5], 12.0, 57.0)
    """
    share = number(correct, "correct", 0.0, 1.0)
    if style not in STYLES:
        raise ParameterError(f"style: {style!r} is not one of {', '.join(STYLES)}")
    wanted = FollowOptions(
        correct=share,
        keeps_vibrato=bool(keep_vibrato),
        style=STYLES[style],
        a4=number(a4, "a4", LOWEST_A4, HIGHEST_A4),
        tuning=EQUAL if tuning is None else read_tuning(path_of(tuning, "tuning")),
    )
    if transpose is not None:
        semitones = number(transpose, "transpose", -MAX_SEMITONES, MAX_SEMITONES)
        wanted = replace(wanted, transpose=semitones)
    if isinstance(recording, str) or hasattr(recording, "__fspath__"):
        source = recording_of_file(path_of(recording, "recording"))
    elif sample_rate is None:
        raise ParameterError("sample_rate: an array needs one, in Hz")
    else:
        rate = whole(sample_rate, "sample_rate", LOWEST_RATE, HIGHEST_RATE)
        source = recording_of_samples(recording, rate)
    heard = hear(source)
    strokes = strokes_of(heard)
    found = performed(heard, strokes, wanted)
    starts = [note.start * HOP_S for stroke in strokes for note in stroke.notes]
    return Followed(
        heard.times_s,
        midi_of(heard.pitch_hz),
        heard.level_db,
        np.array(starts),
        found.semitones,
        found.score,
        heard.warnings,
    )
