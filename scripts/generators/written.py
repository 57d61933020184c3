"""Each file that is written from other files, with the bytes it should have."""

import json
from collections.abc import Iterator
from pathlib import Path

from generators.model_records import records
from generators.page_tables import ROOT
from generators.pages import page
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.live.network import OSC_ADDRESS
from yehu_server.live.page.examples import examples
from yehu_server.live.page.facts import facts, module
from yehu_server.playing.calibration import calibration_key
from yehu_server.playing.calibration_store import SHIPPED as CALIBRATIONS
from yehu_server.plugin.carried import carried
from yehu_server.plugin.parameters import parameters
from yehu_server.surfaces.catalogue import SURFACES, is_up_to_date

PAGES = (
    "*.md",
    "docs/**/*.md",
    "bench/results/*.md",
    *(f"{folder}/*.md" for folder in ("mappings", "presets", "tunings")),
)
RECORDS = ROOT / "yehu_server" / "core" / "physics" / "records.py"
NUMBERS = ROOT / "tests" / "plugin" / "numbers.txt"


def written() -> Iterator[tuple[Path, bytes]]:
    """Yield each file of the repository that has something written, and what it should be."""
    yield RECORDS, records().encode()
    for pattern in PAGES:
        for path in sorted(ROOT.glob(pattern)):
            text = path.read_text(encoding="utf-8")
            if "<!-- table " in text or "<!--=" in text:
                yield path, page(text).encode()
    for surface in SURFACES:
        path = ROOT / "mappings" / surface.name
        is_fresh = is_up_to_date(surface, path.parent)  # an archive may differ by its packer alone
        yield path, path.read_bytes() if is_fresh else surface.make(OSC_ADDRESS)
    yield CALIBRATIONS, calibrations().encode()
    yield NUMBERS, numbers().encode()


def for_the_page() -> Iterator[tuple[Path, bytes]]:
    """Yield the modules of the page, which git ignores."""
    yield ROOT / "web" / "facts.js", module(facts()).encode()
    yield ROOT / "web" / "examples.js", module(examples()).encode()


def calibrations() -> str:
    """The stored calibrations under the keys of the code that there is now."""
    kept = json.loads(CALIBRATIONS.read_text(encoding="utf-8")).values()
    keyed = {calibration_key(data["rate"], Quantities(), 440.0): data for data in kept}
    return json.dumps(keyed, indent=1) + "\n"


def numbers() -> str:
    """The numbers by which hosts know parameters: those there are stay, new ones come last."""
    kept = NUMBERS.read_text(encoding="utf-8")
    known = {line.split()[0] for line in kept.splitlines()}
    new = [each for each in parameters(carried()) if each.address not in known]
    return kept + "".join(f"{each.address} {each.number}\n" for each in new)
