"""A second press, before what the first one asks for has begun, is heeded."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing, served

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> Any:
    with served(tmp_path_factory.mktemp("generated")) as url:
        return drive("page_pressing.mjs", url)


def test_nothing_goes_wrong(found) -> None:
    assert found["errors"] == []


def test_what_is_pressed_twice_while_the_sound_begins_is_not_begun(found) -> None:
    assert found["twice"] == {"done": [], "pressed": 0}
    assert found["once"] == {"done": ["record"], "pressed": 1}


def test_a_recording_is_saved_when_another_sound_takes_its_place(found) -> None:
    assert found["replaced"] == {"done": ["recorded"], "pressed": 0}


def test_a_voice_is_followed_if_the_last_press_while_the_browser_asks_wants_it(found) -> None:
    assert found["asked"]["done"][-1:] == ["silent"]  # if it was asked for at all, it was let go
    assert found["asked"]["isOn"] == "false"
    assert (found["hums"]["done"], found["hums"]["isOn"]) == (["voice"], "true")
