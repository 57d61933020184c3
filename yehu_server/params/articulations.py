"""The articulations: what both hands do in a note, as a table, for docs, mappings and pages too.

An articulation is a value of `/playing/articulation`: its place in `ARTICULATIONS`. The numbers
stay for ever; new ones come last. `core.player.gestures` plays them.
"""

from dataclasses import dataclass

from yehu_server.errors import ParameterError, did_you_mean


@dataclass(frozen=True)
class BowStep:
    """A move of the bow at a time of a note: `at_ms` and a share of the note's length.

    `speed`, `weight`: factors on the bow's speed and on its pressure.
    `ramp_ms`, `ramp_share`: time in which it comes to that: ms, and a share of the note's length.
    `is_on`: whether the hair lies on the string.
    `turns`: whether the bow changes its direction.
    """

    at_ms: float = 0.0
    at_share: float = 0.0
    speed: float = 1.0
    weight: float = 1.0
    ramp_ms: float = 0.0
    ramp_share: float = 0.0
    is_on: bool = True
    turns: bool = False


@dataclass(frozen=True)
class FingerStep:
    """A move of a finger at a time of a note: to semitones from the note's pitch.

    `glide_ms`: the time in which it slides there; 0: the next finger is put down there.
    """

    semitones: float
    at_ms: float = 0.0
    at_share: float = 0.0
    glide_ms: float = 0.0


@dataclass(frozen=True)
class Vibrato:
    """A vibrato of an articulation's own.

    `cents`: depth to either side; where it goes `upward`, from the pitch to twice as much.
    `press`: share of the finger's force that varies with it.
    `delay_ms`: as `/playing/vibrato_delay`.
    """

    cents: float
    hertz: float = 6.0
    press: float = 0.0
    upward: bool = False
    delay_ms: float = 400.0


@dataclass(frozen=True)
class Articulation:
    """One articulation.

    `name`, `chinese`, `about`: what players call it, and what the hands do.
    `source`: where its figures are from.
    `attack`: factor on the time of the bow's attack.
    `length_s`: the length assumed of a note whose length is not known.
    `repeat_ms`, `speed_up`: the steps of the fingers, or of the bow where the fingers have none,
    are repeated at this interval, each time shorter by this share of it; 0 ms: they are not.
    `times`: number of repetitions; 0: while the note sounds.
    `tremolo`, `tremolo_depth`: strokes a second; as `/playing/tremolo_depth`.
    `pluck_position`, `pluck_force`: the distance from the bridge at which a plucked string is
    pulled, as a share of its sounding length, and a factor on the force; at 0 as `/pluck/position`
    says.
    `touches`: whether a finger touches an open string at a node, where the note is one
    (`core.player.harmonics`).
    """

    name: str
    chinese: str
    about: str
    source: str = "by ear"
    bow: tuple[BowStep, ...] = ()
    fingers: tuple[FingerStep, ...] = ()
    vibrato: Vibrato | None = None
    attack: float = 1.0
    length_s: float = 0.5
    repeat_ms: float = 0.0
    speed_up: float = 0.0
    times: int = 0
    tremolo: float = 0.0
    tremolo_depth: float = 0.0
    is_plucked: bool = False
    pluck_position: float = 0.0
    pluck_force: float = 1.0
    touches: bool = False


