"""Where walls, listener and player of a shoebox room are, and the player's images. Compiled.

Coordinates are in metres: x from the left wall to the right one, y from the wall behind the
listener to the one behind the players, z from the floor up. Sound of an image is what a wall
reflects once: it comes from where a mirror would show the player ([Allen]).
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import cos, exp, sin

Array = Any

SPEED_OF_SOUND = 343.0  # m/s
WALLS = 6
EARS = 2
WIDTH_RATIO, HEIGHT_RATIO = 0.83, 0.62  # of a room, over its length
LISTENER_X, LISTENER_Y = 0.46, 0.31  # over width and length of the room
# Heights of listener and player, who sit; and their largest share of the room's height.
LISTENER_HEIGHT_M, PLAYER_HEIGHT_M = 1.2, 0.8
MAX_LISTENER_HEIGHT_RATIO, MAX_PLAYER_HEIGHT_RATIO = 0.45, 0.3
MIN_WALL_GAP_M = 0.3  # from a player to a wall
EAR_X_M = 0.085  # from the middle of the head
MAX_AZIMUTH = math.pi / 4.0  # direction of a player at pan 1, to the right of straight ahead
REFERENCE_DISTANCE_M = 2.0  # the direct sound of a player there is as loud as the instrument
EAR_DIRECTIVITY = 0.7  # how much more an ear receives from its own side
SABINE = 0.161  # s/m


@compiled_exactly
def volume(size: float) -> float:
    """Volume (m^3) of a room, by its length (m)."""
    return size * size * size * WIDTH_RATIO * HEIGHT_RATIO


@compiled_exactly
def surface(size: float) -> float:
    """Area (m^2) of all walls of a room, by its length (m)."""
    return 2.0 * size * size * (WIDTH_RATIO + HEIGHT_RATIO + WIDTH_RATIO * HEIGHT_RATIO)


@compiled_exactly
def mean_free_path(size: float) -> float:
    """Mean way (m) of sound between two walls [Kuttruff]."""
    return 4.0 * volume(size) / surface(size)


@compiled_exactly
def reflection(size: float, decay: float) -> float:
    """Share of the pressure that a wall reflects, for a decay of 60 dB in a time (s) [Eyring]."""
    return exp(-0.5 * SABINE * volume(size) / (surface(size) * decay))


@compiled_exactly
def diffuse_level(size: float, decay: float) -> float:
    """Amplitude of the reverberant field over direct sound at REFERENCE_DISTANCE_M [Kuttruff]."""
    absorbing = SABINE * volume(size) / decay
    return math.sqrt(16.0 * math.pi * REFERENCE_DISTANCE_M * REFERENCE_DISTANCE_M / absorbing)


@compiled_exactly
def clamp(value: float, lo: float, hi: float) -> float:
    """Clamp a value to bounds."""
    return min(max(value, lo), hi)


@compiled_exactly
def find_images(
    size: float, distance: float, pan: float, decay: float, delays: Array, gains: Array
) -> None:
    """Find when and how loud each ear hears the images of a player, beside the direct sound.

    Of a room's length (m) and decay (s), a player's distance within it (m), and pan, -1 left to 1
    right. Writes delays (s) and amplitudes [shape=(EARS, WALLS)]: later than the direct sound,
    which at REFERENCE_DISTANCE_M has 1.
    """
    width, height = WIDTH_RATIO * size, HEIGHT_RATIO * size
    at_x, at_y = LISTENER_X * width, LISTENER_Y * size
    at_z = min(LISTENER_HEIGHT_M, MAX_LISTENER_HEIGHT_RATIO * height)
    direction = MAX_AZIMUTH * pan
    x = clamp(at_x + distance * sin(direction), MIN_WALL_GAP_M, width - MIN_WALL_GAP_M)
    y = clamp(at_y + distance * cos(direction), MIN_WALL_GAP_M, size - MIN_WALL_GAP_M)
    z = min(PLAYER_HEIGHT_M, MAX_PLAYER_HEIGHT_RATIO * height)
    direct = length(x - at_x, y - at_y, z - at_z)
    reflected = reflection(size, decay)
    for wall in range(WALLS):
        image_x, image_y, image_z = x, y, z
        if wall == 0:
            image_x = -x
        elif wall == 1:
            image_x = 2.0 * width - x
        elif wall == 2:
            image_y = -y
        elif wall == 3:
            image_y = 2.0 * size - y
        elif wall == 4:
            image_z = -z
        else:
            image_z = 2.0 * height - z
        lateral_cosine = (image_x - at_x) / length(image_x - at_x, image_y - at_y, image_z - at_z)
        for ear in range(EARS):
            side = 2.0 * ear - 1.0
            path_m = length(image_x - at_x - side * EAR_X_M, image_y - at_y, image_z - at_z)
            delays[ear, wall] = max(0.0, path_m - direct) / SPEED_OF_SOUND
            gains[ear, wall] = (
                reflected
                * REFERENCE_DISTANCE_M
                / max(path_m, REFERENCE_DISTANCE_M)
                * math.sqrt(1.0 + side * EAR_DIRECTIVITY * lateral_cosine)
            )


@compiled_exactly
def length(x: float, y: float, z: float) -> float:
    """Length of a vector."""
    return math.sqrt(x * x + y * y + z * z)
