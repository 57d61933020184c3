"""Build the plug-in for all systems, and pack an archive for each.

    .venv/bin/python scripts/plugin_archives.py FOLDER

It needs zig: `pip install ziglang`. The same sources give the same archives.
"""

from __future__ import annotations

import sys
import tempfile
import zipfile
from pathlib import Path

from yehu_server.errors import YehuError
from yehu_server.plugin.build import build
from yehu_server.plugin.targets import ALL, NAMES
from yehu_server.util import __version__

EARLIEST = (1980, 1, 1, 0, 0, 0)  # that an archive can state
EXECUTABLE = 0o755 << 16


def main(folder: Path) -> None:
    """Write yehu-VERSION-SYSTEM.zip for each system."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        build(Path(scratch), ALL)
        for name in NAMES:
            archive = folder / f"yehu-{__version__}-{name}.zip"
            pack(Path(scratch) / name, archive)
            print(f"{archive}: {archive.stat().st_size} bytes")


def pack(folder: Path, archive: Path) -> None:
    """Pack all files of a folder, in order, with the page on what to do with them."""
    root = Path(__file__).parents[1]
    files = {str(file.relative_to(folder)): file for file in folder.rglob("*") if file.is_file()}
    files |= {"README.md": root / "docs" / "plugin.md", "LICENSE": root / "LICENSE"}
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, file in sorted(files.items()):
            entry = zipfile.ZipInfo(f"Yehu/{name}", EARLIEST)
            entry.external_attr, entry.compress_type = EXECUTABLE, zipfile.ZIP_DEFLATED
            packed.writestr(entry, file.read_bytes())


if __name__ == "__main__":
    try:
        main(Path(sys.argv[1]))
    except (YehuError, IndexError) as error:
        sys.exit(str(error))
