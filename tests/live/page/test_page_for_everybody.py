"""Nothing on the page keeps people out, as far as axe-core can tell."""

from __future__ import annotations

import pytest
from live.page.browser import ROOT, drive, missing, served

from yehu_server.live.page import facts

pytestmark = [
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
    pytest.mark.skipif(not (ROOT / "node_modules" / "axe-core").is_dir(), reason="needs axe-core"),
]


def test_axe_finds_no_violation_in_any_view(tmp_path, everything):
    facts.write(tmp_path)
    with served(tmp_path) as url:
        assert drive("page_axe.mjs", url, "all" if everything else "some") == []
