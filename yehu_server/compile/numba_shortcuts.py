"""What numba does again for each operation of each function, done once.

Imported before anything is compiled. What is compiled stays the same, to the byte; it takes two
thirds of the time.
"""

import contextlib
from typing import Any

from numba import types
from numba.core import (
    base,
    errors,
    event,
    ir,
    lowering,
    postproc,
    targetconfig,
    transforms,
    typeinfer,
)
from numba.core.types.functions import BaseFunction

_resolve = BaseFunction.get_call_type


def _flags() -> tuple[tuple[str, str], ...]:
    """The options of the function that is being compiled."""
    flags = targetconfig.ConfigStack.top_or_none()
    if flags is None:
        return ()
    return tuple((name, str(value)) for name, value in flags._values.items())  # noqa: SLF001


def _resolve_once(function: Any, context: Any, arguments: Any, named: Any) -> Any:
    """The signature of a function of numba's own, for arguments of some types.

    Else each sum of two numbers is tried as one of strings, lists, sets, dates and arrays.
    """
    known = function.__dict__.setdefault("_known", {})
    key = context, _without_values(function, arguments), tuple(named.items()), _flags()
    if key in known:
        signature, implementation = known[key]
        function._impl_keys[signature.args] = implementation  # noqa: SLF001
        return signature
    signature = _resolve(function, context, arguments, named)
    known[key] = signature, function.get_impl_key(signature)
    return signature


def _without_values(function: Any, arguments: Any) -> tuple[Any, ...]:
    """The types of a function's arguments: of numbers without their values, if it goes by none.

    It may go by them if all are known.
    """
    plain = tuple(types.unliteral(each) for each in arguments)
    if (
        all(isinstance(each, (types.Number, types.Boolean)) for each in plain)
        and any(each is given for each, given in zip(plain, arguments, strict=True))
        and not any(template.prefer_literal for template in function.templates)
    ):
        return plain
    return tuple(arguments)


_without_variables: set[type] = set()
_list_any = ir.Inst._rec_list_vars  # noqa: SLF001


def _list_variables(instruction: Any, value: Any) -> list[Any]:
    """The variables in what an instruction of numba's has: half of all these values are none."""
    kind = type(value)
    if kind is dict:
        values = value.values()
    elif kind in (list, tuple):
        values = value
    else:
        found: list[Any] = _list_any(instruction, value)
        if not isinstance(value, (ir.Var, ir.Inst, list, tuple, dict)):
            _without_variables.add(kind)
        return found
    variables = []
    for each in values:
        kind = type(each)
        if kind is ir.Var:
            variables.append(each)
        elif kind not in _without_variables:
            variables += _list_variables(instruction, each)
    return variables


_size_of = base.BaseContext.get_abi_sizeof
_sizes: dict[str, int] = {}  # of a type's name, in this process' one target


def _size_once(context: Any, kind: Any) -> int:
    """The bytes of a type, for which numba has LLVM read a whole module."""
    name = str(kind)
    if name not in _sizes:
        _sizes[name] = _size_of(context, kind)
    return _sizes[name]


_find_function = base.BaseContext.get_function


def _find_function_at_once(context: Any, function: Any, *arguments: Any, **named: Any) -> Any:
    """An implementation: of arrays like another type of array, for all of which numba looks anew.

    There are none; numba finds that out after two errors and a look at all of its modules.
    """
    if function == "__array__":
        raise NotImplementedError
    return _find_function(context, function, *arguments, **named)


_process = postproc.PostProcessor.run


def _process_last(processor: Any, emit_dels: bool = False, **named: Any) -> None:
    """Find out how long variables live only where this is used: at last, to release them."""
    if emit_dels or processor.func_ir.is_generator:
        _process(processor, emit_dels, **named)
    else:
        of = processor.func_ir
        of.blocks = transforms.canonicalize_cfg(of.blocks)


_explain = lowering.new_error_context


class _ErrorContext:
    """Adds to an error what numba was at, as numba's own does: a generator for each operation."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        self._arguments, self._named = arguments, named

    def __enter__(self) -> None:
        """Do nothing yet."""

    def __exit__(self, _kind: object, error: BaseException | None, _traceback: object) -> None:
        if error is not None:
            with _explain(*self._arguments, **self._named):
                raise error


class _Colourless:
    """No colours for errors: there are thousands that nobody reads; each asked the terminal."""

    def __getattr__(self, _what: str) -> type[str]:
        return str


def _ignore_event(*_arguments: Any, **_named: Any) -> None:
    """Replace events, some for each call of LLVM, and a log, which nothing reads."""


def _no_event(*_arguments: Any, **_named: Any) -> Any:
    return contextlib.nullcontext()


for _owner, _name, _instead in (
    (BaseFunction, "get_call_type", _resolve_once),
    (ir.Inst, "_rec_list_vars", _list_variables),
    (base.BaseContext, "get_abi_sizeof", _size_once),
    (errors, "_termcolor_inst", _Colourless()),
    (base.BaseContext, "get_function", _find_function_at_once),
    (postproc.PostProcessor, "run", _process_last),
    (lowering, "new_error_context", _ErrorContext),
    (typeinfer, "new_error_context", _ErrorContext),
    (event, "start_event", _ignore_event),
    (event, "end_event", _ignore_event),
    (event, "trigger_event", _no_event),
):
    setattr(_owner, _name, _instead)
