"""``yehu-server surfaces``, and the files that are shipped."""

import subprocess
import sys

from yehu_server.surfaces.catalogue import SURFACES
from yehu_server.util.files import shipped_folder

NAMES = [surface.name for surface in SURFACES]


def test_all_are_written_and_fresh_over_older_ones(tmp_path, command):
    folder = tmp_path / "new" / "panels"
    code, out, _ = command("surfaces", "-o", folder)
    assert code == 0
    assert sorted(path.name for path in folder.iterdir()) == sorted(NAMES)
    assert all(str(folder / name) in out for name in NAMES)
    (folder / NAMES[0]).write_bytes(b"old")
    assert command("surfaces", "-o", folder, "--only", NAMES[0])[0] == 0
    assert command("surfaces", "-o", folder, "--check")[0] == 0


def test_a_stale_file_is_named_and_the_code_is_1(tmp_path, command):
    for name in NAMES:
        path = tmp_path / name
        data = (shipped_folder("mappings") / name).read_bytes()  # which is fresh
        for harmed in (None, data + b" ", data[:-9]):
            if harmed is not None:
                path.write_bytes(harmed)
            code, out, _ = command("surfaces", "-o", tmp_path, "--only", name, "--check")
            assert (code, str(path) in out) == (1, True)
            assert path.exists() == (harmed is not None)


def test_the_server_is_in_what_speaks_to_it(tmp_path, command):
    assert command("surfaces", "-o", tmp_path, "--server", "10.0.0.7:9123")[0] == 0
    assert "connect 10.0.0.7 9123" in (tmp_path / "yehu.pd").read_text()
    assert "udpsend 10.0.0.7 9123" in (tmp_path / "yehu.maxpat").read_text()
    assert "10.0.0.7:9123" in (tmp_path / "open-stage-control.json").read_text()
    assert command("surfaces", "-o", tmp_path, "--only", "yehu.pd", "--check")[0] == 1


def test_a_wrong_word_is_refused_and_nothing_written(refused, tmp_path):
    (tmp_path / "file").write_text("mine")
    for words, reason in (
        (("--only", "yehu.amxd"), "no surface 'yehu.amxd'; there are yehu.tosc"),
        (("--server", "here:there"), "expected HOST:PORT"),
        (("--server", "foo"), "expected HOST:PORT"),
        (("--server", "http://10.0.0.7:9000"), "expected HOST:PORT"),
        (("--server", "a b:9000"), "expected HOST:PORT"),
        *(
            (("--part", part), f"--part {part}: a stage has parts 1 to 16")
            for part in ("0", "17", "-1")
        ),
    ):
        assert reason in refused("surfaces", "-o", tmp_path / "panels", *words)
        assert not (tmp_path / "panels").exists()
    assert str(tmp_path / "file") in refused("surfaces", "-o", tmp_path / "file")
    assert (tmp_path / "file").read_text() == "mine"


def test_the_libraries_load_only_for_this_command():
    code = (
        "import sys; from yehu_server import cli; import yehu_server.live; cli._parser();"
        "sys.exit(bool({'py2tosc', 'py2max'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
