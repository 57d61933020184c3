"""What a release refuses, its metadata, its archives, and how its wheel is tried."""

import io
import tarfile
import wave
import zipfile
from pathlib import Path

import pytest
from releases import parts, trials
from releases.citation import NotReadyError, check_versions, read_citation

from yehu_server import __version__
from yehu_server.live.osc.packets import unpack

ROOT = Path(__file__).parents[1]
FOLDERS = tuple(f"{folder.as_posix()}/" for folder in (parts.PAGE, parts.CODE))


def test_the_citation_is_of_the_version_of_the_project(tmp_path):
    for name in ("CITATION.cff", "pyproject.toml"):
        (tmp_path / name).write_text((ROOT / name).read_text(encoding="utf-8"), encoding="utf-8")
    version = read_citation(ROOT)["version"]
    changes = tmp_path / "CHANGELOG.md"
    changes.write_text("# Changes\n\n## Unreleased\n", encoding="utf-8")
    with pytest.raises(NotReadyError, match="has no section"):
        check_versions(tmp_path)
    changes.write_text(f"# Changes\n\n## {version} (2026-12-01)\n", encoding="utf-8")
    assert check_versions(tmp_path) == version
    cited = (tmp_path / "CITATION.cff").read_text(encoding="utf-8")
    (tmp_path / "CITATION.cff").write_text(cited.replace(version, "9.9.9"), encoding="utf-8")
    with pytest.raises(NotReadyError, match=r"CITATION.cff is of 9\.9\.9"):
        check_versions(tmp_path)


def test_the_program_is_of_the_version_of_the_project():
    assert check_versions(ROOT) == __version__


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
    "has nothing in yehu_server/compile/shipped": (WHOLE, FOLDERS[:1]),
    "has nothing in yehu_server/ahead/shipped": (WHOLE, FOLDERS[1:]),
}


def test_archives_of_a_release_are_of_its_version_and_whole(tmp_path):
    parts.check_archives(*archives(tmp_path, WHOLE, [f"{folder}x" for folder in FOLDERS]))
    for refusal, (told, folders) in REFUSED.items():
        made = archives(tmp_path, told, [f"{folder}x" for folder in folders])
        with pytest.raises(NotReadyError, match=refusal):
            parts.check_archives(*made)


def test_every_part_has_a_licence_and_every_file_a_sum(tmp_path):
    (file,) = parts.licences(tmp_path, "1.0")
    lines = [line for line in file.read_text("utf-8").splitlines() if line.startswith("| ")][1:]
    named = {line.split()[1] for line in lines}
    assert {"numba", "numpy", "mido", "aiohttp"} <= named
    assert [line for line in lines if line.endswith("| ? |")] == []
    (tmp_path / "page").mkdir()
    (sums,) = parts.sums(tmp_path, "1.0")
    assert [line.split("  ")[1] for line in sums.read_text().splitlines()] == ["PARTS.md"]


def test_the_same_files_give_the_same_archive(tmp_path):
    (tmp_path / "a" / "b").mkdir(parents=True)
    (tmp_path / "a" / "b" / "c.txt").write_text("c")
    packed = [
        parts.pack(tmp_path / "a", tmp_path / f"{n}.zip", "top", {"LICENSE": ROOT / "LICENSE"})
        for n in range(2)
    ]
    assert packed[0].read_bytes() == packed[1].read_bytes()
    assert zipfile.ZipFile(packed[0]).namelist() == ["top/LICENSE", "top/b/c.txt"]


# ---------------------------------------------------------------- trials


def test_a_trial_sends_osc_as_it_is_defined():
    (message,) = unpack(trials._message("/yehu/note", 69.0, 90.0))
    assert (message.address, list(message.arguments)) == ("/yehu/note", [69.0, 90.0])


def test_a_trial_tells_a_silent_file(tmp_path):
    for name, sample in (("silent", b"\0\0"), ("heard", b"\1\2")):
        with wave.open(str(tmp_path / name), "wb") as file:
            file.setparams((1, 2, 8000, 0, "NONE", ""))
            file.writeframes(sample * 100)
    trials._heard(tmp_path / "heard")
    with pytest.raises(trials.TrialError, match="silent is silent"):
        trials._heard(tmp_path / "silent")


def test_a_python_that_is_not_here_is_named_and_no_failure(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(trials, "VERSIONS", ("9.9",))
    assert trials.main([str(tmp_path / "x.whl")]) == 0
    assert "Python 9.9: installs: not tried: there is no Python 9.9 here" in capsys.readouterr().out


def test_a_wheel_that_cannot_be_installed_is_a_failure(tmp_path, capsys):
    program = tmp_path / "python"
    program.write_text("#!/bin/sh\necho nothing fits >&2\nexit 1\n")
    program.chmod(0o755)
    assert trials.main([str(tmp_path / "x.whl"), str(program)]) == 1
    assert "installs: FAILED: python: nothing fits" in capsys.readouterr().out
