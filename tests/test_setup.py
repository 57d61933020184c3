"""Setting up a checkout: what installs, and what is kept for later starts."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture
def checkout(tmp_path) -> Path:
    """A checkout in a folder with a space; programs in its .venv tell how they are called."""
    root = tmp_path / "check out"
    shutil.copytree(ROOT / "scripts" / "lib", root / "scripts" / "lib")
    shutil.copytree(ROOT / "requirements", root / "requirements")
    for name in ("scripts/yehu", "pyproject.toml"):
        shutil.copy(ROOT / name, root / name)
    programs = root / ".venv" / "bin"
    programs.mkdir(parents=True)
    write(programs / "yehu-server", 'echo "bytecode: ${PYTHONDONTWRITEBYTECODE-kept}" "$@"')
    settings = (
        "global.index-url='https://a.invalid'\\nx.extra-index-url='https://b.invalid'"
        "\\nx.find-links='/w /v'"
    )
    write(
        programs / "python",
        f'case "$*" in *"config list"*) printf "{settings}\\n" ;; *" install "*) echo "pip $*" ;;'
        ' *) exec python3 "$@" ;; esac',
    )
    return root


def write(program: Path, text: str) -> None:
    program.write_text(f"#!/usr/bin/env bash\n{text}\n")
    program.chmod(0o755)


def run(checkout: Path, code: str, **environment: str) -> str:
    """What bash prints of some code that has the functions of the set-up."""
    done = subprocess.run(
        ["/usr/bin/env", "bash", "-c", f". scripts/lib/setup.sh; {code}"],
        cwd=checkout,
        env={**os.environ, **environment},
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout


@pytest.mark.parametrize("asked", ["$venv/bin/python", "false"], ids=["its own", "has none"])
def test_uv_installs_where_pip_would_look(checkout, asked):
    """Python's own pip is asked where it looks, or else one that comes into .venv for that.

    But not in its extra indexes: uv takes a version's files from one index alone, the first.
    """
    write(checkout / ".venv" / "bin" / "uv", 'echo "$UV_DEFAULT_INDEX|$UV_INDEX|$UV_FIND_LINKS|$*"')
    told = run(
        checkout,
        f'PATH=$venv/bin:$PATH; settings=$(settings_of_pip "{asked}")'
        '; install_packages --require-hashes -r x; cat "$log"',
    )
    *where, call = told.strip().split("|")
    assert where == ["https://a.invalid", "", "/w,/v"]
    assert call.startswith("pip install --python ")
    assert call.endswith("check out/.venv/bin/python --require-hashes -r x")


def test_bytecode_is_kept_also_where_the_environment_would_not_have_it(checkout):
    run(checkout, 'fingerprint >"$venv/stamp-run"')
    done = subprocess.run(
        [checkout / "scripts" / "yehu", "render"],
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
        check=True,
        capture_output=True,
        text=True,
    )
    assert done.stdout == "bytecode: kept render\n"
