"""No index of a parameter stands where a slot of the engine does, nor the reverse.

Both are plain whole numbers to compiled code, and many have one name in
``player.parameter_indices`` and another meaning in ``controls.slots``; so sources are checked here.
"""

import ast
from functools import cache
from pathlib import Path

from yehu_server.compile.cache_folder import SOURCE_FOLDERS
from yehu_server.core.controls.record import CONTROLS
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.midi.record import MIDI
from yehu_server.core.player.parameter_indices import PARAMETER_COUNT
from yehu_server.core.player.record import PLAYER

PACKAGE = Path(__file__).parents[3] / "yehu_server"
SOURCES = [
    path for folder in (*SOURCE_FOLDERS, "playing") for path in (PACKAGE / folder).rglob("*.py")
]
INDICES_MODULE = "yehu_server.core.player.parameter_indices"
SLOTS_MODULE = "yehu_server.core.controls.slots"
INDEX, SLOT = "an index", "a slot"
OTHER = {INDEX: SLOT, SLOT: INDEX}
MAPS = {"INDEX": INDEX, "SLOT": SLOT, "SLOT_OF": SLOT}  # from an address, or an index
BY_INDEX = {
    "SLOT_OF",
    "IS_PLAYER_CONTROLLED",
    "IS_ENGINES",
    "SMOOTH_MS",
    "LOWEST",
    "HIGHEST",
}  # vectors
POSTED = {"RAMP": SLOT, **dict.fromkeys(("WRITE", "HOLD", "EXPRESS", "SET", "LOAD"), INDEX)}
LISTS = ("target", "values_index", "values_value")  # of MIDI: indexed by place, not by index


def fields(record, length, kind):
    """The fields of a record that have a number for each index, or slot."""
    return {name: kind for name in record.names if record[name].shape == (length,)}


# By the names that records have in all compiled code.
INDEXED = {
    "c": fields(CONTROLS, SLOTS, SLOT),
    "p": fields(PLAYER, PARAMETER_COUNT, INDEX),
    "m": {name: INDEX for name in fields(MIDI, PARAMETER_COUNT, INDEX) if name not in LISTS},
}
INDEXED |= {"controls": INDEXED["c"], "player": INDEXED["p"]}


class Module:
    """What the names of a module stand for."""

    def __init__(self, text: str) -> None:
        self.nodes = [*ast.walk(ast.parse(text))]
        self.kinds = {"index": INDEX, "slot": SLOT}
        self.vectors: dict[str, str] = {}
        self.imported: dict[str, tuple[str, str]] = {}
        self.twice: list[tuple[int, str]] = []
        self.in_event = {
            id(inside)
            for node in self.nodes
            if isinstance(node, ast.FunctionDef)
            and "kind" in {argument.arg for argument in node.args.args}
            for inside in ast.walk(node)
            if isinstance(inside, ast.Name) and inside.id == "index"
        }  # of one kind of event it is a slot
        for node in self.nodes:
            if isinstance(node, ast.ImportFrom):
                self._take(node)
        for node in self.nodes:
            if isinstance(node, ast.Assign):
                self._assign(node.targets[0], node.value)

    def _take(self, node: ast.ImportFrom) -> None:
        for alias in node.names:
            name, module = alias.asname or alias.name, node.module or ""
            before = self.imported.get(name)
            if {module, before and before[0]} == {INDICES_MODULE, SLOTS_MODULE}:
                self.twice.append((node.lineno, f"{name} is an index and a slot"))
            self.imported[name] = module, alias.name
            if module in (INDICES_MODULE, SLOTS_MODULE):
                own = INDEX if module == INDICES_MODULE else SLOT
                if alias.name in BY_INDEX:
                    self.vectors[name] = own
                elif alias.name in numbers_of(module):
                    self.kinds[name] = own

    def _assign(self, target: ast.expr, value: ast.expr) -> None:
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
            for each, its in zip(target.elts, value.elts, strict=True):
                self._assign(each, its)
        elif isinstance(target, ast.Name):
            inside = {
                self.kind_of(node)
                for node in ast.walk(value)
                if isinstance(node, ast.Subscript)
                and isinstance(node.value, ast.Name)
                and node.value.id in MAPS
            }
            if len(inside) == 1 and isinstance(value, ast.Subscript | ast.Call):
                self.kinds[target.id] = inside.pop() or ""

    def kind_of(self, node: ast.expr) -> str | None:
        """Whether an expression is an index or a slot, if that is plain."""
        if isinstance(node, ast.Name):
            return None if id(node) in self.in_event else self.kinds.get(node.id)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            module = ".".join(self.imported.get(node.value.id, ()))
            kind = {INDICES_MODULE: INDEX, SLOTS_MODULE: SLOT}.get(module)
            return kind if kind and node.attr in numbers_of(module) else None
        if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name):
            return MAPS.get(node.value.id) or self.kinds.get(node.value.id)
        return None


