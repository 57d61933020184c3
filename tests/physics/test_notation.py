"""docs/notation.md lists every field of the model's records."""

import re
import runpy
from pathlib import Path

import pytest

from yehu_server.core.physics import layout

NOTATION = Path(__file__).parents[2] / "docs" / "notation.md"


def listed(heading: str) -> list[str]:
    """Names in the first column of the table under a heading."""
    text = NOTATION.read_text(encoding="utf-8")
    table = text.split(f"\n## {heading}", 1)[1].split("\n## ", 1)[0]
    cells = re.findall(r"^\| (`[^|]*) \|", table, re.MULTILINE)
    return [name for cell in cells for name in re.findall(r"`(\w+)`", cell)]


@pytest.mark.parametrize(
    ("heading", "record"),
    [
        ("MODEL", layout.MODEL),
        ("STATE: motion", layout.MOTION),
        ("STATE: contacts", layout.CONTACTS),
        ("STATE: work", layout.WORK),
    ],
)
def test_each_field_stands_in_the_notation_once(heading, record):
    assert sorted(listed(heading)) == sorted(record.names)


def test_the_functions_that_the_derivation_names_exist():
    text = (NOTATION.parent / "derivation.md").read_text(encoding="utf-8")
    source = "".join(
        path.read_text(encoding="utf-8")
        for path in sorted((NOTATION.parents[1] / "yehu_server" / "core" / "physics").glob("*.py"))
    )
    named = set(re.findall(r"`([a-z]+_\w+|[a-z]+)`", text)) - {"b"}
    defined = set(re.findall(r"^def (\w+)", source, re.MULTILINE))
    fields = {name for kind in (layout.MODEL, layout.CONTACTS, layout.WORK) for name in kind.names}
    assert named - defined - fields == set()


def test_the_types_of_the_records_are_those_of_the_layout():
    script = runpy.run_path(str(NOTATION.parents[1] / "scripts" / "records.py"))
    assert script["TARGET"].read_text(encoding="utf-8") == script["module"]()
