"""Options of playing that serve and render share: mapping, preset, tuning."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from platformdirs import user_config_path

from yehu_server.cli.arguments import add_options, chosen
from yehu_server.cli.converters import number_within, whole_within
from yehu_server.cli.terminal import warn
from yehu_server.errors import ParameterError
from yehu_server.params.preset_file import FIRST_LIVE
from yehu_server.params.table import HIGHEST_A4, LOWEST_A4
from yehu_server.util.hints import shown_path

if TYPE_CHECKING:
    from yehu_server.playing.mapping import Mapping
    from yehu_server.playing.options import PlayingOptions
    from yehu_server.playing.tuning import Tuning

# Arguments that are something else than the fields of `PlayingOptions` of their names.
OTHER = (
    "channels",
    "instrument",
    "mapping",
    "open_strings",
    "practice",
    "preset",
    "presets",
    "tuning",
)


def add_playing(group: Any, usual_preset: str = "none") -> None:
    """Add the options of playing that commands share; see `playing_options_of`."""
    add_tables(group, usual_preset)
    add_options(
        group,
        """
        --practice FILE: bowing table, as yehu-server practise writes it (default:
            NAME.practice.json beside an instrument file NAME.toml, else the shipped one)
        --set ADDRESS=VALUE ...: hold a parameter at a value, such as /playing/bow_position=0.1 or
            articulation=trill (or 颤音); may be repeated
        --open-strings: whether the open outer string plays its note, C5 of a yehu: always, on-pitch
            (only where it is in tune for the note) or never (default: always)
        --seed N: seed of the player's random variation, 0 to 65535 (default: 0)
        """,
        practice=Path,
        open_strings={"choices": ("always", "on-pitch", "never"), "default": "always"},
        seed={"type": whole_within(0, 65535, "is not a seed, 0 to 65535"), "default": 0},
    )


def add_controllers(group: Any) -> None:
    """Add the options of what keys and controllers do; see `table_options_of`."""
    add_options(
        group,
        """
        --mapping FILE: what controllers move: the name of a mapping (mine/NAME for one of yours),
            or a file (default: keyboard)
        --mpe: start with one MPE zone of 15 member channels; without --mapping, use the mapping
            named mpe
        --programs: let MIDI program changes select presets (default: they are ignored)
        --transpose SEMITONES: play all notes so much higher, or lower, -48 to 48 (default: 0)
        """,
        transpose={
            "type": whole_within(-48, 48, "is not within -48 to 48 semitones"),
            "dest": "transposed_by",
            "default": 0,
        },
    )


def add_tables(group: Any, usual_preset: str = "none") -> None:
    """Add the options of how messages are interpreted; see `table_options_of`."""
    add_options(
        group,
        f"""
        --preset NAME ...: sound to start with: the name of a preset, or a file; several with a
            plus, such as sul-tasto+hall, or one after another (default: {usual_preset});
            yehu-server presets list names all
        """,
    )
    add_presets_folder(group)
    add_options(
        group,
        f"--a4 HZ: reference pitch, {LOWEST_A4:g} to {HIGHEST_A4:g} (default: 440)",
        a4={"type": number_within(LOWEST_A4, HIGHEST_A4, "Hz"), "default": 440.0},
    )
    add_tuning(group)
    add_options(
        group,
        "--range: what happens to notes outside the range of the instrument (of a yehu F4 to F6): "
        "transpose moves them by octaves, clamp plays the nearest note, skip leaves them out, and "
        "key switches (default: transpose)",
        range={"choices": ("transpose", "clamp", "skip"), "default": "transpose"},
    )


def add_tuning(group: Any) -> None:
    """Add the options that set which pitch each key has, to a parser or a group of its options."""
    add_options(
        group,
        """
        --tuning FILE.scl: Scala scale, with C as its first note: a file, or the name of a shipped
            one (default: equal temperament)
        --keyboard-map FILE.kbm: Scala keyboard map: which key plays which note of the scale, and at
            what pitch, where a scale does not have twelve notes; a file, or the name of a shipped
            one
        """,
        tuning=Path,
        keyboard_map=Path,
    )


def tuning_of(arguments: argparse.Namespace) -> Tuning:
    """The tuning that the options of `add_tuning` ask for; raises YehuError for a wrong file."""
    from yehu_server.playing.tuning import EQUAL, read_tuning

    if arguments.keyboard_map is not None and arguments.tuning is None:
        raise ParameterError("--keyboard-map needs a scale: --tuning FILE.scl")
    transposed_by = getattr(arguments, "transposed_by", 0)
    if arguments.tuning is None:
        return EQUAL.transposed(transposed_by)
    tuning = read_tuning(arguments.tuning, arguments.keyboard_map)
    if tuning.is_in_a_row:
        warn(
            f"--tuning {arguments.tuning}: keys play its notes in a row from C4 on, whatever their "
            "names: --keyboard-map says which key plays which note"
        )
    return tuning.transposed(transposed_by)


def mapping_of(arguments: argparse.Namespace, *, is_live: bool = False) -> Mapping:
    """The mapping given by --mapping and --mpe; raises MappingError if wrong or not there."""
    from yehu_server.playing.mapping import DEFAULT, MPE, load

    name = arguments.mapping or (MPE if arguments.mpe else DEFAULT)
    mapping = load(name, user_first=is_live)
    return replace(mapping, mpe=mapping.mpe or arguments.mpe)


def own_presets(text: str) -> Path:
    """Read the path of a folder of presets; raises ArgumentTypeError where there is none."""
    if not Path(text).is_dir():
        raise argparse.ArgumentTypeError(f"{text}: no such folder; --preset chooses a preset")
    return Path(text)


def add_presets_folder(group: Any) -> None:
    """Add --presets, the folder of the user's presets."""
    usual = shown_path(user_config_path("yehu-server", appauthor=False) / "presets")
    text = f"--presets FOLDER: folder of your own presets (default: {usual})"
    add_options(group, text, presets=own_presets)


