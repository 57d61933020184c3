"""Draw and write the beginning of examples/mo_li_hua.mid: four yehus on a stage.

    .venv/bin/python scripts/ensemble_picture.py [-o FOLDER]

Writes ensemble.png (the spectrogram of the mix, and the pitch of each part by its stem over the
notes of the score) and ensemble.flac to FOLDER. Prints how far each part is from the pitches of
its notes.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import soundfile
from figures import draw_spectrogram, save

from yehu_server.cli import main as command
from yehu_server.core.player.calibration import frequency_hz
from yehu_server.playing.pitch_and_level import cents, track
from yehu_server.scores.reading import part_of
from yehu_server.scores.score import Score, notes_of
from yehu_server.scores.smf.reader import read_score

SCORE = Path(__file__).resolve().parent.parent / "examples" / "mo_li_hua.mid"
NAMES = ("plain", "with flowers", "its bones", "an octave higher")
RATE = 32000  # keeps the file small
SHOWN_S = 12.0  # almost two phrases
MOST_BYTES = 700_000
IN_TUNE = 50.0  # cents
LEVEL = 0.05  # of a stem's peak, below which its pitch is not shown


def rendered(folder: Path) -> tuple[Any, list[Any]]:
    """Return the mix [shape=(frames, 2)] and the stems of the parts [shape=(frames,)]."""
    mix = folder / "mix.wav"
    words = ["--ensemble", "--rate", str(RATE), "--subtype", "float", "--quiet"]
    if command(["render", str(SCORE), "-o", str(mix), "--stems", str(folder / "s"), *words]):
        raise SystemExit(1)
    stems = sorted((folder / "s").glob("[0-9]*.wav"))
    return soundfile.read(mix)[0], [soundfile.read(stem)[0].mean(axis=1) for stem in stems]


def errors(score: Score, times: Any, pitches: Any) -> list[float]:
    """Return how far the middle of each note is from its pitch (cents), where it has one."""
    found = []
    for note in notes_of(score):
        begin, end = (note.start_s + share * note.length_s for share in (0.4, 0.9))
        heard = pitches[(times >= begin) & (times < end)]
        if np.isfinite(heard).any():
            aim = frequency_hz(note.key, 440.0)
            found.append(cents(float(np.nanmedian(heard)), aim))
    return found


def main() -> None:
    """Parse the command line, draw and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(), metavar="FOLDER")
    output = parser.parse_args().output
    with tempfile.TemporaryDirectory() as folder:
        mix, stems = rendered(Path(folder))
    end = round(SHOWN_S * RATE)
    figure, (top, *rows) = plt.subplots(
        1 + len(NAMES), 1, figsize=(11, 9), layout="constrained", sharex=True,
        height_ratios=(3, *(1 for _ in NAMES)),
    )  # fmt: skip
    draw_spectrogram(top, mix[:end].mean(axis=1), float(RATE))
    score = read_score(SCORE)
    for channel, (name, stem, row) in enumerate(zip(NAMES, stems, rows, strict=True)):
        times, pitches = track(stem, float(RATE))
        windows = [stem[round((at - 0.025) * RATE) :][: round(0.05 * RATE)] for at in times]
        loud = np.array([np.abs(window).max() for window in windows])
        pitches = np.where(loud > LEVEL * np.abs(stem).max(), pitches, math.nan)
        off = np.array(errors(part_of(score, channel), times, pitches))
        near = np.abs(off) < IN_TUNE
        spread = np.percentile(np.abs(off), 90)
        print(
            f"{name}: {len(off)} notes with a pitch, {near.mean():.0%} within {IN_TUNE:g} cents; "
            f"median {np.median(off):+.1f}, 90 % within {spread:.0f}"
        )
        for note in notes_of(part_of(score, channel)):
            row.plot((note.start_s, note.end_s), (note.key, note.key), c="silver", lw=4)
        row.plot(times, 69.0 + 12.0 * np.log2(pitches / 440.0), ".", ms=2)
        row.set(xlim=(0, SHOWN_S), ylim=(63, 91), yticks=(65, 77, 89), ylabel=name)
        row.grid(alpha=0.3)
    rows[-1].set_xlabel("s")
    save(figure, output / "ensemble.png")
    fade = np.clip((end - np.arange(end)) / (0.5 * RATE), 0.0, 1.0)[:, None]
    sound = output / "ensemble.flac"
    soundfile.write(sound, mix[:end] * fade, RATE, subtype="PCM_16", compression_level=1.0)
    size = sound.stat().st_size
    print(f"{sound}: {SHOWN_S:g} s, {size // 1000} kB")
    if size > MOST_BYTES:
        print(f"{sound} is larger than {MOST_BYTES // 1000} kB")


if __name__ == "__main__":
    main()
