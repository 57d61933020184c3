"""What a data set says of itself: a card for readers (README.md), and its facts (dataset.json)."""

import json
import math
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from yehu_lab.dataset.description import Description
from yehu_lab.dataset.making import Line
from yehu_lab.regimes.columns import REGIMES
from yehu_server.scores.gesture import CONTROLS
from yehu_server.simulation.labels import Label, as_data, label_of
from yehu_server.util import __version__
from yehu_server.util.files import write_text

FORMAT = "yehu-server dataset"
CARD, FACTS = "README.md", "dataset.json"
FOUND = {
    "regime": Label("1", "regime of the string's motion, by its number"),
    "regime_time": Label("s", "time of the regimes"),
    "regime_hop_s": Label("s", "time between two of them"),
    "asked_hz": Label("Hz", "pitch that is fingered"),
}
AUDIO = {"strokes": Label("Pa", "radiated sound pressure"), "notes": Label("1", "of full scale")}


def write_card(folder: Path, description: Description, lines: Sequence[Line]) -> None:
    """Write card and facts, the same for the same sounds. Raises OutputError where it cannot be."""
    facts = facts_of(description, lines)
    write_text(folder / FACTS, json.dumps(facts, indent=1, ensure_ascii=False) + "\n")
    write_text(folder / CARD, card_of(facts))


def facts_of(description: Description, lines: Sequence[Line]) -> dict[str, Any]:
    """All that holds for the whole data set, as JSON values."""
    made = [line for line in lines if "labels" in line]
    signals = {f"signal_{name}": label_of(name) for name in description.signals}
    labels = {name: label_of(name) for name in ("time", *CONTROLS)} | signals | FOUND
    return {
        "format": FORMAT,
        "made_by": f"yehu-server {__version__}",
        "about": description.about,
        "license": description.license,
        "kind": description.kind,
        "seed": description.seed,
        "sample_rate_hz": description.rate,
        "description_sha256": description.key,
        "sounds": len(made),
        "duration_s": round(math.fsum(line["duration_s"] for line in made), 6),
        "splits": dict(sorted(Counter(line["split"] for line in made).items())),
        "commonest_regimes": dict(
            sorted(Counter(line["labels"]["regime"] for line in made).items())
        ),
        "regimes": list(REGIMES),
        "audio": AUDIO[description.kind]._asdict(),
        "arrays": {name: label._asdict() for name, label in labels.items()},
        "instrument": as_data(description.quantities),
        "description": dict(description.data),
    }


def card_of(facts: dict[str, Any]) -> str:
    """The facts for readers, in Markdown, with the licence in front for machines."""
    rows = [
        f"| `{name}` | {each['unit']} | {each['what']} |" for name, each in facts["arrays"].items()
    ]
    splits = ", ".join(f"{count} in `{name}`" for name, count in facts["splits"].items())
    regimes = ", ".join(f"{count} {name}" for name, count in facts["commonest_regimes"].items())
    instrument = facts["instrument"]
    title = facts["about"] or f"{facts['kind'].capitalize()} of a yehu"
    return "\n".join(
        [
            "---",
            f"license: {json.dumps(facts['license'].lower())}",
            "---",
            f"# {title}",
            "",
            f"{facts['sounds']} sounds, {facts['duration_s']:g} s ({splits}), computed by",
            f"{facts['made_by']} from a physical model of the Chinese yehu; no recording is in it.",
            f"By the commonest motion of the string: {regimes}.",
            "",
            f"Licence: {facts['license']}. Seed: {facts['seed']}. The same description, in",
            f"`{FACTS}`, makes the same bytes again with that version on one kind of processor.",
            "",
            f"Sounds are mono WAV at {facts['sample_rate_hz']:g} Hz, 32-bit floats, in",
            f"{facts['audio']['unit']} ({facts['audio']['what']}). `manifest.jsonl` has a line for",
            "each; the `.npz` beside it has these arrays:",
            "",
            "| array | unit | what |",
            "|---|---|---|",
            *rows,
            "",
            f"Torsion of strings: {instrument['torsion']}; width of the hair:",
            f"{1e3 * instrument['bow']['width']:g} mm. What is learned from these sounds holds for",
            "a fiddle as far as the model does.",
            "",
        ]
    )
