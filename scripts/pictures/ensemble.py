"""The beginning of examples/mo_li_hua.mid: four yehus on a stage.

ensemble.png has the spectrogram of the mix, and the pitch of each part by its stem over the notes
of the score; ensemble.flac is the sound.
"""

import tempfile
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import soundfile

import yehu_server as yehu
from pictures.saving import ROOT, save, save_sound
from yehu_server.cli import main as command
from yehu_server.scores.reading import part_of
from yehu_server.scores.smf.reader import read_score

SCORE = ROOT / "examples" / "mo_li_hua.mid"
NAMES = ("plain", "with flowers", "its bones", "an octave higher")
RATE = 32000  # keeps the file small
SHOWN_S, FADE_S = 12.0, 0.5  # almost two phrases


def rendered(folder: Path) -> tuple[Any, list[Any]]:
    """Return the mix [shape=(frames, 2)] and the stems of the parts [shape=(frames,)]."""
    mix = folder / "mix.wav"
    words = ["--ensemble", "--rubato", "0", "--rate", str(RATE), "--subtype", "float", "--quiet"]
    if command(["render", str(SCORE), "-o", str(mix), "--stems", str(folder / "s"), *words]):
        raise SystemExit(1)
    stems = sorted((folder / "s").glob("[0-9]*.wav"))
    return soundfile.read(mix)[0], [soundfile.read(stem)[0].mean(axis=1) for stem in stems]


def draw_all(figures: Path, sounds: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        mix, stems = rendered(Path(folder))
    end = round(SHOWN_S * RATE)
    figure, (top, *rows) = plt.subplots(
        1 + len(NAMES), 1, figsize=(11, 9), layout="constrained", sharex=True,
        height_ratios=(3, *(1 for _ in NAMES)),
    )  # fmt: skip
    yehu.plot.spectrogram(mix[:end], RATE, pitch=False, top_hz=6000.0, ax=top)
    score = read_score(SCORE)
    for channel, (name, stem, row) in enumerate(zip(NAMES, stems, rows, strict=True)):
        for note in part_of(score, channel).notes:
            row.plot((note.start_s, note.end_s), (note.key, note.key), c="silver", lw=4)
        yehu.plot.pitch(stem[:end], RATE, ax=row)
        row.get_legend().remove()
        row.set(xlim=(0, SHOWN_S), xlabel="", ylim=(63, 91), yticks=(65, 77, 89), ylabel=name)
    rows[-1].set_xlabel("s")
    save(figure, figures / "ensemble.png")
    fade = np.clip((end - np.arange(end)) / (FADE_S * RATE), 0.0, 1.0)[:, None]
    save_sound(sounds / "ensemble.flac", mix[:end] * fade, RATE)