ARTICULATIONS: tuple[Articulation, ...] = (
    Articulation("ordinary", "普通", "a stroke for each separate note, one for slurred notes"),
    Articulation(
        "short", "短分弓", "a stroke over half of the note, that lets the string ring",
        bow=(BowStep(), BowStep(at_share=0.5, ramp_ms=60.0, is_on=False)),
        attack=0.8, length_s=0.3,
    ),
    Articulation(
        "staccato", "顿弓", "a stroke that stops on the string",
        bow=(
            BowStep(),
            BowStep(at_share=0.4, speed=0.0, ramp_ms=20.0),
        ),
        attack=0.7, length_s=0.3,
    ),
    Articulation(
        "spiccato", "跳弓", "a short stroke from the air and back into it",
        bow=(BowStep(speed=1.15, weight=1.1), BowStep(at_ms=55.0, ramp_ms=35.0, is_on=False)),
        attack=0.4,
    ),
    Articulation(
        "ricochet", "抛弓", "the bow is thrown and bounces, up to five times, faster and faster",
        bow=(
            BowStep(speed=1.15, weight=1.1),
            BowStep(at_ms=50.0, ramp_ms=25.0, is_on=False),
        ),
        attack=0.3, repeat_ms=125.0, speed_up=0.1, times=5,
    ),
    Articulation(
        "tremolo", "颤弓", "many short strokes, growing",
        source="12 to 15 strokes a second in recordings; the growth by ear",
        bow=(BowStep(speed=0.7), BowStep(speed=1.1, ramp_share=0.9)),
        tremolo=13.0, tremolo_depth=0.5, length_s=1.5,
    ),
    Articulation(
        "padded", "垫弓", "a light stroke the other way before the note ends",
        bow=(
            BowStep(),
            BowStep(at_share=0.75, speed=0.6, ramp_ms=28.0, turns=True),
        ),
    ),
    Articulation(
        "sforzando", "突强", "a hard beginning that is soon soft",
        bow=(
            BowStep(speed=1.3, weight=1.4),
            BowStep(at_ms=90.0, speed=0.65, weight=0.9, ramp_ms=180.0),
        ),
        attack=0.6, length_s=1.0,
    ),
    Articulation(
        "swell", "渐强渐弱", "from soft to loud and back in one note",
        bow=(
            BowStep(speed=0.45, weight=0.9),
            BowStep(speed=1.35, weight=1.1, ramp_share=0.45),
            BowStep(at_share=0.5, speed=0.4, weight=0.9, ramp_share=0.5),
        ),
        attack=2.0, length_s=2.0,
    ),
    Articulation("pizzicato", "拨弦", "the right hand plucks", is_plucked=True),
    Articulation(
        "straight", "直音", "no vibrato, even where a parameter asks for it", vibrato=Vibrato(0.0),
    ),
    Articulation(
        "rolling-vibrato", "滚揉", "the finger rolls to both sides of the pitch",
        source="39 to 105 cents from peak to peak in recordings of an erhu, a violin and a cello",
        vibrato=Vibrato(32.0, 6.0, 0.15, delay_ms=350.0),
    ),
    Articulation(
        "pressing-vibrato", "压揉", "the finger presses the string in and only raises its pitch",
        vibrato=Vibrato(28.0, 5.2, 0.6, upward=True, delay_ms=300.0),
    ),
    Articulation(
        "sliding-vibrato", "滑揉", "the finger slides to and fro, wide and slow",
        vibrato=Vibrato(65.0, 4.2, delay_ms=300.0),
    ),
    Articulation(
        "slide-up", "上滑音", "a slide to the pitch from a second below",
        fingers=(FingerStep(-2.0), FingerStep(0.0, at_ms=35.0, glide_ms=120.0)),
    ),
    Articulation(
        "large-slide-up", "大上滑音", "a slide to the pitch from a major third below",
        fingers=(FingerStep(-4.0), FingerStep(0.0, at_ms=50.0, glide_ms=230.0)),
    ),
    Articulation(
        "slide-down", "下滑音", "a slide to the pitch from a second above",
        fingers=(FingerStep(2.0), FingerStep(0.0, at_ms=35.0, glide_ms=130.0)),
    ),
    Articulation(
        "turning-slide", "回滑音", "a slide to a second above and back",
        fingers=(
            FingerStep(2.0, at_share=0.3, glide_ms=130.0),
            FingerStep(0.0, at_ms=140.0, at_share=0.3, glide_ms=150.0),
        ),
        length_s=0.7,
    ),
    Articulation(
        "fall", "甩音", "a slide down by a minor third as the note ends",
        fingers=(FingerStep(-3.0, at_share=0.72, glide_ms=170.0),),
    ),
    Articulation(
        "mordent", "打音", "another finger beats a second above, once",
        fingers=(FingerStep(2.0, at_ms=70.0), FingerStep(0.0, at_ms=130.0)),
    ),
    Articulation(
        "trill", "颤音", "another finger beats a second above, faster and faster",
        fingers=(FingerStep(2.0, at_ms=90.0), FingerStep(0.0, at_ms=148.0)),
        repeat_ms=150.0, speed_up=0.03,
    ),
    Articulation(
        "wide-trill", "大颤音", "another finger beats a minor third above, faster and faster",
        fingers=(FingerStep(3.0, at_ms=90.0), FingerStep(0.0, at_ms=148.0)),
        repeat_ms=150.0, speed_up=0.03,
    ),
    Articulation(
        "passed-slide", "垫指滑音",
        "a slide from a minor third below, which the next finger takes over",
        fingers=(
            FingerStep(-3.0),
            FingerStep(-1.6, at_ms=30.0, glide_ms=80.0),
            FingerStep(-1.0, at_ms=115.0),
            FingerStep(0.0, at_ms=125.0, glide_ms=80.0),
        ),
    ),
    Articulation(
        "wavering", "活五", "a pitch that never rests, as the second degree of the Chaozhou scale "
        "huo wu: over it, and slowly about it",
        fingers=(
            FingerStep(-0.4, glide_ms=60.0),
            FingerStep(0.6, at_ms=60.0, glide_ms=150.0),
            FingerStep(-0.2, at_ms=230.0, glide_ms=170.0),
        ),
        repeat_ms=380.0,
    ),
    Articulation(
        "flageolet", "泛音",
        "a harmonic: the finger only touches the string at its half (F5, C6) or its third (G5, "
        "which sounds G6), the bow near the bridge; other notes are light",
        bow=(BowStep(speed=1.2, weight=0.5),), vibrato=Vibrato(0.0), touches=True,
    ),
    Articulation(
        "left-hand-pizzicato", "左手拨弦",
        "another finger of the left hand plucks, a fourth above the one that stops the string",
        source="one of the left hand in descriptions of the erhu; place and force by ear",
        is_plucked=True, pluck_position=0.75, pluck_force=0.7,
    ),
)  # fmt: skip

NUMBER = {articulation.name: number for number, articulation in enumerate(ARTICULATIONS)}
LAST = 127  # highest value: a controller's, with numbers left for new ones


def number_of(name: str) -> int:
    """The value of `/playing/articulation` for a name, English or Chinese, or a ParameterError."""
    for number, articulation in enumerate(ARTICULATIONS):
        if name in (articulation.name, articulation.chinese):
            return number
    raise ParameterError(f"unknown articulation {name!r}{did_you_mean(name, NUMBER)}")
