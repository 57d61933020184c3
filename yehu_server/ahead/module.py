"""Join compiled functions into one LLVM module that holds no Python, for one of several machines.

numba's functions call Python only to report an exception. These raise none, so what would call it
stops the program instead, and falls away where LLVM sees that it is never reached.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from llvmlite import binding

from yehu_server.compile import levels
from yehu_server.compile.jit import Native, with_called
from yehu_server.core.engine.processor import ARM_BIT, X86_BITS
from yehu_server.errors import YehuError

PAGE_FEATURES = "+simd128,+bulk-memory,+nontrapping-fptoint,+sign-ext,+mutable-globals"


@dataclass(frozen=True)
class Target:
    """A machine, by LLVM's names."""

    triple: str
    cpu: str = ""
    features: str = ""
    reloc: str = "pic"
    # What stands before the names of functions, where several versions are linked together.
    prefix: str = ""
    # Whether the functions are for the library alone that they are linked into.
    is_inner: bool = False

    @property
    def is_page(self) -> bool:
        """Whether it is WebAssembly, which has no mode that flushes denormal numbers."""
        return self.triple.startswith("wasm")

    @property
    def is_arm(self) -> bool:
        """Whether its processor has ARM's mode for that, of 64 bits."""
        return self.triple.startswith(("aarch64", "arm64"))

    @property
    def has_clocks(self) -> bool:
        """Whether its `clock_gettime` is the one that this machine's code calls."""
        return self.is_page or "linux" in self.triple or self.triple == binding.get_process_triple()

    def machine(self) -> Any:
        """LLVM's code generator for it."""
        binding.initialize_all_targets()
        binding.initialize_all_asmprinters()
        return binding.Target.from_triple(self.triple).create_target_machine(
            cpu=self.cpu, features=self.features, opt=3, reloc=self.reloc, codemodel="default"
        )


PAGE = Target("wasm32-unknown-unknown", "", PAGE_FEATURES, reloc="static")


def here() -> Target:
    """The machine that runs this, with the instructions of the level that it compiles for."""
    return Target(levels.triple(), levels.cpu(levels.level()))


# What the machine's C library gives, or the page.
CLOCK, OTHER_CLOCK = "clock_gettime", "yehu_clock"  # the program has the other where one is wanted
OUTSIDE = {CLOCK, OTHER_CLOCK, "memcpy", "memmove", "memset", "sqrt"}  # the last, an instruction
LAYOUT = re.compile(r'^target datalayout = ".*"', re.MULTILINE)
TRIPLE = re.compile(r'^target triple = ".*"', re.MULTILINE)
TRAP = "declare void @llvm.trap()"
PYTHONS = re.compile(
    r"^declare (?P<returns>[^@\n]*)@(?P<name>(?:Py|NRT_|numba_)\w+)\((?P<takes>[^)\n]*)\).*$",
    re.MULTILINE,
)
PYTHONS_GLOBAL = re.compile(r"^@(?P<name>Py\w+) = external .*global i8$", re.MULTILINE)
COMMON = re.compile(r"= common ((?:local_)?unnamed_addr )?global")
# numba's count of an array's references. None has an owner here; on x86 it is an intrinsic.
COUNTED_DOWN = re.compile(
    r"(?P<into>%\S+) = (?:tail )?call i8 @llvm\.x86\.atomic\.sub\.cc\.i64"
    r"\(ptr (?:nonnull )?(?P<at>%\S+), i64 (?P<by>\d+), i32 \d+\)"
)
MODE = re.compile(r"^ *(?:tail )?call void @llvm\.x86\.sse\.(?:st|ld)mxcsr\(.*\)$", re.MULTILINE)
# ARM's mode in the place of x86's, whose two bits stand for the one that flushes denormal numbers.
MODE_DECLARED = re.compile(r"^declare void @llvm\.x86\.sse\.(?:st|ld)mxcsr\(.*$", re.MULTILINE)
MODE_OF_ARM = f"""
declare i64 @llvm.aarch64.get.fpcr()
declare void @llvm.aarch64.set.fpcr(i64)
define internal void @llvm_read_mode(ptr %into) {{
  %mode = call i64 @llvm.aarch64.get.fpcr()
  %word = trunc i64 %mode to i32
  store i32 %word, ptr %into, align 4
  ret void
}}
define internal void @llvm_write_mode(ptr %from) {{
  %word = load i32, ptr %from, align 4
  %asked = and i32 %word, {X86_BITS}
  %flushes = icmp ne i32 %asked, 0
  %others = and i32 %word, {~X86_BITS}
  %flushing = or i32 %others, {ARM_BIT}
  %now = select i1 %flushes, i32 %flushing, i32 %word
  %mode = zext i32 %now to i64
  call void @llvm.aarch64.set.fpcr(i64 %mode)
  ret void
}}
"""
# LLVM calls it for products of 128 bits, which WebAssembly has none of.
MULTIPLY = "__multi3"
MULTIPLY_128 = f"""
define hidden void @{MULTIPLY}(ptr %into, i64 %a, i64 %a_high, i64 %b, i64 %b_high) {{
  %a_low = and i64 %a, 4294967295
  %a_up = lshr i64 %a, 32
  %b_low = and i64 %b, 4294967295
  %b_up = lshr i64 %b, 32
  %low = mul i64 %a_low, %b_low
  %cross = mul i64 %a_up, %b_low
  %other = mul i64 %a_low, %b_up
  %up = mul i64 %a_up, %b_up
  %low_up = lshr i64 %low, 32
  %sum = add i64 %cross, %low_up
  %sum_low = and i64 %sum, 4294967295
  %sum_up = lshr i64 %sum, 32
  %middle = add i64 %other, %sum_low
  %middle_up = lshr i64 %middle, 32
  %high_1 = add i64 %up, %sum_up
  %high_2 = add i64 %high_1, %middle_up
  %high_3 = mul i64 %a_high, %b
  %high_4 = mul i64 %a, %b_high
  %high_5 = add i64 %high_2, %high_3
  %high = add i64 %high_5, %high_4
  %product = mul i64 %a, %b
  store i64 %product, ptr %into, align 8
  %at_high = getelementptr i8, ptr %into, i32 8
  store i64 %high, ptr %at_high, align 8
  ret void
}}
"""


