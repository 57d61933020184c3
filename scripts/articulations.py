"""Play each articulation at three tempi and dynamics, and measure what is heard of it.

    .venv/bin/python scripts/articulations.py [NAME...] [--other] [--rate HZ] [--save FILE]

Prints each figure beside the range stated for it (measures/articulated.py), the notes that are
wrong and the ranges that are missed. `--other` plays other pitches; `--save` writes
bench/results/articulations.json. The analysis knows when notes begin, how long they are and their
pitches, and no gesture.
"""

import argparse
import json
from pathlib import Path

from measures.articulated import NOTES, OTHER_NOTES, STATED, Found, all_found
from measures.take import Setup

from yehu_server.params.articulations import NUMBER


def figures_of(found: list[Found]) -> dict[str, dict[str, object]]:
    """Figures for the page: of each articulation the range of the medians, and what is wrong."""
    rows: dict[str, dict[str, object]] = {}
    for name, stated in STATED.items():
        own = [each for each in found if each.way.name == name]
        if not own:
            continue
        medians = {
            figure: [each.median[figure] for each in own if each.way.length_s >= least_s]
            for figure, (_, _, least_s) in stated.ranges.items()
        }
        rows[name] = {
            "source": stated.source,
            "figures": {
                figure: {
                    "from": round(min(values), 3),
                    "to": round(max(values), 3),
                    "stated": stated.ranges[figure],
                }
                for figure, values in medians.items()
            },
            "ways": len(own),
            "missed": sum(bool(each.missed) for each in own),
            "wrong": sum(len(each.wrong) for each in own),
            "notes": len(own) * len(NOTES),
        }
    return rows


def line_of(found: Found) -> str:
    """One way of an articulation as a line."""
    way = found.way
    shown = " ".join(f"{name} {found.median[name]:.3g}" for name in STATED[way.name].ranges)
    text = f"{way.name:17} {way.length_s:4} s {way.velocity:3}: {shown}"
    if found.missed:
        text += f"\n    missed: {'; '.join(found.missed)}"
    if found.wrong:
        text += f"\n    wrong: {', '.join(found.wrong)}"
    return text


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", choices=[*NUMBER, []], metavar="NAME")
    parser.add_argument("--other", action="store_true", help="other pitches")
    parser.add_argument("--rate", type=float, default=44100.0, help="Hz")
    parser.add_argument("--variation", type=float, default=0.25)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--save", type=Path, metavar="FILE")
    options = parser.parse_args()
    notes = OTHER_NOTES if options.other else NOTES
    setup = Setup(options.rate, options.variation, options.seed)
    found = all_found(setup, notes, options.names or None)
    for each in found:
        print(line_of(each))
    wrong = sum(len(each.wrong) for each in found)
    missed = sum(bool(each.missed) for each in found)
    print(f"{wrong} of {len(found) * len(notes)} notes wrong; {missed} of {len(found)} ways missed")
    if options.save:
        data = {"figures": figures_of(found)}
        options.save.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
