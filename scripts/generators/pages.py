"""Pages with the tables and figures that the code has now.

A table stands between `<!-- table NAME -->` and `<!-- end -->`. A figure of a sentence stands
behind `<!--=CONSTANT-->` or `<!--=CONSTANT:UNIT-->`: a constant by its path in yehu_server, such as
`playing.delay.HANDLING_MS`, in a unit of UNITS where that is another than its own.
"""

import re
from collections.abc import Callable
from importlib import import_module

from generators.page_tables import TABLES

UNITS: dict[str, Callable[[float], float]] = {
    "kB": lambda value: value / 1024,
    "MB": lambda value: value / 1024**2,
    "ms": lambda value: 1e3 * value,
    "percent": lambda value: 100.0 * value,
    "a_second": lambda value: 1.0 / value,
    "part": lambda value: 1.0 / value,
}
_TABLE = re.compile(r"(<!-- table ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
_FIGURE = re.compile(r"(<!--=([\w.]+?)\.(\w+)(?::(\w+))?-->)(?:\d[\d,.]*\d|\d)?")


def figure(module: str, name: str, unit: str | None) -> str:
    value = getattr(import_module(f"yehu_server.{module}"), name)
    if unit:
        value = UNITS[unit](value)
    return f"{value:,.10g}" if value >= 10000 else f"{value:.10g}"


def page(text: str) -> str:
    """Return a page with the tables and figures that the code has now."""
    if lost := re.search(r"^\s*<!--=.*", text, re.MULTILINE):
        raise ValueError(f"{lost[0]}: at the start of a line, Markdown ends the paragraph there")
    text = _TABLE.sub(lambda found: f"{found[1]}\n{TABLES[found[2]]()}\n\n{found[3]}", text)
    return _FIGURE.sub(lambda found: found[1] + figure(*found.group(2, 3, 4)), text)
