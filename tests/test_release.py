"""What scripts/release.py refuses, and the metadata that it makes of CITATION.cff."""

from __future__ import annotations

import io
import runpy
import tarfile
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest

from yehu_server import __version__

ROOT = Path(__file__).parents[1]
FOLDERS = ("yehu_server/ahead/shipped/", "yehu_server/compile/shipped/")


@pytest.fixture(scope="module")
def script():
    return SimpleNamespace(**runpy.run_path(str(ROOT / "scripts" / "release.py")))


def test_the_citation_is_of_the_version_of_the_project(script, tmp_path):
    for name in ("CITATION.cff", "pyproject.toml"):
        (tmp_path / name).write_text((ROOT / name).read_text(encoding="utf-8"), encoding="utf-8")
    version = script.read_citation(ROOT)["version"]
    changes = tmp_path / "CHANGELOG.md"
    changes.write_text("# Changes\n\n## Unreleased\n", encoding="utf-8")
    with pytest.raises(script.NotReadyError, match="has no section"):
        script.check_versions(tmp_path)
    changes.write_text(f"# Changes\n\n## {version} (2026-12-01)\n", encoding="utf-8")
    assert script.check_versions(tmp_path) == version
    cited = (tmp_path / "CITATION.cff").read_text(encoding="utf-8")
    (tmp_path / "CITATION.cff").write_text(cited.replace(version, "9.9.9"), encoding="utf-8")
    with pytest.raises(script.NotReadyError, match=r"CITATION.cff is of 9\.9\.9"):
        script.check_versions(tmp_path)


def test_the_program_is_of_the_version_of_the_project(script):
    assert script.check_versions(ROOT) == __version__


def archives(folder, told, names):
    """Both archives of 1.0, with some metadata, the wheel with some files."""
    data = told.encode()
    source, wheel = folder / "yehu_server-1.0.tar.gz", folder / "yehu_server-1.0-py3-none-any.whl"
    with tarfile.open(source, "w:gz") as archive:
        entry = tarfile.TarInfo("yehu_server-1.0/PKG-INFO")
        entry.size = len(data)
        archive.addfile(entry, io.BytesIO(data))
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("yehu_server-1.0.dist-info/METADATA", data)
        for name in names:
            archive.writestr(name, "")
    return source, wheel, "1.0"


WHOLE = (
    "Name: yehu-server\nVersion: 1.0\nDescription-Content-Type: text/markdown\n\n# yehu-server\n"
)
REFUSED = {
    "is of yehu-server 2.0": (WHOLE.replace("1.0", "2.0"), FOLDERS),
    "has no README": (WHOLE.partition("\n\n")[0] + "\n\n", FOLDERS),
    "run scripts/machine_code.py first": (WHOLE, FOLDERS[:1]),
    "run scripts/ship_page.py first": (WHOLE, FOLDERS[1:]),
}


def test_archives_of_a_release_are_of_its_version_and_whole(script, tmp_path):
    script.check_archives(*archives(tmp_path, WHOLE, [f"{folder}x" for folder in FOLDERS]))
    for refusal, (told, folders) in REFUSED.items():
        made = archives(tmp_path, told, [f"{folder}x" for folder in folders])
        with pytest.raises(script.NotReadyError, match=refusal):
            script.check_archives(*made)