def playing_options_of(arguments: argparse.Namespace, *, is_live: bool = False) -> PlayingOptions:
    """What the options of `add_playing` ask for, and those beside them; raises YehuError.

    `is_live`: as of `table_options_of`.
    """
    from yehu_server.core.player.fingering import OpenStrings
    from yehu_server.params.table import assignment

    channel = getattr(arguments, "channel", None)
    playing = replace(
        table_options_of(arguments, is_live=is_live),
        settings=tuple(assignment(text) for text in arguments.set),
        open_strings=OpenStrings(arguments.open_strings),
        channels=None if channel is None else frozenset(channel),
    )
    return playing.on_instrument(arguments.instrument, arguments.practice)


def table_options_of(arguments: argparse.Namespace, *, is_live: bool = False) -> PlayingOptions:
    """What the options of `add_tables` ask for.

    In live playing, mappings and presets of the user's own precede shipped ones of the same name.
    Else they must be named explicitly, so that the result of a rendering depends on its command
    alone. Raises YehuError where a file or value is wrong.
    """
    from yehu_server.playing.options import LIVE, PlayingOptions
    from yehu_server.playing.preset_folders import Presets
    from yehu_server.playing.tuning import RangePolicy

    user_first = is_live or arguments.presets is not None
    playing = PlayingOptions(
        **chosen(PlayingOptions, arguments, but=OTHER),
        mapping=mapping_of(arguments, is_live=is_live),
        presets=Presets(arguments.presets, user_first=user_first),
        tuning=tuning_of(arguments),
        policy=RangePolicy(arguments.range),
    )
    names = arguments.preset
    if not names and is_live and arguments.mapping is None and not arguments.mpe:
        names = [FIRST_LIVE]
    if names:
        for remark in playing.presets.find(*names).remarks():
            warn(remark)
        playing = playing.with_preset(*names)
    return replace(playing, start=(*LIVE.items(), *playing.start)) if is_live else playing
