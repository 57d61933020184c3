"""Write docs/parameters.md from the parameter table.

.venv/bin/python scripts/parameters.py
"""

from __future__ import annotations

from pathlib import Path

from yehu_server.params.spec import Place
from yehu_server.params.table import PREFIX, TABLE

TARGET = Path(__file__).resolve().parent.parent / "docs" / "parameters.md"


def page() -> str:
    """Return the text of the page."""
    lines = [
        "# Parameters",
        "",
        "Every parameter of the instrument: its address, range and default, and what it does.",
        "`scripts/parameters.py` writes this page from `yehu_server/params/table.py`.",
        "",
        (
            "`--set ADDRESS=VALUE` of `render` and `serve` holds any of them; "
            f"OSC sets them at `{PREFIX}`"
        ),
        "and their address; mappings move those under `/playing`.",
        "",
        "*Press* is always a finger on the string, in newtons. *Pressure* is the bow on the",
        "string, for its speed; its *force* is the same in newtons. What MIDI calls pressure is",
        "*aftertouch* here, but for the names of its sources in mappings. `/playing/release` is a",
        f"time; the call `{PREFIX}/release` gives back what you took over.",
    ]
    for place, title in (
        (Place.PLAYER, "Parameters of the player"),
        (Place.ENGINE, "Parameters of the engine, moved by the player or by you"),
    ):
        lines += ["", f"## {title}", "", "| address | symbol | range | default | what |"]
        lines.append("|---|---|---|---|---|")
        for param in TABLE:
            if param.place is place:
                symbol = param.symbol.replace("|", "\\|")
                lines.append(
                    f"| `{param.address}` | {symbol} | {param.range_text} | {param.default:g} "
                    f"| {param.doc} |"
                )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    TARGET.write_text(page(), encoding="utf-8")
