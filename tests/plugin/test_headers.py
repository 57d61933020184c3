"""What a plug-in needs is named at once, before anything is compiled."""

from dataclasses import replace

import pytest

from yehu_server.errors import YehuError
from yehu_server.plugin import build


def test_all_headers_that_are_missing_are_named_at_once(tmp_path, monkeypatch):
    monkeypatch.setattr(build, "SYSTEM", tmp_path)
    monkeypatch.setattr(
        build, "FORMATS", [replace(each, headers=tmp_path) for each in build.FORMATS]
    )
    monkeypatch.setattr(build, "make_objects", lambda *_: pytest.fail("something is compiled"))
    with pytest.raises(YehuError) as raised:
        build.build(tmp_path / "made", "linux")
    assert str(raised.value) == (
        "there are no headers of CLAP, LV2, VST3, X's windows here; "
        "on Debian: apt-get install dpf-source lv2-dev libxcb1-dev"
    )
    for each in build.FORMATS:
        (tmp_path / each.sign).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / each.sign).touch()
    with pytest.raises(YehuError, match=r"no headers of X's windows here; .* install libxcb1-dev$"):
        build.build(tmp_path / "made", "linux")
    monkeypatch.setattr(build, "zig", lambda _tool: None)
    with pytest.raises(YehuError, match="building for windows needs zig"):
        build.build(tmp_path / "made", "windows")  # which has no X
