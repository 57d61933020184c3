"""Draw the pictures of the documentation again, and write the sounds that belong to them.

    .venv/bin/python scripts/figures.py [NAME...] [-o FOLDER]

paper      Figures 2 to 6 of the paper from this model, as its notebook draws them, and that of the
           site's home.
body       A body that was fitted to taps, and how an instrument with another body sounds.
rooms      How the rooms of the presets answer an impulse.
ensemble   The beginning of examples/mo_li_hua.mid: four yehus on a stage.
followed   A hummed tune, and what is played of it.
life       A held note, a bow change and a plain phrase, as a machine and as hands play them.
articulations  Every articulation on one note.
brilliance How bright nine notes are from soft to hard.
schelleng  Where the model can be bowed, and the forces by which the player bows it.
playability  Schelleng's diagrams of all notes, and the forces that keep and start them.

Without names it draws all, in some minutes. Pictures go to FOLDER/figures and
sounds to FOLDER/sounds (default: docs).
"""

import argparse
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

from pictures import (
    articulations,
    body,
    brilliance,
    ensemble,
    followed,
    life,
    paper,
    playability,
    rooms,
    schelleng,
)

ROOT = Path(__file__).resolve().parent.parent
ALL = {
    module.__name__.rpartition(".")[2]: module.draw_all
    for module in (
        *(paper, body, rooms, ensemble, followed, life),
        *(articulations, brilliance, schelleng, playability),
    )
}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", choices=[*ALL, "all"], metavar="NAME", default="all")
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER", default=ROOT / "docs")
    arguments = parser.parse_args()
    figures, sounds = (arguments.output / name for name in ("figures", "sounds"))
    for folder in (figures, sounds):
        folder.mkdir(parents=True, exist_ok=True)
    for name in ALL if "all" in arguments.names else arguments.names:
        ALL[name](figures, sounds)


if __name__ == "__main__":
    main()
