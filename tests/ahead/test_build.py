"""Building ahead of time: what is written, and what is refused."""

from __future__ import annotations

import hashlib
import shutil

import pytest

from yehu_server.ahead.build import build
from yehu_server.ahead.link import page_linker
from yehu_server.ahead.section import section_of, with_section
from yehu_server.errors import ParameterError, YehuError

EMPTY = b"\0asm\1\0\0\0"


@pytest.mark.parametrize("text", ["", "0.1.0 0123456789abcdef", "x" * 300])
def test_a_section_is_read_as_it_was_written(text):
    other = bytes((1, 3, 0, 0, 0))  # a section of another kind before it
    assert section_of(with_section(EMPTY + other, text)) == text


@pytest.mark.parametrize(
    "module",
    [
        b"",
        b"RIFF",
        b"RIFF" + with_section(EMPTY, "0.1.0 0123456789abcdef")[4:],
        EMPTY,
        EMPTY + b"\0\xff",
        EMPTY + b"\0\x05\x04yeh",
    ],
)
def test_what_is_no_module_or_has_no_section_tells_nothing(module):
    assert section_of(module) == ""


def test_a_processor_that_llvm_does_not_know_is_refused(tmp_path):
    with pytest.raises(ParameterError, match="'pdp11' is no processor"):
        build("library", tmp_path, cpu="pdp11")
    assert not list(tmp_path.iterdir())


def test_a_rate_that_makes_no_model_is_refused_in_its_own_words(tmp_path):
    with pytest.raises(YehuError, match=r"^sample rate: 5.0 Hz is not within"):
        build("library", tmp_path, rates=[5.0])


@pytest.mark.parametrize("what", ["wasm", "library"])
def test_without_a_linker_the_error_names_what_is_missing(tmp_path, monkeypatch, what):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(YehuError, match=r"there is no (wasm-ld|C compiler) here"):
        build(what, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("what", ["wasm", "library"])
def test_a_build_is_the_same_to_the_byte_also_from_an_empty_cache(tmp_path, monkeypatch, what):
    if what == "wasm" and page_linker() is None:
        pytest.skip("there is no wasm-ld")
    digests = set()
    for name in ("one", "two", "two"):
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / name))
        files = build(what, tmp_path / "built")
        digests.add(tuple(hashlib.sha256(file.read_bytes()).hexdigest() for file in files))
        shutil.rmtree(tmp_path / "built")
    assert len(digests) == 1
