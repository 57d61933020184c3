"""docs/notation.md lists every field of the model's records."""

import re
from pathlib import Path

import pytest

from yehu_server.core.physics import layout, modal_string, planes

NOTATION = Path(__file__).parents[3] / "docs" / "notation.md"


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
        ("REFINED", layout.REFINED),
        ("PLANES", planes.PLANES),
        ("MODAL", modal_string.MODAL),
    ],
)
def test_each_field_stands_in_the_notation_once(heading, record):
    assert sorted(listed(heading)) == sorted(record.names)
