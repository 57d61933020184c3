"""The page speaks another language at once, and nothing that sounds or was written is lost."""

from __future__ import annotations

import re
from typing import Any

import pytest
from live.page.browser import drive, missing, served

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
]

# What every language writes with Latin letters, or that is no word.
LATIN = re.compile(
    r"yehu-server serve --mapping|/[a-z_/]+|Keys|Switch to English|English|MIDI|MPE|AudioWorklet|"
    r"Hz|dBFS|dB|ms|m/s|CC|N?RPN|WAV|Esc|Web|https|\b(?:[A-Z][♯♭]?#?|N|s|mm|st|ct)\b"
)


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> Any:
    """What the page said."""
    generated = tmp_path_factory.mktemp("generated")
    with served(generated) as url:
        return drive("page_language.mjs", url)


def test_the_sound_goes_on(found) -> None:
    assert found["stays"]
    assert found["held"] == 1


def test_what_was_written_stays(found) -> None:
    assert found["searched"] == "bow"


def test_every_word_is_that_of_a_page_loaded_in_the_language(found) -> None:
    assert found["before"] != found["after"]
    assert found["after"] == found["anew"]


def test_no_word_is_left_in_english(found) -> None:
    left = [re.sub(LATIN, "", line.partition("|")[2]) for line in found["anew"]]
    assert [line for line in left if re.search(r"[A-Za-z]{2}", line)] == []


def test_nothing_goes_wrong(found) -> None:
    assert found["errors"] == []
