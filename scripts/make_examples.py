"""Write the scores in examples/.

    .venv/bin/python scripts/make_examples.py [NAME...] [-o FOLDER]

shi_bei_jiu   the traditional tune, phrased for a yehu
mo_li_hua     the traditional tune for four yehus, in heterophony
slow_air      swells (CC 11), late vibrato (CC 1) and slides (CC 65, CC 5), for the mapping
              keyboard-expressive
bow_pressure  from flautando to scratch (CC 71) and from sul tasto to sul ponticello (CC 74), for
              the same mapping
mpe_phrase    pitch bend, pressure and bow position for each note, for the mapping mpe

Everything follows fixed rules: each run writes the same bytes.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from tunes.expressive import bow_pressure, mpe_phrase, slow_air
from tunes.mo_li_hua import mo_li_hua
from tunes.shi_bei_jiu import shi_bei_jiu

FOLDER = Path(__file__).resolve().parent.parent / "examples"
SCORES = {
    make.__name__: make for make in (shi_bei_jiu, mo_li_hua, slow_air, bow_pressure, mpe_phrase)
}

if __name__ == "__main__":
    words = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    words.add_argument("names", nargs="*", choices=[*SCORES, "all"], default="all", metavar="NAME")
    words.add_argument("-o", dest="folder", type=Path, default=FOLDER, help="default: examples")
    asked = words.parse_args()
    for name in SCORES if "all" in asked.names else asked.names:
        SCORES[name]().save(asked.folder / f"{name}.mid")
