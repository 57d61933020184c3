"""Write the page that releases carry: its WebAssembly module, and all files as they are now.

    .venv/bin/python scripts/ship_page.py

A wheel's page takes the module. A checkout of newer sources compiles its own where there is a
linker; where there is none, it shows this page, whole: an older module fits no newer page. Git
keeps no second copy of files that are the same.
"""

from __future__ import annotations

import shutil

from yehu_server.ahead.build import SHIPPED
from yehu_server.live.page.site import write_page


def main() -> None:
    """Write the page anew."""
    folder = SHIPPED.parent
    shutil.rmtree(folder, ignore_errors=True)
    files = write_page(folder)
    size = sum((folder / file).stat().st_size for file in files)
    print(f"{folder}: {len(files)} files, {size} bytes")


if __name__ == "__main__":
    main()
