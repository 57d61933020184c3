"""Scores and notes to sound, as arrays."""

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yehu_server.api.checks import (
    InstrumentLike,
    OutOfRange,
    PathLike,
    get_ready,
    number,
    path_of,
    playing_of,
    rate_of,
    whole,
)
from yehu_server.api.notes import Note, score_of
from yehu_server.api.playback import AudioWidget, Subtype, write_sound
from yehu_server.errors import ParameterError
from yehu_server.playing.mapping import DEFAULT
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.rendering.summary import Summary, summary_of
from yehu_server.rendering.to_files import TruePeak
from yehu_server.scores.phrasing import PHRASING
from yehu_server.scores.reading import ReadOptions, read_any
from yehu_server.scores.score import Score
from yehu_server.util.loudness import IntegratedLoudness

Sound = NDArray[np.float32]
Floats = NDArray[np.float64]

BLOCK = 512  # frames between two readings of the pitch that is asked for; the sound is the same
LONGEST_TAIL_S = 600.0
GAIN_DB = (-60.0, 24.0)


@dataclass(frozen=True)
class Rendering:
    """A sound that was rendered.

    In a notebook it shows itself as a player.

    Attributes
    ----------
    sound : ndarray [shape=(frames, 2) or, in mono, (frames,); float32]
        Left and right; full scale is 1.
    sample_rate : int
        Hz.
    name : str
        Of the score.
    warnings : tuple of str
        What was wrong in the file, or could not be played as written.
    summary : Summary
        Counts and levels, such as ``notes_played`` and ``peak``.
    asked : tuple of ndarray
        Times (s), and the pitch that the player was asked for (fractional MIDI note; NaN in
        silence).
    a4 : float
        Reference pitch (Hz).
    """

    sound: Sound
    sample_rate: int
    name: str
    warnings: tuple[str, ...]
    summary: Summary
    asked: tuple[Floats, Floats]
    a4: float = 440.0

    def __repr__(self) -> str:
        return f"<yehu_server.Rendering of {self.name}, {self.duration:.2f} s>"

    @property
    def duration(self) -> float:
        """How long the sound lasts (s)."""
        return len(self.sound) / self.sample_rate

    def save(self, path: PathLike, *, subtype: Subtype = "24", overwrite: bool = False) -> None:
        """Write a sound file, WAV or FLAC by its ending; it replaces one that this program made.

        Parameters
        ----------
        subtype : "16", "24" or "float"
            Format of the samples.
        overwrite : bool
            Replace any other file that is there, too.

        Raises
        ------
        OutputError
            Where it cannot be written; what was there stays.

        Examples
        --------
        >>> import yehu_server as yehu
        >>> yehu.render([("A4", 0.0, 0.2)]).save("a4.flac")
        """
        write_sound(
            self.sound, self.sample_rate, path_of(path, "path"), subtype, overwrite=overwrite
        )

    def _repr_html_(self) -> str:
        return AudioWidget(self.sound, self.sample_rate)._repr_html_()


