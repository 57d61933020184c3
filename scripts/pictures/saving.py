"""Writes pictures and sounds of the documentation, and prints their size."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import soundfile

ROOT = Path(__file__).resolve().parents[2]
MAX_BYTES = 700_000


def save(figure: Any, path: Path, dpi: int = 90) -> None:
    """Write a figure to a file and print its path."""
    if figure.get_layout_engine() is None:
        figure.tight_layout()
    figure.savefig(path, dpi=dpi)
    plt.close(figure)
    print(path, flush=True)


def save_sound(path: Path, sound: Any, rate: int) -> None:
    """Write a sound to a FLAC file, and print its length and size."""
    soundfile.write(path, sound, rate, subtype="PCM_16", compression_level=1.0)
    size = path.stat().st_size
    much = f"; more than {MAX_BYTES // 1000} kB" if size > MAX_BYTES else ""
    print(f"{path}: {len(sound) / rate:.1f} s, {size // 1000} kB{much}", flush=True)


def levels(energies: Any) -> Any:
    """Decibels of powers, without those of silence."""
    return 10.0 * np.log10(np.maximum(energies, 1e-12))
