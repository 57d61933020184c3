"""A short study, and what it found."""

import pytest

from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of


def short(**more):
    """The data of a study of short strokes."""
    data = {
        "about": "A short study of <C5>",
        "duration": 0.1,
        "stroke": {"string": 1, "note": 72, "acceleration": 20.0},
        "vary": {
            "force": {"from": 0.05, "to": 5.0, "steps": 5, "spread": "log"},
            "position": {"from": 0.06, "to": 0.3, "steps": 3, "spread": "log"},
        },
        "refine": {"axes": ["force", "position"], "levels": 1},
    }
    return data | more


@pytest.fixture(scope="session")
def data():
    return short


@pytest.fixture(scope="session")
def result():
    return sweep(study_of(short()), workers=2)
