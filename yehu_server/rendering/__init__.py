"""Scores and captures to sound files, faster than real time: one, or a folder, or on a cluster."""

from pathlib import Path

PIPE = Path("-")  # standard output, known by its identity: a file may have that name too
