"""Settings for all tests."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

# Set before numpy loads: the dense references work on small matrices, where the threads of
# two test processes only get in each other's way.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# The same cases on every machine, and no deadline: a first call may have to compile.
settings.register_profile("yehu", deadline=None, derandomize=True, database=None)
settings.load_profile("yehu")


@pytest.fixture(scope="session", autouse=True)
def own_presets(tmp_path_factory) -> Iterator[Path]:
    """An empty folder in place of the one where whoever runs the tests keeps presets."""
    settings_folder = tmp_path_factory.mktemp("settings")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("yehu_server.playing.presets.user_config_path", lambda _name: settings_folder)
        yield settings_folder / "presets"
