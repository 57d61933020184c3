"""The texture of rosin on the hair: friction that varies along the bow.

Both friction coefficients are multiplied by 1 + depth * texture(y), where y is the place on the
hair that the string touches. It stands still while the string sticks and runs while it slips. So
the noise follows the bow's speed, stops with it, and the same hair makes the same noise. Bristles
keep their stiffness, so friction loses energy as before, whatever the texture.

Differs: [Yehu] has an even hair.
"""

import math

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import pseudorandom
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import BOW, STRINGS, TEXTURE, Y_B
from yehu_server.core.physics.records import Array, Contacts, Model, Motion

MIN_FRICTION_FACTOR = 0.05  # of the friction coefficients; without friction the law has no scale


@compiled
def texture(s: Motion, place: float, hair: int) -> float:
    """The texture, -1 to 1, at a place counted in grains; smooth between a hair's random numbers.

    Those of the grain under the string are kept: it sticks to the same one most of the time.
    """
    cell = math.floor(place)
    part = place - cell
    first = (int(hair) << 32) + int(cell)
    if s.grain != first + 1:
        s.grain = first + 1
        s.rough[0], s.rough[1] = pseudorandom(first), pseudorandom(first + 1)
    return float(s.rough[0] + (s.rough[1] - s.rough[0]) * (part * part * (3.0 - 2.0 * part)))


@compiled
def grip(m: Model, s: Motion, c: Contacts, control: Array, now: int) -> float:
    """Factor on the friction coefficients where the hair touches the string; 1 if it is even.

    The place on the hair is where it was at time step n: `Y_B` less how far the string, and the
    hair with it, is carried along.
    """
    depth = control[TEXTURE]
    if depth == 0.0:
        return 1.0
    i = c.string[BOW]
    carried = interpolate(s.u[now, i], c.first[BOW], c.weights[BOW]) + s.zeta[now, i]
    place = (control[Y_B] - carried) * m.per_grain
    return float(max(MIN_FRICTION_FACTOR, 1.0 + depth * texture(s, place, STRINGS * m.hair + i)))
