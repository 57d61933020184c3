"""``yehu-server body``: taps, fit, show, and the render that plays it."""

import builtins
import importlib
import json

import numpy as np
import pytest
from lab.body.bodies import admittance

from yehu_server.core.physics.default_quantities import read_quantities

HZ = np.arange(300.0, 2500.0, 6.0)


@pytest.fixture(scope="module")
def response(tmp_path_factory):
    """A small admittance, which is fitted at once."""
    values = admittance(HZ)
    path = tmp_path_factory.mktemp("response") / "y.csv"
    rows = zip(HZ, values.real, values.imag, strict=True)
    lines = ["frequency_hz,mobility_real,mobility_imag"]
    lines += [",".join(repr(float(cell)) for cell in row) for row in rows]
    path.write_text("\n".join(lines))
    return path


def test_from_taps_to_sound(command, tmp_path):
    """All that one types: taps, fit, show, simulate."""
    code, out, _ = command("body", "taps", "-o", tmp_path / "taps", "--count", 3)
    assert code == 0
    channels = out.split("--channels ")[1].strip()
    files = sorted((tmp_path / "taps").iterdir())
    assert [file.name for file in files] == ["tap1.wav", "tap2.wav", "tap3.wav"]
    code, out, err = command(
        "body", "fit", *files, "--channels", channels, "-o", tmp_path / "mine.toml",
        "--band", "250:1500", "--plot", tmp_path / "mine.png",
    )  # fmt: skip
    assert (code, err) == (0, "")
    assert "bridge modes" in out
    assert read_quantities(tmp_path / "mine.toml").body.frequency_hz[0] == pytest.approx(
        438.8, 0.01
    )
    assert (tmp_path / "mine.png").read_bytes().startswith(b"\x89PNG")
    code, _, err = command("body", "show", tmp_path / "mine.toml", "-o", tmp_path / "again.png")
    assert (code, err) == (0, "")
    code, out, err = command("body", "show")  # the shipped one
    assert (code, err) == (0, "")
    assert "11 bridge modes, 25 sections" in out
    gesture = {"duration": 0.01, "instrument": {"body": "mine.body.json"}}
    (tmp_path / "gesture.json").write_text(json.dumps(gesture))
    code, _, _ = command("simulate", tmp_path / "gesture.json", "-o", tmp_path / "run.npz")
    assert code == 0


def test_a_fit_says_what_it_found_and_what_it_warns_of(command, response, tmp_path):
    words = ("body", "fit", response, "--band", "300:2500", "-o")
    code, out, _ = command(*words, tmp_path / "m.json", "--json")
    assert code == 0
    told = json.loads(out)
    assert told["sources"] == ["y.csv"]
    assert [round(mode["frequency_hz"]) for mode in told["modes"]][:3] == [439, 568, 776]
    assert told["admittance_db"]["rms"] < 0.05
    assert any("no radiation was measured" in line for line in told["warnings"])
    _, _, err = command(*words, tmp_path / "n.json")  # a line each
    assert err.startswith("yehu-server: no radiation was measured")
    assert err.count("\n") == 1


def test_what_cannot_be_done_is_one_line_and_nothing_is_written(
    refused, response, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    for words in (
        ("-o", "m.wav"),
        ("-o", "-"),
        ("-o", "m.toml", "--band", "5:x"),
        ("-o", "m.toml", "--modes", "65"),
        ("-o", "m.toml", "--kind", "speed"),
        ("-o", "m.toml", "--plot", "m.jpg"),
        ("-o", "m.toml", "--channels", "volts=1"),
        ("-o", "none/m.toml"),
    ):
        refused("body", "fit", response, *words)
        assert not list(tmp_path.iterdir()), words
    assert "at least one file of measurements" in refused("body", "fit", "-o", tmp_path / "m.toml")


@pytest.mark.parametrize(
    ("missing", "extra", "words"),
    [
        ("scipy", "body", ("fit", "y.csv", "-o", "m.toml")),
        ("sdypy", "body", ("fit", "y.csv", "-o", "m.toml")),
        ("pyuff", "body", ("fit", "y.uff", "-o", "m.toml")),
        ("scipy", "body", ("taps", "-o", "taps")),
        ("matplotlib", "plots", ("show", "-o", "m.png")),
    ],
)
def test_a_missing_library_is_one_line_that_names_its_extra(
    refused, response, tmp_path, monkeypatch, missing, extra, words
):
    (tmp_path / "y.csv").write_bytes(response.read_bytes())
    (tmp_path / "y.uff").write_text("    -1\n    58\n")
    monkeypatch.chdir(tmp_path)

    def without(load):
        def loaded(name, *rest):
            if name.split(".")[0] == missing:
                raise ImportError(name)
            return load(name, *rest)

        return loaded

    monkeypatch.setattr(builtins, "__import__", without(builtins.__import__))
    monkeypatch.setattr(importlib, "import_module", without(importlib.import_module))
    assert f"yehu-server[{extra}]" in refused("body", *words)
    monkeypatch.undo()
