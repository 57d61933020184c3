"""Arguments that several commands share, and what is made from them."""

from __future__ import annotations

import argparse
import contextlib
import inspect
import re
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from rich_argparse import RawDescriptionRichHelpFormatter

from yehu_server.cli.converters import folder, target
from yehu_server.cli.terminal import warn
from yehu_server.cli.wrong_words import other_command
from yehu_server.errors import did_you_mean, one_line
from yehu_server.live.network import OSC_ADDRESS, format_address, parse_address
from yehu_server.params.table import BY_ADDRESS
from yehu_server.util.files import (
    check_free,
    check_target,
    replace_any,
    replace_none,
    shipped_folder,
)
from yehu_server.util.hints import command_name, shown_path

if TYPE_CHECKING:
    from yehu_server.core.physics.default_quantities import Quantities
    from yehu_server.rendering.cluster import Cluster


class HelpFormatter(RawDescriptionRichHelpFormatter):
    """Shows texts as they are: brackets, as in yehu-server[follow], are no markup."""

    text_markup = help_markup = False
    group_name_formatter = staticmethod(  # type: ignore[assignment]
        lambda name: name[:1].upper() + name[1:]  # MIDI, not Midi
    )


IN_FILE = "that is done in the file, before it is played"
ELSEWHERE = {  # what players of files look for, and where it is
    **dict.fromkeys(("--from", "--start", "--end", "--to", "--tempo", "--bpm"), IN_FILE),
}
# What argparse says of a wrong choice; from Python 3.12 on without quotation marks.
CHOICE = re.compile(r"invalid choice: '?(.*?)'? \(choose from (.*)\)", re.DOTALL)
OUR_WORDS = {  # for argparse's
    r"^argument ": "",
    r"^the following arguments are required": "missing",
    r"expected (?:at least )?one argument$": "needs a value",
}


def add_options(group: Any, table: str, /, **details: Any) -> None:
    """Add options to a parser, or a group of its options, from a table of usage and help.

    `table`: rows such as ``--mono: one channel``, a flag; ``-o --output OUT: the file``; ``--only
    NAME ...: may be repeated``; or ``score FILE: the score``, an argument. What follows of a row is
    indented.
    `details`: by the names of options, the other words that argparse takes, or the type alone.
    """
    for row in re.split(r"\n(?=\S)", inspect.cleandoc(table)):
        usage, _, text = " ".join(row.split()).partition(": ")
        *names, value = usage.split()
        text = text.replace("yehu-server ", f"{command_name()} ")
        name = usage.rpartition("--")[2].split()[0].replace("-", "_")
        words = details.pop(name, {})
        words = {"help": text, **(words if isinstance(words, dict) else {"type": words})}
        if value == "...":
            words |= {"action": "append", "default": []}
            value = names.pop()
        if not value.startswith("-"):
            words["metavar"] = value
        else:
            names.append(value)
            if words.keys() <= {"help", "dest"}:
                words["action"] = "store_true"
        group.add_argument(*names, **words)
    if details:
        raise TypeError(f"no row of the table is of {', '.join(details)}")


def chosen(kind: Any, arguments: argparse.Namespace, but: Collection[str] = ()) -> dict[str, Any]:
    """The arguments that are fields of a dataclass of options, as they are; none that is None."""
    names = {each.name for each in fields(kind)}.difference(but)
    return {
        name: value
        for name, value in vars(arguments).items()
        if name in names and value is not None
    }


def add_cluster(group: Any) -> None:
    """Add --dask, the address of a cluster's scheduler, to a parser or a group of its options."""
    add_options(
        group,
        """
        --dask ADDRESS: run on a cluster: the address of its Dask scheduler, such as
            tcp://10.0.0.1:8786, or the scheduler file (needs yehu-server[cluster])
        """,
    )


def cluster_of(
    arguments: argparse.Namespace, setup: Callable[[], object]
) -> contextlib.AbstractContextManager[Cluster | None]:
    """The cluster that the option of `add_cluster` names, if it does, for the time of a block.

    Raises YehuError where it cannot be used.

    `setup`: what each worker calls before its first job.
    """
    if arguments.dask is None:
        return contextlib.nullcontext()
    from yehu_server.rendering.cluster import Cluster

    return Cluster(arguments.dask, setup, warn)


