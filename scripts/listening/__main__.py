"""The commands of `scripts/listen`."""

import argparse
import sys
from pathlib import Path

from listening.distances import print_distances
from listening.pairs import make_pairs, print_votes
from listening.sounds import Group, UnfitSoundsError


def group(text: str) -> Group:
    """NAME=FOLDER."""
    name, is_named, folder = text.rpartition("=")
    path = Path(folder)
    if not path.is_dir():
        raise argparse.ArgumentTypeError(f"{folder!r} is no folder")
    return Group(name if is_named else path.name, path)


def main() -> int:
    parser = argparse.ArgumentParser(prog="scripts/listen", description=__doc__)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    pairs = commands.add_parser("pairs", help="make a page with pairs of sounds to choose from")
    pairs.add_argument("groups", nargs="+", type=group, metavar="NAME=FOLDER")
    pairs.add_argument("-o", "--output", type=Path, required=True, metavar="FOLDER")
    pairs.add_argument("--pairs", type=int, default=20, help="at most so many (20)")
    pairs.add_argument("--seconds", type=float, default=12.0, help="of each sound, at most (12)")
    pairs.add_argument("--seed", type=int, default=0, help="of the choice and the order (0)")
    pairs.set_defaults(run=make_pairs)
    votes = commands.add_parser("votes", help="count what listeners chose")
    votes.add_argument("folder", type=Path, help="which `pairs` made")
    votes.add_argument("files", nargs="+", type=Path, metavar="VOTES.json")
    votes.set_defaults(run=print_votes)
    distances = commands.add_parser("distances", help="measure how far sounds are from recordings")
    distances.add_argument("recordings", type=group, metavar="RECORDINGS")
    distances.add_argument("groups", nargs="+", type=group, metavar="NAME=FOLDER")
    distances.set_defaults(run=print_distances)
    options = parser.parse_args()
    try:
        options.run(options)
    except (OSError, UnfitSoundsError) as error:
        print(f"scripts/listen: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
