"""The limiter of the mix: peaks are bent, so that no sample exceeds its ceiling. Compiled."""

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import power, tanh

# Of samples. The wave between them, by which converters and codecs clip, rises above them: of a
# quartet driven by 12, 18 and 24 dB by 0.4, 0.9 and 2.3 dB.
CEILING = power(10.0, -1.0 / 20.0)
# A sample beyond these is an error: rounding takes the limiter's hardly beyond 1.
LARGEST, LARGEST_LIMITED = 1e14, 2.0


@compiled
def limit(x: float, soft: float) -> float:
    """Soft clipping: above `soft` (0 to 1) peaks are bent, so that none exceeds `CEILING`.

    Odd, memoryless, so that no note waits for a look-ahead, and smooth where `soft` is below the
    ceiling. Real time: safe.
    """
    size = abs(x)
    if size <= min(soft, CEILING):
        return x
    room = CEILING - soft
    bent = CEILING if room <= 0.0 else soft + room * tanh((size - soft) / room)
    return bent if x > 0.0 else -bent


@compiled
def is_valid(sample: float, limited: float) -> bool:
    """Whether a sample, and what the limiter made of it, are numbers of any use; NaN is not."""
    return abs(sample) <= LARGEST and abs(limited) <= LARGEST_LIMITED
