from __future__ import annotations

import sys
from pathlib import Path

import pytest
from pages import ROOT

from yehu_server.ahead.link import page_linker

SCRIPTS = ROOT / "scripts" / "documentation"


@pytest.fixture(scope="module")
def scripts():
    """The modules that make the site."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(SCRIPTS)
        import build
        import check
        import notebooks

        yield {"build": build, "check": check, "notebooks": notebooks}
        for name in ("build", "check", "notebooks", "places"):
            sys.modules.pop(name, None)


@pytest.fixture(scope="module")
def site(scripts, tmp_path_factory) -> Path:
    """The site as `scripts/site -o` writes it, which refuses warnings and broken links."""
    if page_linker() is None:
        pytest.skip("there is no wasm-ld")
    folder = tmp_path_factory.mktemp("site") / "site"
    scripts["build"].build(folder)
    return folder
