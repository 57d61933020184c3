"""Files of settings: config, presets, mappings, ensembles."""

import contextlib
import functools
import io
import math
from dataclasses import replace
from pathlib import Path

from fuzz.target import scratch, target, words, written
from interpreted import Leader

from yehu_server import cli
from yehu_server.cli.config import parse
from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.core.midi.events import CONTROL
from yehu_server.core.midi.tables import MAX_BINDS
from yehu_server.errors import EnsembleError, MappingError, ParameterError, PresetError
from yehu_server.params.preset_file import SAVED
from yehu_server.params.table import BY_ADDRESS, TABLE, find
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping, with_bases
from yehu_server.playing.mapping_file import (
    MappingFile,
    mapping_file_of_json,
    read_mapping_file,
    text_of,
)
from yehu_server.playing.mapping_writer import as_toml, canonical, edited
from yehu_server.playing.preset_folders import Presets, read_preset
from yehu_server.playing.sources import is_address
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, STANDARD_A4, RangePolicy
from yehu_server.scores.ensemble_file import read_ensemble

ADDRESSES = tuple(f'"{address}"'.encode() for address in list(BY_ADDRESS)[::4])
TOML = words(b"1e999|nan|true|\"\"\"|'''|[[|]]|{ a = 1 }|\\u0000|1979-05-27")


@functools.cache
def parser():
    return cli._parser()


@target(
    "config",
    ParameterError,
    words=(
        *words(
            b"midi-in = [|audio-device = |osc = |blocksize = |set = { |\n[set]\n|rate = ",
            b"http = false|config = |help = true",
        ),
        *ADDRESSES,
        *TOML,
    ),
)
def config(data: bytes) -> None:
    """A config file is options that serve takes, a ParameterError, or a line and exit code 2."""
    words = ["serve", "--config", str(written(data, "config.toml"))]
    out, err = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            parse(words, parser())
    except SystemExit as end:
        code = end.code
    else:
        code = None
    if code is not None:
        assert code == 2
        assert err.getvalue().count("\n") == 1
    assert not out.getvalue()


@target(
    "preset",
    PresetError,
    words=(
        *words(b"version = 1\n|about = |program = 5\n|[values]\n|values = {"),
        *ADDRESSES,
        *TOML,
    ),
    also=("presets/tremolo.toml",),
)
def preset(data: bytes) -> None:
    """A preset has values in range, and keeps what is saved into it; or is a PresetError."""
    own = scratch() / "presets"
    own.mkdir(exist_ok=True)
    path = own / "fuzzed.toml"
    path.write_bytes(data)
    read = read_preset(path)
    for address, value in read.values.items():
        assert find(address).lo <= value <= find(address).hi
    assert read.program is None or 1 <= read.program <= 128
    assert read.about.count("\n") == 0
    read.remarks()
    presets = Presets(own)
    assert presets.load("fuzzed") == Presets(own).load("fuzzed")
    values = {param.address: param.lo for param in TABLE}
    presets.save("fuzzed", values)
    again = Presets(own).load("fuzzed")
    for address in SAVED:
        assert again.values[address] == float(f"{values[address]:.7g}"), address
    assert {**read.values, **again.values} == dict(again.values)
    assert (again.about, again.program, again.unknown) == (read.about, read.program, read.unknown)


@target(
    "ensemble",
    EnsembleError,
    words=(
        *words(
            b"\n[[part]]\n|[room]\n|room = |size = |channel = |track = |name = |preset = ",
            b"instrument = |section = |seed = |pan = |distance = |gain = |set = { ",
        ),
        *ADDRESSES,
        *TOML,
    ),
)
def ensemble(data: bytes) -> None:
    """An ensemble has parts that play something, values in range; or is an EnsembleError."""
    read = read_ensemble(written(data, "ensemble.toml"))
    assert 1 <= len(read.parts) <= MAX_PARTS
    for part in read.parts:
        assert part.channel is not None or part.track is not None
        assert "\n" not in (part.name or "")
        for address, value in part.settings:
            assert find(address).lo <= value <= find(address).hi
    assert not read.room or "/room/size" in dict(read.room)


