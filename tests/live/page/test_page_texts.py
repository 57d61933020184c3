"""The page's words: the same in each language, for all that the tables have."""

import json
import re
from pathlib import Path

import pytest

from yehu_server.params.table import TABLE
from yehu_server.playing.mapping import shipped_mappings
from yehu_server.playing.preset_folders import Presets

WEB = Path(__file__).parents[3] / "web"
# English has these from the tables themselves.
TRANSLATED = re.compile(r"about/|preset\.[^.]+\.about$")


@pytest.fixture(scope="module")
def texts() -> dict[str, dict[str, str]]:
    return {
        name: json.loads((WEB / "texts" / f"{name}.json").read_text("utf-8"))
        for name in ("en", "zh")
    }


def test_both_languages_have_the_same_keys_and_fill_in_the_same_values(texts) -> None:
    english, chinese = (set(texts[language]) for language in ("en", "zh"))
    assert {key for key in chinese if not TRANSLATED.match(key)} == english
    assert all(words.strip() for text in texts.values() for words in text.values())
    for key, words in texts["en"].items():
        one, other = (sorted(re.findall(r"\{\w+\}", each)) for each in (words, texts["zh"][key]))
        assert one == other, key


def test_every_parameter_preset_and_mapping_has_a_name_and_is_translated(texts) -> None:
    addresses = {param.address for param in TABLE}
    for language, kind in ("en", "parameter"), ("zh", "about"):
        keys = {key for key in texts[language] if key.startswith(kind + "/")}
        assert keys == {kind + address for address in addresses}
    for preset in Presets().all()[0]:
        assert f"preset.{preset.name}" in texts["en"]
        assert f"preset.{preset.name}.about" in texts["zh"]
    assert {f"mapping.{mapping}" for mapping in shipped_mappings()} <= set(texts["en"])


def test_every_key_that_the_page_names_is_there(texts) -> None:
    sources = [
        *WEB.glob("*.js"),
        *WEB.glob("views/*.js"),
        *WEB.glob("pictures/*.js"),
        WEB / "index.html",
    ]
    named = re.compile(
        r"\b(?:translate|words|section|row)\(\s*[\"']([^\"'$]+)[\"']|data-(?:text|label|hint)=\"([^\"]+)\""
    )
    keys = {one or other for file in sources for one, other in named.findall(file.read_text())}
    assert len(keys) > 50
    assert keys - set(texts["en"]) == set()
