"""Keys of source: a change of code changes the key, a change of comments does not."""

import ast
import gc
import io
import sys
import tokenize
import types
from pathlib import Path

import pytest

import yehu_lab.regimes  # noqa: F401 - it registers what it compiles
from yehu_server.compile import function_cache as cache
from yehu_server.compile import jit, numba_compiler
from yehu_server.compile.cache_folder import sources
from yehu_server.util import PACKAGE
from yehu_server.util.source_key import key_of, without_comments

KEYED = [*sources(), *sorted((PACKAGE / "playing").rglob("*.py"))]
MAKERS = ("compiled", "native", "Native", "arithmetic", "intrinsic")
COMPILERS = {(jit.__name__, name) for name in vars(jit) if name.startswith(MAKERS)}
LAYOUT = {
    tokenize.ENCODING,
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
}
CODE = '''"""What the file is for."""

LIMIT = 3  # of something


def third(number: int) -> int:
    """A third of a number."""
    # Rounded down.
    return number // LIMIT
'''


def words(source: str, without: frozenset[tuple[int, int]] = frozenset()) -> list[str]:
    """The tokens of code, without those at the given places."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return [
        token.string for token in tokens if token.type not in LAYOUT and token.start not in without
    ]


def docstrings(source: str) -> frozenset[tuple[int, int]]:
    """The places where docstrings begin."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    found = [
        node.body[0]
        for node in ast.walk(ast.parse(source))
        if isinstance(node, kinds) and ast.get_docstring(node) is not None
    ]
    return frozenset((node.lineno, node.col_offset) for node in found)


@pytest.mark.parametrize("package", ["yehu_server", "yehu_lab"])
def test_the_key_is_of_all_that_compiled_functions_come_from_and_name(package):
    files = (PACKAGE.parent / package).rglob("*.py")
    used = {path: compiled_from(path) for path in files}
    assert sum(map(len, used.values())) > 0
    assert {path for paths in used.values() for path in paths} <= {*sources(package)}


def compiled_from(path: Path) -> set[Path]:
    """Where a module's compiled functions come from, and what they name, also by its constants.

    Empty where it has no such function.
    """
    source = path.read_bytes()
    statements = ast.parse(source).body if jit.__name__.encode() in source else []
    origins: dict[str, tuple[str, str]] = {}
    named: dict[str, set[str]] = {}  # by the names that statements define
    ahead: list[str] = []
    for statement in statements:
        nodes = [*ast.walk(statement)]
        names = [node for node in nodes if isinstance(node, ast.Name)]
        own = {name.id for name in names if isinstance(name.ctx, ast.Store)}
        for name in {statement.name} if hasattr(statement, "name") else own:
            named.setdefault(name, set()).update(name.id for name in names)
        for node in nodes:
            if isinstance(node, ast.ImportFrom):
                module = node.module or ""
                origins |= {each.asname or each.name: (module, each.name) for each in node.names}
            for maker in getattr(node, "decorator_list", [getattr(node, "func", None)]):
                if origins.get(getattr(maker, "id", "")) in COMPILERS:
                    ahead += [name.id for name in names]
    found, seen = {path} if ahead else set(), set()
    while ahead:
        name = ahead.pop()
        if name not in seen:
            seen.add(name)
            ahead += named.get(name, ())
            found |= file_of(*origins.get(name, ("", "")))
    return found


def file_of(module: str, name: str) -> set[Path]:
    """The file of a module's name, or of the module of this name; empty if it is not of ours."""
    place = PACKAGE.parent.joinpath(*module.split("."))
    files = (place / f"{name}.py", place.with_suffix(".py"), place / "__init__.py")
    return {*[file for file in files if file.exists()][:1]} if module.startswith("yehu_") else set()


def test_comments_and_docstrings_are_left_out_and_nothing_else(subtests, everything):
    for path in KEYED if everything else KEYED[::5]:
        with subtests.test(path.stem):
            source = path.read_text(encoding="utf-8")
            assert words(without_comments(source)) == words(source, docstrings(source))


def test_comments_leave_the_key_and_code_changes_it(tmp_path):
    plain = edited(tmp_path, "", "")
    for old, new in (
        ("  # of something", ""),
        ("# of something", "# of something else"),
        ("What the file is for.", "What this is for."),
        ("A third", "One third,\n\n    rounded down,"),
        ("    # Rounded down.\n", "\n"),
        ('    """A third of a number."""\n', ""),
        ("\n\n\ndef", "\n\n# ---- thirds\n\n\ndef"),
    ):
        assert edited(tmp_path, old, new) == plain, old
    for old, new in (
        ("LIMIT = 3", "LIMIT = 4"),
        ("//", "/"),
        ("    return", "        return"),
        ("return number", "return '#'"),
    ):
        assert edited(tmp_path, old, new) != plain, old


def edited(folder: Path, old: str, new: str) -> str:
    assert old in CODE
    path = folder / "thirds.py"
    path.write_text(CODE.replace(old, new, 1), encoding="utf-8")
    return key_of([path])


def test_a_comment_compiles_nothing_anew(tmp_path, monkeypatch):
    folder = tmp_path / "cache"
    folder.mkdir()
    monkeypatch.setattr(numba_compiler, "cache_folder", lambda: folder)
    monkeypatch.setattr(numba_compiler, "IS_CACHED", True)
    monkeypatch.setattr(cache, "_reported", set())

    def was_there(source: str) -> bool:
        """Whether the code of `third` was cached, after a new start."""
        path = tmp_path / "thirds.py"
        path.write_text(source, encoding="utf-8")
        # One that can be imported: numba asks for it, once nothing of the last start is left.
        thirds = types.ModuleType("thirds")
        thirds.__file__ = str(path)
        exec(compile(source, str(path), "exec"), thirds.__dict__)  # noqa: S102 - our own
        monkeypatch.setitem(sys.modules, "thirds", thirds)
        gc.collect()
        native = jit.Native(thirds.third)
        assert native.call(12) == 4
        return native.compiled.cache_hits == 1

    assert not was_there(CODE)
    assert was_there(CODE)
    assert was_there(CODE.replace("# Rounded down.", "# Rounded\n    # down."))
    assert was_there("# A comment above.\n" + CODE.replace("A third", "One third"))
    assert not was_there(CODE.replace("number // LIMIT", "number // LIMIT + 0 * number"))
