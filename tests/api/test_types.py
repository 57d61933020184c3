"""Examples of the interface have the types that it declares: those of pages and of docstrings."""

import doctest
import importlib
import pkgutil
from collections.abc import Iterator

from mypy import api
from pages import PAGES, ROOT

import yehu_lab.api
import yehu_lab.plot
import yehu_server.api
import yehu_server.plot

WITH_EXAMPLES = (yehu_server.api, yehu_server.plot, yehu_lab.api, yehu_lab.plot)


def examples() -> Iterator[tuple[str, str]]:
    """Each example that can stand alone, with a name for it."""
    for page in PAGES:
        for number, block in enumerate(page.blocks("python")):
            if page.name.startswith("docs/") and block.startswith("import "):
                yield f"{page.path.stem}_{number}", block
    for package in WITH_EXAMPLES:
        for found in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
            module = importlib.import_module(found.name)
            for test in doctest.DocTestFinder().find(module):
                source = "".join(example.source for example in test.examples)
                if "import yehu_server" in source:
                    yield test.name.replace(".", "_"), source


def test_examples_have_the_types_that_the_interface_declares(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    count = 0
    for name, source in examples():
        (tmp_path / f"{name}.py").write_text(source, encoding="utf-8")
        count += 1
    assert count > 20
    said, _, code = api.run(["--config-file", "pyproject.toml", str(tmp_path)])
    assert code == 0, said
