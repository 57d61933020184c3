"""Settings for all tests."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from platformdirs import user_config_path

# Set before numpy loads: the dense references work on small matrices, where the threads of
# two test processes only get in each other's way.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# The same cases on every machine, and no deadline: a first call may have to compile.
settings.register_profile("yehu", deadline=None, derandomize=True, database=None)
settings.load_profile("yehu")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--all", action="store_true", help="also run the tests that are marked slow")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if not config.getoption("--all"):
        for item in items:
            if item.get_closest_marker("slow"):
                item.add_marker(pytest.mark.skip(reason="slow: run with --all"))


@pytest.fixture(scope="session", autouse=True)
def _config_home(tmp_path_factory) -> Iterator[None]:
    """No test reads the mappings or settings of whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))
        yield


@pytest.fixture
def config_home(tmp_path, monkeypatch) -> Path:
    """A folder of settings for one test."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    return tmp_path / "config"


@pytest.fixture(scope="session")
def own_presets(_config_home) -> Path:
    """The folder where whoever runs the tests would keep presets: an empty one."""
    return user_config_path("yehu-server") / "presets"


@pytest.fixture
def mappings(capsys) -> Callable[..., tuple[int, str, str]]:
    """Run ``yehu-server mappings``; its exit code and what it printed."""
    from yehu_server.cli import main

    def run(*words: object) -> tuple[int, str, str]:
        code = main(["mappings", *(str(word) for word in words)])
        out, err = capsys.readouterr()
        return code, out, err

    return run
