import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from ahead.conftest import node, wasm  # noqa: F401 - fixtures

from yehu_server.ahead import build as ahead
from yehu_server.compile import levels
from yehu_server.errors import YehuError
from yehu_server.plugin.build import build
from yehu_server.plugin.carried import carried
from yehu_server.plugin.parameters import parameters

HERE = Path(__file__).parent
HEADERS = Path("/usr/share/dpf/distrho/src")


@pytest.fixture(scope="session")
def shown():
    """All parameters by address."""
    return {each.address: each for each in parameters(carried())}


@pytest.fixture(scope="session")
def built(tmp_path_factory) -> Path:
    """A folder with the plug-in in all formats, for this machine."""
    folder = tmp_path_factory.mktemp("plug-ins")
    try:
        build(folder, "linux")
    except YehuError as error:
        pytest.skip(str(error))
    return folder


@pytest.fixture(scope="session")
def host(tmp_path_factory, built):
    """A CLAP host, which counts allocations."""
    del built  # without which it is of no use
    program = tmp_path_factory.mktemp("host") / "host"
    sources = [HERE / "host.c", HERE.parent / "ahead" / "counted.c"]
    flags = ["-std=gnu11", "-O1", "-Wall", "-Wextra", "-Werror", f"-I{HEADERS}", "-rdynamic"]
    command = ["cc", *flags, *map(str, sources), "-o", str(program), "-ldl", "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return program


@pytest.fixture(scope="session")
def display():
    """The name of an X display of its own."""
    if (program := shutil.which("Xvfb")) is None:
        pytest.skip("there is no Xvfb")
    reading, writing = os.pipe()
    command = [program, "-displayfd", str(writing), "-screen", "0", "1600x900x24"]
    server = subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL)
    os.close(writing)
    with os.fdopen(reading) as printed:
        yield f":{printed.readline().strip()}"
    server.terminate()
    server.wait()


@pytest.fixture
def play(tmp_path, built, host):
    """Play lines of a script (see host.c) by the CLAP plug-in; return samples and reports."""

    def run(script, frames, rate=48000, block=128):
        lines, samples = tmp_path / "script", tmp_path / "samples"
        lines.write_text("".join(f"{line}\n" for line in script))
        numbers = [str(rate), str(block), str(frames), str(lines), str(samples)]
        command = [str(host), str(built / "Yehu.clap"), *numbers]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        reports: dict[str, list[list[float]]] = {}
        for line in done.stdout.splitlines():
            word, *values = line.split()
            reports.setdefault(word, []).append([float(value) for value in values])
        assert reports["odd"] == [[0.0]]
        assert "untrue" not in reports
        return np.fromfile(samples, np.float32).reshape(-1, 2), reports

    return run


@pytest.fixture(scope="session")
def library(tmp_path_factory) -> Path:
    """The library for C programs, of the version that the plug-in chooses on this machine."""
    folder = tmp_path_factory.mktemp("library")
    ahead.build("library", folder, level=levels.level())
    return folder / ahead.LIBRARY_FILE
