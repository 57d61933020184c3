"""Fuzzes one reader with atheris: inputs that reach new code are varied further.

    .venv/bin/python tests/fuzz/run.py --list
    .venv/bin/python tests/fuzz/run.py preset -max_total_time=600
    .venv/bin/python tests/fuzz/run.py preset FILE

Options are libFuzzer's. It ends at an input that breaks the contract, keeps it in a file and
reports the error; the exit code is then not 0.
"""

import logging
import os
import sys
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]

import atheris
from fuzz.target import MAX_BYTES, ROOT, TARGETS, Target, scratch

# What numba compiles is not watched.
COMPILED = [
    f"yehu_server.{folder}.{file.stem}"
    for folder in ("core.physics", "core.controls", "core.player", "core.engine")
    for file in (ROOT / "yehu_server" / folder.replace(".", "/")).glob("*.py")
    if file.stem != "quantities"  # reads body and instrument files
]
with atheris.instrument_imports(
    ["yehu_server", "yehu_lab", "tomllib"], [*COMPILED, "yehu_server.compile.jit"]
):
    from fuzz import targets  # noqa: F401 - they fill TARGETS


def fuzz(target: Target, options: list[str]) -> None:
    """Fuzz a target, in this process, which ends with it."""
    logging.disable(logging.WARNING)  # readers' warnings about bad input
    words, seeds = scratch() / "words", scratch() / "seeds"
    seeds.mkdir()
    for name, data in target.seeds().items():
        (seeds / name).write_bytes(data)
    lines = ("".join(f"\\x{byte:02x}" for byte in word) for word in target.words)
    words.write_text("".join(f'"{line}"\n' for line in lines))
    usual = [f"-max_len={MAX_BYTES}", "-rss_limit_mb=4096", "-timeout=60", f"-dict={words}"]
    corpus = [] if any(Path(option).is_file() for option in options) else [str(seeds)]
    atheris.Setup([target.name, *usual, *options, *corpus], target.check)
    atheris.Fuzz()


def main() -> int:
    match sys.argv[1:]:
        case ["--list"]:
            for target in TARGETS.values():
                print(f"{target.name}: {target.contract}")
            return 0
        case [name, *options] if name in TARGETS:
            scratch()
            if (child := os.fork()) == 0:  # libFuzzer ends a process without cleaning up
                fuzz(TARGETS[name], options)
                os._exit(0)
            return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    sys.exit(f"{__doc__}\nTargets: {', '.join(TARGETS)}")


if __name__ == "__main__":
    sys.exit(main())
