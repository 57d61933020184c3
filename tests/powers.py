"""A function that calls another, both so small that they compile at once."""

from yehu_server.compile.jit import Native, compiled


@compiled
def raised(number: float, times: int) -> float:
    product = 1.0
    for _ in range(times):
        product *= number
    return product


def cubed(number: float) -> float:
    return raised(number, 3)


def cube() -> Native:
    """The function as after a start: nothing in this process has compiled or loaded it."""
    return Native(cubed)