def joined(functions: Sequence[Native], target: Target) -> Any:
    """Join functions, and those that they call by symbol, into a module for a machine.

    They keep their names (`Native.name`, behind the target's prefix); all else is internal. Raises
    YehuError where they need what neither a page nor a C library has.
    """
    called = [*with_called(functions)]
    for function in reversed(called):
        # A process that compiles for playing meanwhile goes on from the first one: each
        # finds half of the work done.
        function.keep()
    module, *others = map(_module, called)
    for other in others:
        module.link_in(other)
    machine = target.machine()
    module = binding.parse_assembly(_for_machine(str(module), target, str(machine.target_data)))
    exported = {function.name for function in functions} | {MULTIPLY}
    for symbol in (*module.functions, *module.global_variables):
        if not symbol.is_declaration and symbol.name not in exported:
            symbol.linkage = binding.Linkage.internal
    _drop_unused(module, machine)
    for function in functions:
        entry = module.get_function(function.name)
        entry.name = target.prefix + function.name
        if target.is_inner:
            entry.visibility = binding.Visibility.hidden
    module.verify()
    if strange := set(unresolved(module)) - OUTSIDE:
        raise YehuError(f"compiled code calls {', '.join(sorted(strange))}, which nothing has")
    return module


def unresolved(module: Any) -> list[str]:
    """The functions that a module calls and does not have, in order."""
    return sorted(
        function.name
        for function in module.functions
        if function.is_declaration and not function.name.startswith("llvm.")
    )


def _module(function: Native) -> Any:
    """The module of one function as numba optimised it, with the name that C calls it by."""
    function.keep()
    made = function.made
    # `inspect_llvm()` shows nothing of what came from the cache.
    text = str(made._library._get_module_for_linking())  # noqa: SLF001
    module = binding.parse_assembly(text)
    entry = module.get_function(made.native_name)
    entry.name, entry.linkage = function.name, binding.Linkage.external
    return module


def _for_machine(text: str, target: Target, layout: str) -> str:
    """A module's text, for another machine and without Python."""
    text = LAYOUT.sub(f'target datalayout = "{layout}"', text)
    text = TRIPLE.sub(f'target triple = "{target.triple}"', text)
    text = COMMON.sub("= internal global", text)
    text = PYTHONS_GLOBAL.sub(r"@\g<name> = internal global i8 0", text)
    text = COUNTED_DOWN.sub(_count_down, text)
    text = PYTHONS.sub(_trap, text)
    text += f"\n{TRAP}\n" if TRAP not in text else ""
    if target.is_page:
        return MODE.sub("", text) + MULTIPLY_128
    if target.is_arm and "@llvm.x86.sse." in text:
        text = MODE_DECLARED.sub("", text).replace("@llvm.x86.sse.stmxcsr", "@llvm_read_mode")
        text = text.replace("@llvm.x86.sse.ldmxcsr", "@llvm_write_mode") + MODE_OF_ARM
    return text if target.has_clocks else text.replace(f"@{CLOCK}(", f"@{OTHER_CLOCK}(")


def _count_down(found: re.Match[str]) -> str:
    into = found["into"]
    was, last = (f"%{word}.{into[1:]}" for word in ("was", "last"))
    return (
        f"{was} = atomicrmw sub ptr {found['at']}, i64 {found['by']} seq_cst\n"
        f"  {last} = icmp eq i64 {was}, {found['by']}\n"
        f"  {into} = zext i1 {last} to i8"
    )


def _trap(declared: re.Match[str]) -> str:
    body = "{\n  call void @llvm.trap()\n  unreachable\n}"
    return f"define internal {declared['returns']}@{declared['name']}({declared['takes']}) {body}"


def _drop_unused(module: Any, machine: Any) -> None:
    """Remove what nothing that is exported reaches."""
    builder = binding.create_pass_builder(machine, binding.create_pipeline_tuning_options())
    passes = binding.create_new_module_pass_manager()
    passes.add_simplify_cfg_pass()
    passes.add_global_dead_code_eliminate_pass()
    passes.add_strip_dead_prototype_pass()
    passes.run(module, builder)
