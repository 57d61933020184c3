"""Write the WebAssembly module that releases carry, and the facts of its sources, beside the code.

    .venv/bin/python scripts/ship_page.py

A checkout of newer sources compiles its own where there is a linker; where there is none, its page
plays this one.
"""

from __future__ import annotations

import shutil

from yehu_server.ahead.build import build
from yehu_server.ahead.kept import SHIPPED
from yehu_server.panel.facts import facts, module
from yehu_server.panel.files import FACTS


def main() -> None:
    """Build and write both files."""
    shutil.rmtree(SHIPPED.parent, ignore_errors=True)
    for path in build("wasm", SHIPPED.parent):
        print(f"{path}: {path.stat().st_size} bytes")
    path = SHIPPED.with_name(FACTS)
    path.write_text(module(facts()), encoding="utf-8")
    print(f"{path}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
