"""Building ahead of time: what is written, what is refused, and which module a page gets."""

from __future__ import annotations

import hashlib
import shutil

import pytest

from yehu_server.ahead import kept
from yehu_server.ahead.build import build
from yehu_server.ahead.section import section_of, with_section
from yehu_server.errors import ParameterError, YehuError

EMPTY = b"\0asm\1\0\0\0"


@pytest.mark.parametrize("text", ["", "0.1.0 0123456789abcdef", "x" * 300])
def test_a_section_is_read_as_it_was_written(text):
    other = bytes((1, 3, 0, 0, 0))  # a section of another kind before it
    assert section_of(with_section(EMPTY + other, text)) == text


@pytest.mark.parametrize(
    "module", [b"", b"RIFF", EMPTY, EMPTY + b"\0\xff", EMPTY + b"\0\x05\x04yeh"]
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


@pytest.fixture
def shipped(tmp_path, monkeypatch):
    """Where a shipped module would be; nothing is kept, and nothing can be built."""
    path = tmp_path / "shipped.wasm"
    monkeypatch.setattr(kept, "SHIPPED", path)
    monkeypatch.setattr(kept, "data_folder", lambda: tmp_path)
    monkeypatch.setattr(kept, "page_linker", lambda: None)
    return path


def test_a_shipped_module_of_these_sources_is_taken_in_silence(shipped, caplog):
    shipped.write_bytes(with_section(EMPTY, f"9.9 {kept.sources_hash()}"))
    assert kept.page_module() == shipped
    assert not caplog.records


def test_an_older_shipped_module_is_taken_where_none_can_be_built_and_its_version_told(
    shipped, caplog
):
    shipped.write_bytes(with_section(EMPTY, "0.0.9 0123456789abcdef"))
    assert kept.page_module() == shipped
    assert "plays version 0.0.9" in caplog.text


@pytest.mark.usefixtures("shipped")
def test_without_any_module_the_error_tells_what_would_help():
    with pytest.raises(YehuError, match="Debian's lld"):
        kept.page_module()


@pytest.mark.slow
@pytest.mark.parametrize("what", ["wasm", "library"])
def test_a_build_is_the_same_to_the_byte_also_from_an_empty_cache(tmp_path, monkeypatch, what):
    if what == "wasm" and kept.page_linker() is None:
        pytest.skip("there is no wasm-ld")
    digests = set()
    for name in ("one", "two", "two"):
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / name))
        files = build(what, tmp_path / "built")
        digests.add(tuple(hashlib.sha256(file.read_bytes()).hexdigest() for file in files))
        shutil.rmtree(tmp_path / "built")
    assert len(digests) == 1
