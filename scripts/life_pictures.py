"""Draw and write a held note, a bow change and a plain phrase, as a machine and as hands play them.

    .venv/bin/python scripts/life_pictures.py [-o FOLDER]

Writes life.png (level, spectrogram and pitch of each) and three sounds, first still, then alive.
The phrase is that of shi_bei_jiu.mid without its marks: notes alone, all of one velocity.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import soundfile
from figures import save
from measures.life import HOP_S, WINDOW_S, pitch_track

from yehu_server.core.player.calibration import frequency_hz
from yehu_server.playing.style import Style
from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.phrasing import phrased
from yehu_server.scores.score import Score, ScoreEvent, notes_of
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parent.parent
RATE = 44100
STILL = (("/playing/variation", 0.0), ("/bow/noise", 0.0), ("/playing/bow_length", 0.0))
REST_S, PHRASE_S, PHRASING = 0.4, 4.5, 0.5
MOST_BYTES = 300_000
CENTS, FLOOR_DB = 60.0, 70.0


def bare(score: Score, seconds: float) -> Score:
    """Return the notes of a score's beginning alone, none overlapping, all of one velocity."""
    notes = [note for note in notes_of(score) if note.end_s < seconds]
    starts = [after.start_s for _, after in pairwise(notes)] + [seconds]
    events = []
    for note, next_s in zip(notes, starts, strict=True):
        on, off = score.events[note.begins], score.events[note.ends]
        events.append(replace(on, message=on.message.copy(velocity=80)))
        events.append(replace(off, time_s=min(note.end_s, next_s)))
    events.sort(key=lambda event: (event.time_s, event.message.type == "note_on"))
    return replace(score, events=tuple(events), duration_s=seconds)


def held(note: int, seconds: float) -> Score:
    """Return a score of one note."""
    from mido import Message

    on = ScoreEvent(0.0, Message("note_on", note=note, velocity=80), 0.0)
    off = ScoreEvent(seconds, Message("note_off", note=note), 2.0 * seconds)
    return Score((on, off), seconds)


def sound_of(score: Score, *, alive: bool) -> Any:
    """Return the sound of a score, as plain as can be or at the defaults of `render`."""
    style = Style() if alive else Style(settings=STILL)
    amount = PHRASING if alive else 0.0
    options = Options(rate=RATE, style=style, phrasing=amount, is_dry=True, is_mono=True)
    performance = Performance(phrased(score, amount), options)
    return np.concatenate(list(performance.blocks())).astype(float)


def draw(axes: Any, sound: Any, note: int | None) -> None:
    """Draw level, spectrogram and, of a single note, pitch."""
    time = np.arange(len(sound)) / RATE
    window = RATE // 100
    power = np.convolve(sound**2, np.ones(window) / window, "same")
    axes[0].plot(time, 10.0 * np.log10(power + 1e-9), lw=0.7)
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


def main() -> None:
    """Parse the command line, draw and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(), metavar="FOLDER")
    folder = parser.parse_args().output
    tune = read_score(ROOT / "examples" / "shi_bei_jiu.mid")
    # Score, its note if it is one, and the part that is drawn and written (s).
    cases: dict[str, tuple[Score, int | None, tuple[float, float]]] = {
        "held note": (held(74, 2.8), 74, (0.0, 3.2)),
        "bow change": (held(71, 6.8), 71, (4.0, 6.6)),
        "plain phrase": (bare(tune, PHRASE_S), None, (0.0, PHRASE_S + 0.5)),
    }
    figure, panels = plt.subplots(
        3, 2 * len(cases), figsize=(15, 6), layout="constrained", sharey="row"
    )
    for number, (name, (score, note, part)) in enumerate(cases.items()):
        begin, end = (round(RATE * seconds) for seconds in part)
        still, alive = (sound_of(score, alive=alive)[begin:end] for alive in (False, True))
        for column, (sound, how) in enumerate(((still, "still"), (alive, "alive"))):
            axes = panels[:, 2 * number + column]
            draw(axes, sound, note)
            axes[0].set_title(f"{name}, {how}")
        both = np.concatenate((still, np.zeros(round(REST_S * RATE)), alive))
        path = folder / f"{name.replace(' ', '_')}.flac"
        soundfile.write(path, both, RATE, subtype="PCM_16")
        size = path.stat().st_size
        print(f"{path}: {len(both) / RATE:.1f} s, {size // 1000} kB")
        if size > MOST_BYTES:
            print(f"{path} is larger than {MOST_BYTES // 1000} kB")
    for axes, label in zip(panels[:, 0], ("level, dBFS", "Hz", "pitch, cents"), strict=True):
        axes.set_ylabel(label)
    save(figure, folder / "life.png")


if __name__ == "__main__":
    main()