def render(
    score: PathLike | Score | Iterable[Note | Sequence[str | float]] | NDArray[Any],
    *,
    sample_rate: float = 44100,
    instrument: InstrumentLike | None = None,
    preset: PathLike | None = None,
    settings: Mapping[str, float] | None = None,
    phrasing: float | None = None,
    rubato: float | None = None,
    dry: bool = False,
    mono: bool = False,
    normalize: bool = False,
    loudness_lufs: float | None = None,
    gain_db: float | None = None,
    tail: float | None = None,
    a4: float = 440.0,
    tuning: PathLike | None = None,
    mapping: PathLike = DEFAULT,
    practice: PathLike | None = None,
    out_of_range: OutOfRange = "transpose",
    channels: Iterable[int] | None = None,
    song: int | None = None,
    part: str | None = None,
    seed: int = 0,
    progress: Callable[[float, float], None] | None = None,
) -> Rendering:
    """Play a score, and return its sound; the same arguments give the same sound.

    ``yehu-server render`` plays ensembles, and writes long sounds to a file as they are played.

    Parameters
    ----------
    score : path, or iterable of notes
        A file of MIDI, MusicXML, ABC or jianpu; or notes: `Note`, rows of pitch, start (s),
        duration (s) and, if wanted, velocity, or an array of such rows; or the ``score`` of
        `follow`.
    sample_rate, instrument, preset, settings, a4, tuning, practice, seed
        As of `Instrument`. Rooms are presets too: ``preset="hall"``.
    phrasing : float
        How much plain notes are shaped, 0 to 1; by default 0.5, as of the command;
        0 for the score of `follow`.
    rubato : float
        Tempo flexibility, 0 to 1; 0 is strict time. By default as `phrasing`. Phrases begin on
        time.
    dry : bool
        Without a room.
    mono : bool
        One channel, the mean of both.
    normalize : bool
        Scale the sound to a true peak of -1 dB of full scale, between the samples too.
    loudness_lufs : float, optional
        Scale the sound to this integrated loudness, -60 to 0, or to that peak if it is quieter.
    gain_db : float, optional
        Gain before the limiter, -60 to 24; by default that of the preset, else 0.
    tail : float, optional
        Seconds after the end of the score; by default until it is quiet, at most 5.
    mapping : str
        What controllers of a MIDI file move: the name of a mapping, or a file.
    out_of_range : "transpose", "clamp" or "skip"
        What happens to notes outside the two octaves from the lower string, F4 to F6 of a yehu.
    channels : iterable of int, optional
        The MIDI channels to play, 1 to 16; by default all but 10.
    song : int, optional
        The song of a file that has several; by default one after another.
    part : str, optional
        The part to play, by its name, the beginning of that, or its number; by default of a written
        score the first, of a MIDI file all.
    progress : callable, optional
        Called with the seconds done and those of the score.

    Returns
    -------
    Rendering

    Raises
    ------
    YehuError
        Where a file cannot be read, or an argument is wrong.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> tune = yehu.render([("A4", 0.0, 0.4), ("C5", 0.4, 0.4, 100)], preset="flautando", dry=True)
    >>> tune.summary.notes_played, tune.sound.ndim
    (2, 2)
    """
    rate = rate_of(sample_rate)
    playing = playing_of(
        instrument,
        preset=preset,
        settings=settings,
        a4=a4,
        tuning=tuning,
        practice=practice,
        seed=seed,
        mapping=mapping,
        out_of_range=out_of_range,
    )
    is_file = isinstance(score, str) or hasattr(score, "__fspath__")
    playing = replace(
        playing,
        channels=_channels(channels),
        phrasing=None if phrasing is None else number(phrasing, "phrasing", 0.0, 1.0),
        rubato=None if rubato is None else number(rubato, "rubato", 0.0, 1.0),
        gain_db=None if gain_db is None else number(gain_db, "gain_db", *GAIN_DB),
    ).shaping(0.0 if isinstance(score, Score) else PHRASING)
    options = Options(
        rate=rate,
        tail_s=None if tail is None else number(tail, "tail", 0.0, LONGEST_TAIL_S),
        normalize=bool(normalize),
        loudness_lufs=None
        if loudness_lufs is None
        else number(loudness_lufs, "loudness_lufs", -60.0, 0.0),
        block=BLOCK,
        is_dry=bool(dry),
        is_mono=bool(mono),
    )
    number_of_song = None if song is None else whole(song, "song", 1, 1 << 16)
    named = () if part is None else (str(part),)
    how = ReadOptions.by(playing, named, all_parts=channels is not None)
    if isinstance(score, Score):
        read = score
    elif is_file:
        read = read_any(path_of(score, "score"), how, song=number_of_song)
    else:
        read = score_of(score)
    whole_part = Part.shaped([read], playing)
    whole_part.check_is_heard()
    get_ready()
    sound, asked, summary = _played(whole_part, options, progress)
    warnings = (*read.remarks, *read.warnings, *summary.remarks())
    return Rendering(sound, rate, read.name, warnings, summary, asked, playing.a4)


def _played(
    part: Part, options: Options, progress: Callable[[float, float], None] | None
) -> tuple[Sound, tuple[Floats, Floats], Summary]:
    """Play a part; return its sound, the pitches that were asked for, and a summary."""
    start = time.perf_counter()
    performance = Performance([part], options)
    blocks, times, pitches, frames = [], [], [], 0
    for samples in performance.blocks(progress):
        blocks.append(samples)
        frames += len(samples)
        [asked] = performance.target_pitches
        times.append(frames / options.rate)
        pitches.append(np.nan if asked is None else asked)
    empty = np.zeros((0,) if options.is_mono else (0, 2), np.float32)
    sound = np.concatenate(blocks) if blocks else empty
    loudness = IntegratedLoudness(options.rate)
    loudness.add(sound)
    factor = 1.0
    if options.is_scaled:
        meter = TruePeak()
        meter.add(sound)
        factor = options.factor(meter.finish(), loudness.lufs())
        sound *= np.float32(factor)
    peak = float(np.abs(sound).max(initial=0.0))
    rms = float(np.sqrt(np.mean(np.square(sound, dtype=np.float64)))) if sound.size else 0.0
    elapsed_s = time.perf_counter() - start
    length_s = frames / options.rate
    levels = peak, rms, loudness.lufs(factor)
    asked_lufs = options.loudness_lufs
    summary = summary_of(
        performance, length_s, elapsed_s, *levels, asked_lufs=asked_lufs, factor=factor
    )
    return sound, (np.array(times), np.array(pitches)), summary


def _channels(channels: Any) -> frozenset[int] | None:
    """Return MIDI channels counted from 0."""
    if channels is None:
        return None
    if isinstance(channels, str) or not isinstance(channels, Iterable):
        raise ParameterError(f"channels: expected numbers, such as [1, 2], got {channels!r}")
    return frozenset(whole(channel, "channels", 1, 16) - 1 for channel in channels)
