"""Pairs of sounds of two groups each, in an order by chance, and the count of what was chosen.

Files with the same name in two groups are one piece: these are compared before others.
"""

import argparse
import json
import math
import random
from collections import Counter
from itertools import combinations, product
from pathlib import Path

import soundfile

from listening.sounds import Group, UnfitSoundsError, matched, read

PAGE = Path(__file__).with_name("page.html")
KEY = "key.json"  # which the page does not read
PLACE = "<!-- pairs -->"


def chosen_pairs(
    groups: list[Group], most: int, chance: random.Random
) -> list[list[tuple[str, Path]]]:
    """Two names and files for each pair, as many of each two groups as can be."""
    by_groups = []
    for two in combinations(groups, 2):
        files = [{file.stem: file for file in group.files()} for group in two]
        same = sorted(files[0].keys() & files[1].keys())
        stems = [(stem, stem) for stem in same] or sorted(product(files[0], files[1]))
        chance.shuffle(stems)
        names = [group.name for group in two]
        by_groups.append(
            [
                [(name, of[stem]) for name, of, stem in zip(names, files, both, strict=True)]
                for both in stems
            ]
        )
    turns = [pairs[n] for n in range(most) for pairs in by_groups if n < len(pairs)][:most]
    chance.shuffle(turns)
    for pair in turns:
        chance.shuffle(pair)
    return turns


def make_pairs(options: argparse.Namespace) -> None:
    """Write a page, its sounds and the key that says which is which."""
    names = [group.name for group in options.groups]
    if len(names) < 2 or len(set(names)) < len(names):
        raise UnfitSoundsError("two folders or more are compared, each with a name of its own")
    folder = options.output
    if folder.exists() and any(folder.iterdir()):
        raise UnfitSoundsError(f"{folder} is there already, and not empty")
    chance = random.Random(options.seed)  # noqa: S311 - to be the same again
    key, files = {}, []
    turns = chosen_pairs(options.groups, options.pairs, chance)
    folder.mkdir(parents=True, exist_ok=True)
    for number, pair in enumerate(turns, 1):
        sounds = [read(file, options.seconds) for _, file in pair]
        key[str(number)] = [name for name, _ in pair]
        files.append([f"{number:03}{side}.wav" for side in "ab"])
        for file, sound, (_, rate) in zip(files[-1], matched(sounds), sounds, strict=True):
            soundfile.write(folder / file, sound, rate, subtype="PCM_24")
    (folder / KEY).write_text(json.dumps(key, indent=1, ensure_ascii=False) + "\n", "utf-8")
    page = PAGE.read_text("utf-8").replace(PLACE, json.dumps(files))
    (folder / "index.html").write_text(page, "utf-8")
    print(f"{folder / 'index.html'}: {len(turns)} pairs of {', '.join(names)}")


def interval(chosen: int, of: int, z: float = 1.96) -> tuple[float, float]:
    """The share's interval at 95 % [Wilson 1927]."""
    share, spread = chosen / of, z * z / of
    middle = (share + spread / 2.0) / (1.0 + spread)
    half = z * math.sqrt(share * (1.0 - share) / of + spread / (4.0 * of)) / (1.0 + spread)
    return max(0.0, middle - half), min(1.0, middle + half)


def counted(
    key: dict[str, list[str]], votes: list[dict[str, str]]
) -> dict[tuple[str, str], Counter[str]]:
    """Of each two groups: how often each was chosen, and neither ("")."""
    found: dict[tuple[str, str], Counter[str]] = {}
    for vote in votes:
        for number, choice in vote.items():
            if number not in key or choice not in ("a", "b", ""):
                raise UnfitSoundsError(f"pair {number}, choice {choice!r}: not of this page")
            pair = key[number]
            count = found.setdefault((min(pair), max(pair)), Counter())
            count[pair["ab".index(choice)] if choice else ""] += 1
    return found


def print_votes(options: argparse.Namespace) -> None:
    """Print how often each group was chosen, with the interval at 95 %."""
    try:
        key = json.loads((options.folder / KEY).read_text("utf-8"))
        votes = [json.loads(file.read_text("utf-8")) for file in options.files]
    except ValueError as error:
        raise UnfitSoundsError(f"no JSON: {error}") from None
    for (one, other), count in sorted(counted(key, votes).items()):
        of = count[one] + count[other]
        if not of:
            print(f"{one} beside {other}: no choice in {count['']} pairs")
            continue
        low, high = interval(count[one], of)
        print(
            f"{one} {count[one]}, {other} {count[other]}, neither {count['']}: {one} was chosen in "
            f"{100 * count[one] / of:.0f} % ({100 * low:.0f} to {100 * high:.0f} at 95 %)"
        )
