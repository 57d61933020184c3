"""Write all that is written from other files; `scripts/generate` runs it."""

from generators.page_tables import ROOT
from generators.written import for_the_page, written
from yehu_server.playing.calibration_store import SHIPPED as CALIBRATIONS

if __name__ == "__main__":
    for path, data in (*written(), *for_the_page()):
        there = path.read_bytes() if path.exists() else b""
        if there == data:
            continue
        path.write_bytes(data)
        lines, before = data.splitlines(), there.splitlines()
        added, removed = len(set(lines) - set(before)), len(set(before) - set(lines))
        print(f"{path.relative_to(ROOT)}: {added} lines added, {removed} removed")
        if path == CALIBRATIONS:
            print("  under new keys; where samples change: .venv/bin/python scripts/calibrate.py")