def numbers_of(module: str) -> set[str]:
    """The names in a module that are indices, or slots."""
    if module not in KNOWN:
        KNOWN[module] = set()  # while it is read
        path = PACKAGE.parent / f"{module.replace('.', '/')}.py"
        read = Module(path.read_text(encoding="utf-8"))
        KNOWN[module] = {name for name in read.kinds if name.isupper()} | {"SILENCE"}
    return KNOWN[module]


KNOWN: dict[str, set[str]] = {}


def places(module: Module, own: str):
    """Each place for an index or a slot: its line, which of both, the expression there."""
    for node in module.nodes:
        if isinstance(node, ast.Subscript):
            kind = kind_of_index(module, node.value)
            if kind:
                yield node.lineno, kind, node.slice
        elif isinstance(node, ast.Call):
            given = [*node.args, *(word.value for word in node.keywords)]
            names = {getattr(each, "id", getattr(each, "attr", None)) for each in given}
            for kind in {POSTED[name] for name in names & set(POSTED)}:
                yield from ((node.lineno, kind, each) for each in given)
            if isinstance(node.func, ast.Name):
                called = module.imported.get(node.func.id, (own, node.func.id))
                for parameter, each in zip(functions().get(called, []), node.args, strict=False):
                    if parameter in ("index", "slot"):
                        yield node.lineno, INDEX if parameter == "index" else SLOT, each


def kind_of_index(module: Module, value: ast.expr) -> str | None:
    """What an array is indexed by, if that is known."""
    if isinstance(value, ast.Attribute) and isinstance(value.value, ast.Name):
        return INDEXED.get(value.value.id, {}).get(value.attr)
    return module.vectors.get(value.id) if isinstance(value, ast.Name) else None


@cache
def all_modules() -> dict[str, Module]:
    return {
        ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts): Module(
            path.read_text(encoding="utf-8")
        )
        for path in SOURCES
    }


@cache
def functions() -> dict[tuple[str, str], list[str]]:
    """The parameters of each function of all modules."""
    return {
        (name, node.name): [argument.arg for argument in node.args.args]
        for name, module in all_modules().items()
        for node in module.nodes
        if isinstance(node, ast.FunctionDef)
    }


def mixed(module: Module, own: str = "") -> list[str]:
    """Where a module takes one for the other."""
    found = [
        f"line {line}: {ast.unparse(node)} is {OTHER[kind]}, {kind} is wanted"
        for line, kind, node in places(module, own)
        if module.kind_of(node) == OTHER[kind]
    ]
    return found + [f"line {line}: {what}" for line, what in module.twice]


def test_no_module_takes_an_index_for_a_slot_or_a_slot_for_an_index():
    found = {name: mixed(module, name) for name, module in all_modules().items()}
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_most_places_are_known():
    known = [
        module.kind_of(node) == kind
        for name, module in all_modules().items()
        for _, kind, node in places(module, name)
    ]
    assert sum(known) > 300


INDICES_OF, SLOTS_OF = f"from {INDICES_MODULE} import", f"from {SLOTS_MODULE} import"
TAKE = "from yehu_server.core.controls.ramps import take"


def test_a_mix_up_is_found():
    mixes = [
        f"{INDICES_OF} SPEED as FAST\ncontrols.value[FAST]",
        f"{INDICES_OF} FINGER_POSITION\nc.remaining[FINGER_POSITION[n]]",
        f"{SLOTS_OF} SPEED\np.value[SPEED]",
        "from yehu_server.core.player import parameter_indices\nc.value[parameter_indices.TREMOLO]",
        "VOLUME, PAN = INDEX['/playing/volume'], INDEX['/room/pan']\nc.target[PAN]",
        "def f(c, index):\n    c.slope[index] = 0.0",
        f"{SLOTS_OF} POSITION, SIDE\n{INDICES_OF} POSITION",
        f"{SLOTS_OF} LOWEST\nLOWEST[INDEX['/bow/force']]",
        "self.post(commands.RAMP, index=INDEX[address])",
        f"{SLOTS_OF} GAIN\nemit(m, 0, frame, WRITE, GAIN, 0.0, 0.0)",
        f"{INDICES_OF} SPEED\n{TAKE}\ntake(c, SPEED, 0.1, 0)",
    ]
    assert [text for text in mixes if len(mixed(Module(text))) != 1] == []
