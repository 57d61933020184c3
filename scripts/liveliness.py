"""Measure whether notes live: how they move once they have begun, beside the range of recordings.

    .venv/bin/python scripts/liveliness.py [--seed N] [--set held-out] [--dry]
        [--phrasing VALUE] [--json FILE]
    .venv/bin/python scripts/liveliness.py SOUND...

Without sounds it plays pieces, dry and in the first room: files without expression and with it,
written music with marks, and takes played live, of which no length is known. `measures/motion.py`
says what each figure is. The range is that of recordings of violins, cellos and an erhu.
"""

import argparse
import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import soundfile
from measures.motion import motion

import yehu_server as yehu
from yehu_server.playing.options import LIVE
from yehu_server.scores.phrasing import PHRASING
from yehu_server.scores.reading import read_any

EXAMPLES = Path(__file__).parents[1] / "examples"
RATE = 44100
# Figure: name, aim dry, aim in the room, range of recordings.
FIGURES = {
    "partials": ("partials' motion, dB", "2.3 or more", "2.5 to 4.5", "2.3 to 4.5"),
    "level": ("level's motion, dB", "1.1 or more", "1.1 or more", "1.1 to 3.4"),
    "swell": ("swell, dB", "4 to 7", "4 to 7", "1.5 to 11"),
    "pitch": ("plain notes' pitch, cents", "3 to 5", "3 to 5", "1.8 to 13"),
    "off": ("their distance from the key, cents", "5 or less", "5 or less", ""),
    "drift": ("slow drift, cents", "2.3 to 4", "2.3 to 4", "2.3 to 5.2"),
    "steps": ("steps over 60 ms, share", "0.06 to 0.2", "0.06 to 0.2", "0.06 to 0.25"),
    "dip": ("dip between notes, 90 %, dB", "13 or less", "13 or less", "5 to 15"),
    "dynamics": ("dynamics, 5 to 95 %, dB", "18 to 25 marked", "18 to 25 marked", "10 to 27"),
}
PIECES = {
    "usual": (
        *("mo_li_hua.mid", "slow_air.mid", "shi_bei_jiu.jianpu", "tunes/song_bie.jianpu"),
        *("tunes/amazing_grace.jianpu", "phrases/lan_hua_hua.jianpu", "live tunes/song_bie.jianpu"),
        "live tunes/silent_night.jianpu",
    ),
    "held-out": (
        *("mpe_phrase.mid", "shi_bei_jiu.mid", "tunes/auld_lang_syne.jianpu"),
        *("tunes/sakura.jianpu", "tunes/silent_night.jianpu", "phrases/zi_zhu_diao.jianpu"),
        *("phrases/xiu_he_bao.jianpu", "live phrases/meng_jiang_nv.jianpu"),
    ),
}
LONGEST_S = 20.0  # of a piece


def rendered(name: str, seed: int, *, dry: bool, **how: Any) -> Any:
    """The sound of a file, one channel."""
    whole = read_any(EXAMPLES / name)
    events = whole.events.where(whole.events.time_s < LONGEST_S)
    score = replace(whole, events=events, duration_s=min(whole.duration_s, LONGEST_S))
    mapping = MAPPINGS.get(name, "keyboard")
    how = {"phrasing": PHRASING, "mapping": mapping, "seed": seed, **how}
    return yehu.render(score, dry=dry, mono=True, tail=0.5, **how).sound


MAPPINGS = {"mpe_phrase.mid": "mpe", "slow_air.mid": "keyboard-expressive"}


def played_live(name: str, seed: int, *, dry: bool, phrasing: float | None = None) -> Any:
    """A take of a tune's notes, as a keyboard sends them to the live instrument's first sound."""
    settings = LIVE if phrasing is None else {**LIVE, "/playing/phrasing": phrasing}
    preset = "vibrato" if dry else "vibrato+study"
    player = yehu.Instrument(RATE, preset=preset, settings=settings, stereo=not dry, seed=seed)
    notes = [note for note in read_any(EXAMPLES / name).notes if note.end_s < LONGEST_S]
    for note in notes:
        player.note_on(note.key, velocity=80, at=note.start_s)
        player.note_off(note.key, at=note.end_s - 0.01)
    sound = player.play(notes[-1].end_s + 1.0)
    return sound if dry else sound.mean(axis=1)


def table(
    names: Sequence[str], sound_of: Callable[[str, bool], Any], *, is_dry: bool
) -> dict[str, Any]:
    """Print the figures of each piece, and their medians, dry and, unless `is_dry`, in the room."""
    found: dict[str, Any] = {}
    for dry in (True,) if is_dry else (True, False):
        where = "dry" if dry else "room"
        rows = {}
        for name in names:
            rows[name] = motion(sound_of(name, dry)[: round(LONGEST_S * RATE)], RATE)
            print(f"{where} {name}: {line(rows[name])}", flush=True)
        middle = {key: float(np.nanmedian([row[key] for row in rows.values()])) for key in FIGURES}
        found[where] = {**rows, "median": middle}
    aim = "aim"
    print(f"{'':36}{''.join(f'{where:>7} {aim:16}' for where in found)}recordings")
    for key, (words, *aims, range_) in FIGURES.items():
        values = (each["median"][key] for each in found.values())
        both = (f"{value:7.2f} {aim:16}" for value, aim in zip(values, aims, strict=False))
        print(f"{words:36}{''.join(both)}{range_}")
    return found


def line(row: dict[str, float]) -> str:
    """The figures of a sound in one line."""
    return ", ".join(f"{key} {value:.2f}" for key, value in row.items())


def main() -> None:
    """Measure the sounds of the command line, or play the pieces."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("sounds", nargs="*", type=Path)
    parser.add_argument("--set", choices=PIECES, default="usual", help="of pieces")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--dry", action="store_true", help="without the room")
    parser.add_argument("--phrasing", type=float, help="of all pieces (default: as they come)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures to this file")
    arguments = parser.parse_args()
    if arguments.sounds:
        for path in arguments.sounds:
            sound, rate = soundfile.read(path, always_2d=True)
            print(f"{path.name}: {line(motion(sound.mean(axis=1), rate))}", flush=True)
        return
    how = {} if arguments.phrasing is None else {"phrasing": arguments.phrasing}

    def sound_of(name: str, dry: bool) -> Any:
        if name.startswith("live "):
            return played_live(name.removeprefix("live "), arguments.seed, dry=dry, **how)
        return rendered(name, arguments.seed, dry=dry, **how)

    found = table(PIECES[arguments.set], sound_of, is_dry=arguments.dry)
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
