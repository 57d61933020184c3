"""The processor's clocks, and denormal numbers, which the audio thread flushes to zero."""

import platform
import time

import llvmlite.binding as llvm
import numba
import numpy as np
import pytest
from llvmlite import ir
from sound import bow, run

from yehu_server.core.engine import processor
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec

RATE = 22050
SMALLEST = np.finfo(np.float64).smallest_normal
MOVING = ["u", "q", "zeta", "z", "s_1", "s_2", "history"]  # what a ringing instrument holds

knows_how = pytest.mark.skipif(
    platform.machine() not in processor.X86 | processor.ARM,
    reason="denormals are left alone on this processor",
)


@numba.njit
def flush():
    return processor.flush_denormals()


@numba.njit
def restore(mode):
    processor.restore_denormals(mode)


@numba.njit
def monotonic_ns():
    return processor.monotonic_ns()


@numba.njit
def thread_cpu_ns():
    return processor.thread_cpu_ns()


def keeps_denormals() -> tuple[bool, bool]:
    """Whether this thread keeps denormal results, and denormal operands."""
    small, large = np.array([SMALLEST, 5e-324]), np.array([0.125, 2.0**60])
    product = small * large
    return bool(product.view(np.int64)[0]), bool(product.view(np.int64)[1])


def control() -> int:
    """The floating-point control bits of this thread, without its status flags."""
    mode = flush()
    restore(mode)
    return mode & ~0x3F if platform.machine() in processor.X86 else mode


# ---------------------------------------------------------------- clocks


def test_the_clocks_are_pythons_own_and_a_threads_counts_what_it_computes_and_not_what_it_waits():
    for ours, its in ((monotonic_ns, time.monotonic_ns), (thread_cpu_ns, time.thread_time_ns)):
        ours()
        for _ in range(100):
            before, now, after = its(), ours(), its()
            assert before <= now <= after
    time.sleep(0.05)
    assert thread_cpu_ns() - now < 40e6


# ---------------------------------------------------------------- the mode of a thread


@knows_how
def test_denormals_count_as_zero_from_flush_to_restore_which_may_be_nested():
    assert keeps_denormals() == (True, True)
    outer = flush()
    try:
        restore(flush())
        flushed = keeps_denormals()
    finally:
        restore(outer)
    assert flushed == (False, False)
    assert keeps_denormals() == (True, True)


@knows_how
@pytest.mark.parametrize("is_flushed", [False, True])
def test_a_block_leaves_the_threads_mode_as_it_was(is_flushed):
    instrument, out = Instrument(InstrumentSpec(RATE)), np.zeros(256, np.float32)
    instrument.write("/bow/side", 1.0)
    instrument.write("/bow/speed", 0.2)
    instrument.process(out)
    mode = flush()
    try:
        if not is_flushed:
            restore(mode)
        before = control()
        for _ in range(10):
            instrument.process(out)
        instrument.silence()
        instrument.process(out)
        after = control()
        kept = keeps_denormals()
    finally:
        restore(mode)
    assert after == before
    assert kept == (not is_flushed, not is_flushed)


# ---------------------------------------------------------------- what it is for


def denormals(instrument: Instrument) -> int:
    """Number of denormal values in the state."""
    state = instrument._rig["state"][0]
    return sum(
        int(((part != 0.0) & (np.abs(part) < SMALLEST)).sum())
        for part in (np.asarray(state["motion"][name]) for name in MOVING)
    )


def ringing() -> Instrument:
    """An instrument that rings after a bow stroke."""
    instrument = Instrument(InstrumentSpec(RATE))
    bow(instrument)
    assert np.abs(run(instrument, RATE // 4)).max() > 0.001
    for address in ("/bow/side", "/bow/speed"):
        instrument.write(address, 0.0, ramp_ms=0.0)
    run(instrument, RATE // 10)
    return instrument


def scale(instrument: Instrument, factor: float) -> None:
    for name in (*MOVING, "Delta_u"):
        instrument._rig["state"]["motion"][name] *= factor


@knows_how
def test_a_string_that_dies_away_never_holds_a_denormal():
    instrument = ringing()
    instrument.write("/bow/speed", 0.1)  # in the air, or it would fall asleep
    scale(instrument, 1e-295)  # as after minutes
    assert denormals(instrument) == 0
    sizes = []
    for _ in range(150):
        run(instrument, RATE // 10)
        assert denormals(instrument) == 0
        sizes.append(float(np.abs(instrument._rig["state"]["motion"]["u"]).max()))
    assert sizes[0] > 1e-300  # it rang at first
    # And it came to where denormals would be. There its rounding keeps it from dying altogether,
    # at 60 to 500 times the smallest normal number: that hangs on the processor.
    assert sizes[-1] < 1e4 * SMALLEST


# ---------------------------------------------------------------- other processors


def assembly(monkeypatch: pytest.MonkeyPatch, machine: str, triple: str) -> str:
    """Assembly of a function that flushes and restores, for a machine."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    try:
        target = llvm.Target.from_triple(triple)
    except RuntimeError as error:
        pytest.skip(f"this LLVM does not compile for {triple}: {error}")
    monkeypatch.setattr(platform, "machine", lambda: machine)
    word = ir.IntType(64)
    module = ir.Module()
    for name, returns, arguments in [("flush", word, []), ("restore", ir.VoidType(), [word])]:
        function = ir.Function(module, ir.FunctionType(returns, arguments), name)
        builder = ir.IRBuilder(function.append_basic_block())
        intrinsic = getattr(processor, f"{name}_denormals")
        _, generate = intrinsic._defn(None, *arguments)
        result = generate(None, builder, None, function.args)
        if returns == word:
            builder.ret(result)
        else:
            builder.ret_void()
    code = llvm.parse_assembly(str(module))
    code.triple = triple
    code.verify()
    return target.create_target_machine(opt=2).emit_assembly(code).lower()


ARM = [("aarch64", "aarch64-unknown-linux-gnu"), ("arm64", "arm64-apple-macosx11.0.0")]
X86 = [("x86_64", "x86_64-unknown-linux-gnu"), ("AMD64", "x86_64-pc-windows-msvc")]


@pytest.mark.parametrize(("machine", "triple"), [*ARM, *X86, ("riscv64", "riscv64-unknown-linux")])
def test_on_each_processor_they_set_its_bits_and_write_them_back(monkeypatch, machine, triple):
    code = assembly(monkeypatch, machine, triple)
    found = {
        (word, code.count(word))
        for word in ("mrs", "msr\tfpcr", "stmxcsr", "ldmxcsr", "fcsr", "call")
        if word in code
    }
    if (machine, triple) in ARM:
        assert found == {("mrs", 1), ("msr\tfpcr", 2)}
        assert f"#0x{1 << 24:x}" in code or f"#{1 << 24}" in code  # flush
    elif (machine, triple) in X86:
        assert found == {("stmxcsr", 1), ("ldmxcsr", 2)}
        assert f"${0x8040}" in code  # FTZ is bit 15, DAZ bit 6
    else:
        assert not found
