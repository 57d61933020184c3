"""numba's compiler without what our functions need not: a third of its time, the same code."""

from typing import Any

from numba.core import compiler, typed_passes, untyped_passes
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.transforms import canonicalize_cfg

# Without those for closures, `with`, raised exceptions, literal loops, array expressions and
# parallel loops.
PASSES = (
    untyped_passes.TranslateByteCode,
    untyped_passes.FixupArgs,
    untyped_passes.IRProcessing,
    untyped_passes.RewriteSemanticConstants,
    untyped_passes.DeadBranchPrune,
    untyped_passes.GenericRewrites,
    untyped_passes.ReconstructSSA,
    untyped_passes.DeadBranchPrune,
    typed_passes.NopythonTypeInference,
    typed_passes.PreLowerStripPhis,
    typed_passes.InlineOverloads,
    typed_passes.IRLegalization,
    typed_passes.NativeLowering,
    typed_passes.NoPythonBackend,
)


class Passes(PassManager):  # type: ignore[misc]
    """Runs passes, and nothing between them but what changed blocks need."""

    def __init__(self) -> None:
        super().__init__("yehu")
        for each in PASSES:
            self.add_pass(each, each.__name__)
        self.finalize()

    @global_compiler_lock  # type: ignore[untyped-decorator]
    def run(self, state: Any) -> None:
        """Compile a function, with numba's name for this."""
        for each, _ in self.passes:
            known = _pass_registry.get(each)
            known.pass_inst.analysis = self._analysis
            if known.pass_inst.run_pass(state) and known.mutates_CFG:
                state.func_ir.blocks = canonicalize_cfg(state.func_ir.blocks)


class LeanCompiler(compiler.CompilerBase):  # type: ignore[misc]
    """numba's compiler with these passes only."""

    def __init__(self, typing: Any, target: Any, *others: Any) -> None:
        # A search for a definition that fails searches for new ones then.
        typing.refresh = target.refresh = lambda: None
        super().__init__(typing, target, *others)
        for context in (typing, target, self.state.targetctx):
            context.__dict__.pop("refresh", None)

    def define_pipelines(self) -> list[Any]:
        """Return the one way to compile, with numba's name for this."""
        return [Passes()]
