"""``yehu-server surfaces``, and the files that are shipped."""

import subprocess
import sys

import pytest

from yehu_server.cli import main
from yehu_server.surfaces.catalogue import SURFACES, is_fresh
from yehu_server.util.files import shipped_folder

NAMES = [surface.name for surface in SURFACES]


@pytest.mark.parametrize("surface", SURFACES, ids=lambda surface: surface.name)
def test_the_shipped_file_is_as_the_table_has_it(surface):
    assert is_fresh(surface, shipped_folder("mappings")), (
        f"mappings/{surface.name} is stale; run: yehu-server surfaces -o mappings"
    )


def test_all_are_written_and_fresh_over_older_ones(tmp_path, capsys):
    folder = tmp_path / "new" / "panels"
    assert main(["surfaces", "-o", str(folder)]) == 0
    out = capsys.readouterr().out
    assert sorted(path.name for path in folder.iterdir()) == sorted(NAMES)
    assert all(str(folder / name) in out for name in NAMES)
    (folder / NAMES[0]).write_bytes(b"old")
    assert main(["surfaces", "-o", str(folder), "--only", NAMES[0]]) == 0
    assert main(["surfaces", "-o", str(folder), "--check"]) == 0
    assert sorted(path.name for path in folder.iterdir()) == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("harm", ["gone", "changed", "cut"])
def test_a_stale_file_is_named_and_the_code_is_1(tmp_path, capsys, name, harm):
    path = tmp_path / name
    data = (shipped_folder("mappings") / name).read_bytes()  # which is fresh
    if harm != "gone":
        path.write_bytes(data + b" " if harm == "changed" else data[:-9])
    assert main(["surfaces", "-o", str(tmp_path), "--only", name, "--check"]) == 1
    assert str(path) in capsys.readouterr().out
    assert path.exists() == (harm != "gone")


def test_only_what_is_named_is_written(tmp_path):
    assert main(["surfaces", "-o", str(tmp_path), "--only", "yehu.pd"]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["yehu.pd"]


def test_the_server_is_in_what_speaks_to_it(tmp_path):
    assert main(["surfaces", "-o", str(tmp_path), "--server", "10.0.0.7:9123"]) == 0
    assert "connect 10.0.0.7 9123" in (tmp_path / "yehu.pd").read_text()
    assert "udpsend 10.0.0.7 9123" in (tmp_path / "yehu.maxpat").read_text()
    assert "10.0.0.7:9123" in (tmp_path / "open-stage-control.json").read_text()
    assert main(["surfaces", "-o", str(tmp_path), "--only", "yehu.pd", "--check"]) == 1


@pytest.mark.parametrize("server", ["10.0.0.7", "localhost", "studio.local", "studio:9000", "::1"])
def test_a_host_may_be_a_name_or_a_number(tmp_path, server):
    words = ["surfaces", "-o", str(tmp_path), "--only", "yehu.pd", "--server", server]
    assert main(words) == 0


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--only", "yehu.amxd"], "no surface 'yehu.amxd'; there are yehu.tosc"),
        (["--server", "here:there"], "expected HOST:PORT"),
        (["--server", "foo"], "expected HOST:PORT"),
        (["--server", "http://10.0.0.7:9000"], "expected HOST:PORT"),
        (["--server", "a b:9000"], "expected HOST:PORT"),
    ],
)
def test_a_wrong_word_is_refused_and_nothing_written(tmp_path, capsys, words, reason):
    assert main(["surfaces", "-o", str(tmp_path), *words]) == 2
    assert reason in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_file_in_the_folders_place_is_refused(tmp_path, capsys):
    path = tmp_path / "panels"
    path.write_text("mine")
    assert main(["surfaces", "-o", str(path)]) == 2
    assert str(path) in capsys.readouterr().err
    assert path.read_text() == "mine"


def test_the_libraries_load_only_for_this_command():
    code = (
        "import sys; from yehu_server import cli; import yehu_server.live; cli._parser();"
        "sys.exit(bool({'py2tosc', 'py2max'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
