"""An HTML page that documents every parameter and call; it loads nothing else."""

from collections.abc import Iterable
from html import escape

from yehu_server.live.network import Address
from yehu_server.live.osc.all_calls import CALLS
from yehu_server.live.osc.call import Argument
from yehu_server.params.spec import Param
from yehu_server.params.table import UNIT, offered
from yehu_server.surfaces import common_layout
from yehu_server.surfaces.common_layout import osc_address

STYLE = """\
:root { color-scheme: light dark; --ink: #2b2622; --paper: #fbf8f2; --line: #d9cfbd;
  --accent: #9a5b1f; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #ece4d6; --paper: #1e1a17; --line: #4a4038; --accent: #e0a25f; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 72rem; padding: 1rem; background: var(--paper);
  color: var(--ink); font: 1rem/1.45 system-ui, sans-serif; }
h1, h2 { color: var(--accent); line-height: 1.2; }
input { width: 100%; padding: .6rem; font: inherit; color: inherit; background: transparent;
  border: 1px solid var(--line); border-radius: .4rem; }
table { width: 100%; border-collapse: collapse; }
th, td { padding: .35rem .5rem; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--line); }
code { font-size: .92em; }
td:nth-child(-n+3) { white-space: nowrap; }
[hidden] { display: none; }
@media (max-width: 48rem) {
  thead { display: none; }
  td:nth-child(-n+3) { white-space: normal; overflow-wrap: anywhere; }
  table, tbody, tr, td { display: block; }
  tr { padding: .6rem 0; border-bottom: 1px solid var(--line); }
  td { padding: .1rem 0; border: 0; }
  td[data-head]:not(:empty)::before { content: attr(data-head) ": "; opacity: .65; } }
"""
SCRIPT = """\
const box = document.querySelector('input');
box.addEventListener('input', () => {
  const words = box.value.toLowerCase().split(' ');
  for (const section of document.querySelectorAll('section')) {
    let found = 0;
    for (const row of section.querySelectorAll('tbody tr')) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
      found += !row.hidden;
    }
    section.hidden = !found;
  }
});
"""
HEADS = ("address", "symbol", "range", "unit", "default", "curve", "meaning")
CALL_HEADS = ("address", "arguments", "meaning")


def make(server: Address) -> bytes:
    """Write the page as HTML; it is the same for every server."""
    del server
    sections = [
        _section(group.name, HEADS, map(_row, group.params)) for group in common_layout.groups()
    ]
    calls = [
        (
            _code(osc_address(call.address)),
            ", ".join(map(_argument, call.arguments)),
            escape(call.doc),
        )
        for call in CALLS
    ]
    lines = [
        "<!DOCTYPE html>",
        '<html lang="en">',
        "<head>",
        '<meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{common_layout.with_part('yehu')} parameters</title>",
        f"<style>\n{STYLE}</style>",
        "</head>",
        "<body>",
        f"<h1>{common_layout.with_part('yehu')} parameters</h1>",
        f"<p>Set each at its address, or as 0 to 1 at <code>ADDRESS{UNIT}</code>.</p>",
        '<p><input type="search" aria-label="Search" placeholder="Search"></p>',
        *sections,
        _section("calls", CALL_HEADS, calls),
        f"<script>\n{SCRIPT}</script>",
        "</body>",
        "</html>",
        "",
    ]
    return "\n".join(lines).encode("utf-8")


def _section(title: str, heads: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    head = "".join(f"<th>{name}</th>" for name in heads)
    body = [
        "<tr>"
        + "".join(
            # A phone has room for address and meaning only.
            f"<td>{cell}</td>"
            if name in ("address", "meaning")
            else f'<td data-head="{name}">{cell}</td>'
            for name, cell in zip(heads, row, strict=True)
        )
        + "</tr>"
        for row in rows
    ]
    return "\n".join(
        (
            "<section>",
            f"<h2>{escape(title)}</h2>",
            f"<table><thead><tr>{head}</tr></thead><tbody>",
            *body,
            "</tbody></table>",
            "</section>",
        )
    )


def _row(param: Param) -> tuple[str, ...]:
    unit = "" if param.unit == "1" else param.unit
    return (
        _code(osc_address(param.address)),
        escape(param.symbol),
        f"{param.lo:g} to {offered(param).hi:g}",
        escape(unit),
        f"{param.default:g}",
        param.curve.value,
        escape(param.doc),
    )


def _argument(argument: Argument) -> str:
    within = "" if argument.lo is None else f" {argument.lo:g} to {argument.hi:g}"
    unit = "" if argument.unit == "1" else f" {argument.unit}"
    return escape(f"{argument.name}{within}{unit}")


def _code(text: str) -> str:
    return f"<code>{escape(text)}</code>"
