"""Link python.exe, and give modules the complex functions that Debian 12's wine lacks.

    windows_binaries.py FOLDER    scripts/lib/windows.sh has made it

numpy imports them from Windows' C library. A DLL of another name has them instead and forwards the
rest, and that name replaces the library's in each module. Good enough for what the tests compute.

Both call that library by name alone: mingw's own part of it takes zig many minutes to compile.
"""

import os
import subprocess
import sys
from pathlib import Path

FOLDER = Path(sys.argv[1])
PYTHON = FOLDER / "python"
sys.path.append(str(FOLDER / "tools"))
LAUNCHER = """
int Py_Main(int, unsigned short **), *__p___argc(void);
unsigned short ***__p___wargv(void);
void _configure_wide_argv(int), exit(int);
void start(void) {
    _configure_wide_argv(1); /* without wildcards */
    exit(Py_Main(*__p___argc(), *__p___wargv()));
}
"""
LAUNCHED = ("_configure_wide_argv", "__p___argc", "__p___wargv", "exit")
LIBRARY, SHIM = b"api-ms-win-crt-math-l1-1-0.dll", b"yeh-ms-win-crt-math-l1-1-0.dll"
# What it computes by, of one number and of two.
UNARY, BINARY = ("cos", "cosh", "exp", "log", "sin", "sinh", "sqrt"), ("atan2", "hypot")
REAL = {"real": "re", "imag": "im", "abs": "hypot(re, im)", "arg": "atan2(im, re)"}
# Each by real functions of the real part and the imaginary one, which wine has.
COMPLEX = {
    "conj": ("re", "-im"),
    "exp": ("exp(re) * cos(im)", "exp(re) * sin(im)"),
    "log": ("log(hypot(re, im))", "atan2(im, re)"),
    "sqrt": (
        "sqrt(hypot(re, im)) * cos(atan2(im, re) / 2)",
        "sqrt(hypot(re, im)) * sin(atan2(im, re) / 2)",
    ),
    "sin": ("sin(re) * cosh(im)", "cos(re) * sinh(im)"),
    "cos": ("cos(re) * cosh(im)", "-sin(re) * sinh(im)"),
    "sinh": ("sinh(re) * cos(im)", "cosh(re) * sin(im)"),
    "cosh": ("cosh(re) * cos(im)", "sinh(re) * sin(im)"),
    "tan": (
        "sin(2 * re) / (cos(2 * re) + cosh(2 * im))",
        "sinh(2 * im) / (cos(2 * re) + cosh(2 * im))",
    ),
    "tanh": (
        "sinh(2 * re) / (cosh(2 * re) + cos(2 * im))",
        "sin(2 * im) / (cosh(2 * re) + cos(2 * im))",
    ),
}
POWER = """{{
    double size = log(hypot(__real__ z, __imag__ z)), turn = atan2(__imag__ z, __real__ z);
    double a = __real__ w * size - __imag__ w * turn, b = __real__ w * turn + __imag__ w * size;
    {type} _Complex y;
    __real__ y = exp(a) * cos(b);
    __imag__ y = exp(a) * sin(b);
    return y;
}}"""


def imported() -> dict[str, set[Path]]:
    """The functions that modules take from that library, and who does."""
    import pefile

    found: dict[str, set[Path]] = {}
    for file in sorted((PYTHON / "Lib/site-packages").rglob("*")):
        if file.suffix not in (".pyd", ".dll") or LIBRARY not in file.read_bytes():
            continue
        pe = pefile.PE(file, fast_load=True)
        pe.parse_data_directories([pefile.DIRECTORY_ENTRY["IMAGE_DIRECTORY_ENTRY_IMPORT"]])
        for entry in pe.DIRECTORY_ENTRY_IMPORT:
            if entry.dll.lower() == LIBRARY:
                for function in entry.imports:
                    found.setdefault(function.name.decode(), set()).add(file)
        pe.close()
    return found


def written(name: str) -> str:
    """A function in C; empty where it is not one of complex numbers."""
    base, of = name.lstrip("_").removeprefix("c"), "double"
    if base not in REAL and base not in COMPLEX and base != "pow":
        base, of = base[:-1], {"f": "float", "l": "double"}.get(base[-1:], "")  # MSVC's long double
    if not of or not name.lstrip("_").startswith("c") or name in ("cosf", "coshf"):
        return ""
    parts = f"double re = __real__ z, im = __imag__ z; (void)re; (void)im; {of} _Complex y;"
    if base in REAL:
        return f"{of} own_{name}({of} _Complex z) {{ {parts} (void)y; return {REAL[base]}; }}"
    if base in COMPLEX:
        re, im = COMPLEX[base]
        parts += f" __real__ y = {re}; __imag__ y = {im}; return y;"
        return f"{of} _Complex own_{name}({of} _Complex z) {{ {parts} }}"
    if base == "pow":
        return f"{of} _Complex own_{name}({of} _Complex z, {of} _Complex w) " + POWER.format(
            type=of
        )
    return ""


def link(name: str, source: str, imports: dict[str, tuple[str, ...]], *options: str) -> None:
    """Link C into a file beside Python, with functions of other DLLs, by options of lld-link."""
    work = FOLDER / "linked" / name
    work.mkdir(parents=True, exist_ok=True)
    for library, functions in imports.items():
        definitions = "\n".join([f"LIBRARY {library}.dll", "EXPORTS", *functions, ""])
        (work / f"{library}.def").write_text(definitions)
        files = ("-d", f"{library}.def", "-l", f"{library}.lib")
        zig("dlltool", "-m", "i386:x86-64", *files, work=work)
    (work / "code.c").write_text(source)
    flags = ("-target", "x86_64-windows-gnu", "-O1", "-fno-builtin")
    zig("cc", *flags, "-c", "code.c", "-o", "code.obj", work=work)
    libraries = [f"{library}.lib" for library in imports]
    zig("lld-link", *options, f"/out:{PYTHON / name}", "code.obj", *libraries, work=work)


def zig(*words: str, work: Path) -> None:
    """Run zig in a folder."""
    subprocess.run(  # noqa: S603
        [sys.executable, "-m", "ziglang", *words],
        check=True,
        cwd=work,
        env={**os.environ, "PYTHONPATH": str(FOLDER / "tools")},
    )


def main() -> None:
    version = "".join(map(str, sys.version_info[:2]))
    link(
        "python.exe",
        LAUNCHER,
        {f"python{version}": ("Py_Main",), "ucrtbase": LAUNCHED},
        *("/entry:start", "/subsystem:console"),
    )
    found = imported()
    source = {name: text for name in found if (text := written(name))}
    declared = [f"double {name}(double);" for name in UNARY]
    declared += [f"double {name}(double, double);" for name in BINARY]
    exports = [f"{name}=own_{name}" for name in source]
    exports += [f"{name}=ucrtbase.{name}" for name in found if name not in source]
    link(
        SHIM.decode(),
        "\n".join([*declared, *source.values()]),
        {"ucrtbase": UNARY + BINARY},
        *("/dll", "/noentry", *(f"/export:{each}" for each in exports)),
    )
    for file in set().union(*found.values()):
        file.write_bytes(file.read_bytes().replace(LIBRARY, SHIM))


if __name__ == "__main__":
    main()