class Parser(argparse.ArgumentParser):
    """A parser that reports a wrong call in one line, without the usage, with a near word."""

    def __init__(self, *args: Any, **words: Any) -> None:
        super().__init__(*args, **words)
        self._actions_by_word: dict[str, Parser] = {}
        self._words: Sequence[str] = ()

    def add_word(self, word: str, run: Callable[[argparse.Namespace], int], text: str) -> Parser:
        """Add an action beside the command's own arguments, by its first word; return its parser.

        argparse's subparsers leave no room for such arguments.
        """
        parser = Parser(
            prog=f"{self.prog} {word}",
            description=_sentence(text),
            formatter_class=HelpFormatter,
            allow_abbrev=False,
        )
        parser.set_defaults(run=run)
        self._actions_by_word[word] = parser
        return parser

    def parse_known_args(  # type: ignore[override]
        self, args: Any = None, namespace: Any = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Parse as argparse does, or leave it to the parser of the first word."""
        action = self._actions_by_word.get(args[0]) if args else None
        if action is not None:
            return action.parse_known_args(args[1:], namespace)
        self._words = args or ()
        if namespace is None:  # else once more, beside a config file
            self._warn_of_repeated()
        known: tuple[argparse.Namespace, list[str]] = super().parse_known_args(args, namespace)
        if known[1]:
            word = known[1][0].partition("=")[0]
            is_option = word.startswith("-")
            hint = other_command(self.prog.split()[-1], word)
            self.error(self._unknown(word) if is_option else f"{word}: one argument too many{hint}")
        return known

    def _warn_of_repeated(self) -> None:
        """Warn of options that have one value, and are given several."""
        given = Counter(word.partition("=")[0] for word in self._words)
        for option, count in given.items():
            action = self.options.get(option)
            if count > 1 and action and action.nargs != 0 and action.default != []:
                warn(f"{option} is given {count} times: the last counts")

    def _unknown(self, option: str) -> str:
        return f"no option {option}{self._near(option)}"

    def _near(self, option: str) -> str:
        """A hint at an option, or at the parameter of that name where one can be set."""
        if "--song" in self.options and option in ELSEWHERE:
            return f"; {ELSEWHERE[option]}"
        name = f"/playing/{option.lstrip('-').replace('-', '_')}"
        if "--set" in self.options and name in BY_ADDRESS:
            return f"; did you mean --set {name}=VALUE?"
        return did_you_mean(option, self.options)

    @property
    def options(self) -> dict[str, argparse.Action]:
        """The actions of all options, by their names with dashes; argparse has no public way."""
        return self._option_string_actions

    def error(self, message: str) -> NoReturn:
        """Print what is wrong and exit with code 2."""
        message = self.worded(message)
        given = (word.partition("=")[0] for word in self._words if word.startswith("--"))
        wrong = [word for word in given if word not in self.options and word != "--"]
        if message.startswith("missing") and wrong:  # it may be the one that is missing
            message = self._unknown(wrong[0])
        message = one_line(message)
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")

    def worded(self, message: str) -> str:
        """An error of argparse in our words."""

        def choice(wrong: re.Match[str]) -> str:
            known = [*re.findall(r"[^\s',]+", wrong[2]), *self._actions_by_word]
            near = did_you_mean(wrong[1], known)
            return f"'{wrong[1]}' is not one of {', '.join(known)}{near}"

        for theirs, ours in OUR_WORDS.items():
            message = re.sub(theirs, ours, message)
        return CHOICE.sub(choice, message)


def add_command(
    commands: Any,
    usage: str,
    about: str | None,
    run: Callable[[argparse.Namespace], int] | None = None,
) -> Any:
    """Add a command, or an action of one; return its parser.

    `usage`: its name and what it does, such as ``devices: list the inputs``.
    `about`: its description and, from the first example on, what stands at the end of its help: the
    docstring of its module. Pages named there, such as docs/osc.md, get their path.
    """
    name, _, short = usage.partition(": ")
    description, example, more = (about or "").partition("\n\n  yehu-server ")
    epilog = f"examples:{example[1:]}{more}" if example else ""
    description, epilog = (
        text.replace("yehu-server ", f"{command_name()} ") for text in (description, epilog)
    )
    parser = commands.add_parser(
        name,
        help=short,
        description=" ".join(description.split()),
        epilog=epilog.replace("docs/", f"{shown_path(shipped_folder('docs'))}/"),
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    if run is not None:
        parser.set_defaults(run=run)
    return parser


def add_actions(parser: argparse.ArgumentParser) -> Any:
    """Let a command have actions; return what `add_action` adds them to."""
    return parser.add_subparsers(title="actions", metavar="ACTION", required=True, prog=parser.prog)


def add_action(actions: Any, name: str, run: Callable[[argparse.Namespace], int], text: str) -> Any:
    """Add an action of a command, with its help as the description; return its parser."""
    return add_command(actions, f"{name}: {text}", _sentence(text), run)


def _sentence(text: str) -> str:
    """A help's text as a description; names in it keep their capitals."""
    return f"{text[0].upper()}{text[1:]}."


def add_instrument(parser: argparse.ArgumentParser) -> None:
    """Add the option that names an instrument file."""
    add_options(
        parser,
        "--instrument FILE: instrument file (TOML or JSON) of another two-stringed fiddle: how it "
        "differs from the yehu, such as its strings (docs/physics.md)",
        instrument=Path,
    )


def instrument_of(arguments: argparse.Namespace) -> Quantities:
    """The quantities that the option of `add_instrument` asks for; raises YehuError."""
    from yehu_server.core.physics.default_quantities import Quantities, read_quantities

    return read_quantities(arguments.instrument) if arguments.instrument else Quantities()


def add_reporting(parser: argparse.ArgumentParser) -> None:
    """Add --json and --quiet."""
    add_options(
        parser,
        """
        --json: print one JSON object when done
        --quiet: no progress bar, no summary
        """,
    )


def add_output(
    parser: argparse.ArgumentParser, kind: Callable[[str], Path] = target, more: str = ""
) -> None:
    """Add -o and --overwrite, for the sound file to write; `kind` converts its name."""
    add_options(
        parser,
        f"""
        -o --output OUT: the file to write{more}
        --overwrite: replace OUT, whatever it is (default: only a sound file that this program made)
        """,
        output={"required": True, "type": kind},
    )


def add_folder(
    parser: argparse.ArgumentParser,
    *,
    required: bool = True,
    text: str = "folder to write to; created if missing",
) -> None:
    """Add -o, for a folder to write to."""
    add_options(
        parser, f"-o --output FOLDER: {text}", output={"required": required, "type": folder}
    )


def check_output(
    arguments: argparse.Namespace, output: Path | None = None
) -> Callable[[Path], bool]:
    """Check that the output of `add_output` may be written; return which files it may replace.

    Raises OutputError where it may not be written.

    `output`: another file that is written beside it.
    """
    may_replace = replaceable(arguments)
    check_target(output or arguments.output)
    check_free(output or arguments.output, may_replace)
    return may_replace


def picture_output(arguments: argparse.Namespace) -> dict[str, Path]:
    """The picture that --plot asks for, by the option; none without it.

    Raises YehuError where it cannot be drawn, or may not be written.
    """
    if arguments.plot is None:
        return {}
    from yehu_server.plot.png import check_picture

    check_picture(arguments.plot, "--plot", overwrite=arguments.overwrite)
    return {"--plot": arguments.plot}


def check_new(arguments: argparse.Namespace, *targets: Path) -> None:
    """Check, before long work, that files may be written; raises OutputError where they may not."""
    for path in targets or (arguments.output,):
        check_target(path)
        check_free(path, replace_any if arguments.overwrite else replace_none)


def replaceable(arguments: argparse.Namespace) -> Callable[[Path], bool]:
    """Which older files a sound may replace, as of ``files.replacing``."""
    from yehu_server.util.sound_file import is_rendered

    return replace_any if arguments.overwrite else is_rendered


def add_server(parser: Any) -> None:
    """Add --server, the address of a running server."""
    usual = format_address(*OSC_ADDRESS)
    text = f"--server HOST:PORT: the OSC address of the server (default: {usual})"
    add_options(parser, text, server={"default": usual})


def server_of(arguments: argparse.Namespace) -> tuple[str, int]:
    """The address given with --server; raises ParameterError where it is none."""
    return parse_address(arguments.server, *OSC_ADDRESS)
