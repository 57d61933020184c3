"""What a study varies."""

import pytest

from yehu_lab.sweeps.axes import axis_from, axis_of
from yehu_server.errors import ParameterError
from yehu_server.util.documents import Fields


def test_an_axis_is_a_name_and_values():
    for text, name, values in (
        ("bow_force=0.1,2", "bow_force", (0.1, 2.0)),
        ("controls.bow_force=-1e-1", "controls.bow_force", (-0.1,)),
        ("instrument.bow.epsilon_0=1e4:3e4:3", "instrument.bow.epsilon_0", (1e4, 2e4, 3e4)),
        ("force=0.1:10:3:log", "force", (0.1, 1.0, 10.0)),
        ("bow_force=-0.1:-10:3:log", "bow_force", (-0.1, -1.0, -10.0)),
    ):
        axis = axis_of(text)
        assert axis.name == name
        assert axis.values == pytest.approx(values)
    words = axis_of("instrument.bow.friction=elasto-plastic,thermal").values
    assert words == ("elasto-plastic", "thermal")


def test_what_is_no_axis_is_refused_in_a_line():
    for text in (
        *("force", "=1", "force=", "force=1:2", "force=1:2:1", "a..b=1", "x=1:2:z"),
        *("x=0:2:5:log", "x=1:2:5:cubic", "x=1:2:5:log:6", "x=1:inf:4", "x=1:2:1000001"),
    ):
        with pytest.raises(ParameterError) as error:
            axis_of(text)
        assert "\n" not in str(error.value), text
    ends = {"from": 1, "to": 2}
    for entry in (
        *(3, [], {"from": 1}, ends | {"steps": 2.5}, ends | {"step": 3}),
        *(ends | {"from": "a", "steps": 3}, [True], [[1]]),
    ):
        with pytest.raises(ParameterError, match=r"^force"):
            Fields({"force": entry}).each(axis_from)
