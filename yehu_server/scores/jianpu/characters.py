"""The notes of Chinese characters: 二四谱 of Chaozhou, and 工尺谱.

Both are read with the rhythm, octaves and marks of jianpu; their characters are degrees of a scale
on do. In 二四谱 the characters 三 and 六 are light or heavy, by the mode of the piece or by a sign
before the character; 五 is living (活五) in one of the modes: raised and slid, a gesture.

Pitches of heavy and living notes differ between players and pieces. docs/jianpu.md names the
sources of those here.
"""

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import cycle, islice

Contour = tuple[tuple[float, float], ...]

LIGHT, HEAVY, LIVING = "轻", "重", "活"
WEIGHTS = {LIGHT: LIGHT, "輕": LIGHT, HEAVY: HEAVY, LIVING: LIVING}

SAN, WU, LIU = "三", "五", "六"
# Semitones above do, light.
ERSIPU = {"二": -5.0, SAN: -3.0, "四": 0.0, WU: 2.0, LIU: 4.0, "七": 7.0, "八": 9.0}
# 三 sounds as si, somewhat low; 六 as fa, somewhat high [Zhou]. Unverified: by how much.
HEAVY_SEMITONES = {SAN: -1.5, LIU: 5.3}
LIVING_SEMITONES = 2.75  # re, raised by three quarters of a semitone [Xianshi]

GONGCHEPU = {
    "合": -5.0, "四": -3.0, "士": -3.0, "一": -1.0, "上": 0.0, "尺": 2.0, "工": 4.0, "凡": 5.0,
    "六": 7.0, "五": 9.0, "乙": 11.0, "仩": 12.0, "伬": 14.0, "仜": 16.0,
}  # fmt: skip

CHARACTERS = frozenset({*ERSIPU, *GONGCHEPU})
NOTATIONS = {"二四谱": ERSIPU, "二四譜": ERSIPU, "工尺谱": GONGCHEPU, "工尺譜": GONGCHEPU}

# By ear, of the living five: from re it rises past its pitch, and then wanders about it.
RISE_QUARTERS, SWING_QUARTERS = Fraction(1, 3), Fraction(1, 2)
LIVING_FROM, LIVING_PAST = -0.75, 0.25
LIVING_SWINGS = (-0.45, 0.2, -0.3, 0.3)
# By ear, of the heavy three in that mode, which turns widely: down, and back.
TURNING_SWINGS = (-0.5, 0.25)
MAX_POINTS = 64
_HEAVY = frozenset({SAN, LIU})


@dataclass(frozen=True)
class Mode:
    """A mode of Chaozhou music: which characters are heavy, and whether 五 is living."""

    heavy: frozenset[str] = frozenset()
    living: bool = False


DEFAULT_MODE = Mode()
_MODES = {
    **dict.fromkeys(("轻六", "轻三六", "轻三轻六", "qingliu"), DEFAULT_MODE),
    **dict.fromkeys(("重六", "重三六", "重三重六", "zhongliu"), Mode(_HEAVY)),
    **dict.fromkeys(("轻三重六", "qingsanzhongliu"), Mode(frozenset({LIU}))),
    **dict.fromkeys(("活五", "活三五", "huowu"), Mode(_HEAVY, living=True)),
}


def mode_named(name: str) -> Mode | None:
    """The mode of a name in Chinese or in pinyin, with or without 调 after it."""
    plain = re.sub(r"[\s-]", "", name).lower().replace("輕", LIGHT)
    return _MODES.get(re.sub(r"(?:调|調|diao)$", "", plain))


def semitones_of(character: str, weight: str, mode: Mode) -> float:
    """Semitones above do of a character of 二四谱, its `weight` LIGHT, HEAVY, LIVING or empty."""
    if character == WU and is_living(character, weight, mode):
        return LIVING_SEMITONES
    heavy = weight in (HEAVY, LIVING) or (not weight and character in mode.heavy)
    return HEAVY_SEMITONES.get(character, ERSIPU[character]) if heavy else ERSIPU[character]


def is_living(character: str, weight: str, mode: Mode) -> bool:
    """Whether a character is played as a living note: 五, and the heavy 三 of that mode."""
    if weight:
        return weight == LIVING and character in (SAN, WU)
    return mode.living and character in (SAN, WU)


@lru_cache(maxsize=1024)
def living(character: str, quarters: Fraction) -> Contour:
    """The moves of a living note within its length, as `notated.Note.contour`."""
    swings: tuple[float, ...]
    if character == SAN:
        swings, points = TURNING_SWINGS, [(Fraction(0), 0.0)]
    else:
        rise = (min(RISE_QUARTERS, quarters / 2), LIVING_PAST)
        swings, points = LIVING_SWINGS, [(Fraction(0), LIVING_FROM), rise]
    at = points[-1][0] + SWING_QUARTERS
    for swing in islice(cycle(swings), MAX_POINTS):
        if at >= quarters:
            break
        points.append((at, swing))
        at += SWING_QUARTERS
    if len(points) == 1:  # too short for a whole turn
        points.append((quarters / 2, swings[0]))
    return (*((float(time / quarters), depth) for time, depth in points), (1.0, 0.0))