MAPPING_WORDS = (
    *words(
        b"name = |about = |base = |mpe = true\n|[start]\n|\n[[bind]]\n|source = |target = ",
        b'input = [|span = [|curve = "exp"|curve = [[0, 0], [1, 1]]|invert = true|smoothing = ',
        b'channel = |soft = true|alone = true|"cc 1"|"cc 1/33"|"bend"|"nrpn 5"|"/a/b"',
    ),
    *ADDRESSES,
    *TOML,
)


MAX_WRITTEN = 4000  # characters; tomlkit is slow


def meant(contents: MappingFile) -> MappingFile:
    """The mapping without what is implied: without a base there is no MPE."""
    return contents if contents.base is not None else replace(contents, mpe=contents.mpe or None)


def check_controls(binds: tuple[Bind, ...]) -> None:
    """Check that named controls have positions within 0 to 1, whatever they are sent."""
    addresses = {bind.source for bind in binds if is_address(bind.source)}
    if not addresses or len(binds) > MAX_BINDS:
        return
    leader, controls = Leader(), Controls()
    options = {"tuning": EQUAL, "a4": STANDARD_A4, "policy": RangePolicy.TRANSPOSE}
    with contextlib.suppress(ParameterError):  # more points than there is room for
        leader.begin_part(make_tables(Mapping("", binds), controls, **options))
        for address in addresses:
            for argument in (0.0, 0.5, 1e30, -1e30):
                leader.interpret(0, CONTROL, controls.number(address), argument, 0.0)
                positions = leader.midi["control_position"]
                assert ((positions >= 0.0) & (positions <= 1.0)).all(), address


def check(contents: MappingFile, path: Path, text: str) -> None:
    """Check that binds move their targets within range, and that it reads the same when written."""
    for address, value in contents.start:
        assert find(address).lo <= value <= find(address).hi
    for bind in contents.binds:
        lo, hi = find(bind.target).lo, find(bind.target).hi
        room = 1e-9 * (hi - lo)
        for position in (0.0, 0.3, 1.0):
            value = bind.from_unit(position)
            assert lo - room <= value <= hi + room, (bind, value)
            assert 0.0 <= bind.to_unit(value) <= 1.0, (bind, value)
        bind.terms, bind.curve_name  # noqa: B018 - are worked out as they are read
    check_controls(contents.binds)
    if len(text) > MAX_WRITTEN:
        return
    for again in (as_toml(contents), canonical(contents, text), edited(contents, text, [], [])):
        assert meant(read_mapping_file(path, again)) == meant(contents)
    less = edited(contents, text, contents.binds[:1], contents.binds[:1])
    assert set(read_mapping_file(path, less).binds) == set(contents.binds)
    with contextlib.suppress(MappingError):  # of its base
        mapping = with_bases(path, contents)
        assert all(math.isfinite(value) for _, value in mapping.start)


@target("mapping", MappingError, words=MAPPING_WORDS, also=("mappings/wind.toml",))
def mapping(data: bytes) -> None:
    """A mapping has binds within range and reads the same when written, or is a MappingError."""
    path = written(data, "mapping.toml")
    check(read_mapping_file(path), path, text_of(path))


@target(
    "mapping-json",
    MappingError,
    words=(
        *words(
            b'{"bind": [|"source": |"target": |"from": |"to": |"span": |"curve": |null|1e999|"cc 1"'
        ),
        *ADDRESSES,
    ),
)
def mapping_json(data: bytes) -> None:
    """JSON as ``mappings show`` prints it is a mapping under the same law."""
    path = written(data, "mapping.json")
    text = text_of(path)
    contents = mapping_file_of_json(path, text)
    check(contents, path, as_toml(contents))
