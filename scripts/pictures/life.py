"""A held note, a bow change and a plain phrase, as a machine and as hands play them.

life.png has level, spectrogram and pitch of each, and three files their sounds, first still, then
alive. The phrase is that of shi_bei_jiu.mid without its marks: notes alone, all of one velocity.
"""

from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from measures.life import HOP_S, WINDOW_S, pitch_track

import yehu_server as yehu
from pictures.saving import ROOT, levels, save, save_sound
from yehu_server.core.player.note_tables import frequency_hz
from yehu_server.scores.smf.reader import read_score

RATE = 44100
STILL = {"/playing/variation": 0.0, "/bow/noise": 0.0, "/playing/bow_length": 0.0}
REST_S, PHRASE_S = 0.4, 4.5
CENTS, FLOOR_DB = 60.0, 70.0

Notes = list[tuple[float, float, float]]  # pitch, start (s), duration (s)


def phrase() -> Notes:
    """Return the notes of the tune's beginning, none overlapping."""
    tune = read_score(ROOT / "examples" / "shi_bei_jiu.mid")
    notes = [note for note in tune.notes if note.end_s < PHRASE_S]
    starts = [note.start_s for note in notes] + [PHRASE_S]
    return [
        (note.key, start, min(note.end_s, after) - start)
        for note, (start, after) in zip(notes, pairwise(starts), strict=True)
    ]


def sound_of(notes: Notes, *, alive: bool) -> Any:
    """Return the sound of notes, as plain as can be or at the defaults of `render`."""
    settings, phrasing = ({}, 0.5) if alive else (STILL, 0.0)
    played = yehu.render(notes, settings=settings, phrasing=phrasing, dry=True, mono=True)
    return played.sound.astype(float)


def draw(axes: Any, sound: Any, note: int | None) -> None:
    """Draw level, spectrogram and, of a single note, pitch."""
    time = np.arange(len(sound)) / RATE
    window = RATE // 100
    power = np.convolve(sound**2, np.ones(window) / window, "same")
    axes[0].plot(time, levels(power), lw=0.7)
    axes[0].set(ylim=(-20.0 - FLOOR_DB, -10.0), xlim=(0.0, time[-1]))
    axes[1].specgram(
        sound, NFFT=2048, Fs=RATE, noverlap=1536, vmin=-140.0, vmax=-40.0, cmap="magma"
    )
    axes[1].set(ylim=(0.0, 9000.0))
    if note is None:
        axes[2].axis("off")
        return
    cents = pitch_track(sound, RATE, frequency_hz(note, 440.0))
    at = np.arange(len(cents)) * round(HOP_S * RATE) / RATE + WINDOW_S
    axes[2].plot(at, cents, lw=0.8)
    axes[2].set(ylim=(-CENTS / 2.0, CENTS / 2.0), xlabel="s")
    axes[2].grid(alpha=0.3)


def draw_all(figures: Path, sounds: Path) -> None:
    # Notes, the note if it is one, and the part that is drawn and written (s).
    cases: dict[str, tuple[Notes, int | None, tuple[float, float]]] = {
        "held note": ([(74, 0.0, 2.8)], 74, (0.0, 3.2)),
        "bow change": ([(71, 0.0, 6.8)], 71, (4.0, 6.6)),
        "plain phrase": (phrase(), None, (0.0, PHRASE_S + 0.5)),
    }
    figure, panels = plt.subplots(
        3, 2 * len(cases), figsize=(15, 6), layout="constrained", sharey="row"
    )
    for number, (name, (notes, note, part)) in enumerate(cases.items()):
        begin, end = (round(RATE * seconds) for seconds in part)
        still, alive = (sound_of(notes, alive=alive)[begin:end] for alive in (False, True))
        for column, (sound, how) in enumerate(((still, "still"), (alive, "alive"))):
            axes = panels[:, 2 * number + column]
            draw(axes, sound, note)
            axes[0].set_title(f"{name}, {how}")
        both = np.concatenate((still, np.zeros(round(REST_S * RATE)), alive))
        save_sound(sounds / f"{name.replace(' ', '_')}.flac", both, RATE)
    for axes, label in zip(panels[:, 0], ("level, dBFS", "Hz", "pitch, cents"), strict=True):
        axes.set_ylabel(label)
    save(figure, figures / "life.png")
