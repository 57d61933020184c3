"""Files of studies."""

import pytest

from yehu_lab.sweeps.journal import key_of_study
from yehu_lab.sweeps.study import read_study, study_from_text, study_of
from yehu_server.errors import ParameterError
from yehu_server.util.files import shipped_folder

STUDIES = sorted((shipped_folder("examples") / "studies").glob("*.toml"))


def test_the_shipped_studies_can_be_run_and_keep_the_order_of_their_axes():
    """Points are numbered by it, in a journal and on a cluster."""
    assert {path.stem for path in STUDIES} == {
        *("schelleng", "guettler", "force_limits", "press", "place", "tension", "friction")
    }
    for path in STUDIES:
        study = read_study(path)
        assert study.data["about"]
        assert 100 < study.coarse < 10_000
        again = study_from_text(study.as_text())
        assert [axis.name for axis in again.axes] == [axis.name for axis in study.axes]


def test_a_study_is_the_same_from_its_text_and_another_by_the_order_of_its_axes(data):
    study = study_of(data())
    again = study_from_text(study.as_text())
    assert again.axes == study.axes
    assert again.as_text() == study.as_text()
    turned = data() | {"vary": dict(reversed(data()["vary"].items()))}
    assert key_of_study(study_of(turned)) != key_of_study(study) == key_of_study(again)


def test_what_is_wrong_in_a_study_is_reported_in_a_line(data, subtests):
    for more, wrong in (
        ({"strokes": {}}, "strokes: unknown entry; did you mean stroke"),
        ({"stroke": {"froce": 1}}, "stroke.froce: unknown entry; did you mean force"),
        ({"stroke": {"note": 64}}, "note: 64 is not within 65"),
        ({"stroke": {"string": 2, "note": 70}}, "not within 72 to 96, which are on string 2"),
        ({"stroke": {"string": 1.5}}, "not a whole number"),
        ({"vary": {}}, "nothing is varied"),
        ({"vary": {"force": [0.1, 99.0]}}, "force: 99.0 is not within"),
        ({"vary": {"instrument": {"bow": {"mu": [1.0]}}}}, "instrument.bow.mu: unknown entry"),
        ({"vary": {"instrument": {"bow": {"mu_S": [1.0, 0.1]}}}}, "mu_S must not be below"),
        ({"refine": {"axes": ["speed"], "levels": 1}}, "refine.axes: 'speed' is not one of"),
        ({"refine": {"axes": ["force"], "levels": 9}}, "refine.levels: expected a whole number"),
        ({"refine": {"axes": ["force"], "border": "wolf"}}, "'wolf' is not one of"),
        ({"duration": 0.01}, "duration: 0.01 is not within"),
        ({"duration": 0.035}, "too short to judge"),
        ({"sample_rate": 8000}, "8000"),
        ({"instrument": {"string_3": {}}}, "instrument.string_3: unknown entry; did you mean"),
        ({"gesture": {"duration": 0.1}}, "belongs into the gesture"),
    ):
        with subtests.test(wrong):
            with pytest.raises(ParameterError, match=wrong) as error:
                study_of(data() | {"refine": {}} | more)
            assert "\n" not in str(error.value)
    with pytest.raises(ParameterError, match="expected a table"):
        study_of([data()])


def test_too_many_strokes_are_refused_before_any(data):
    many = {name: {"from": 0.1, "to": 0.2, "steps": 90_000} for name in ("force", "position")}
    with pytest.raises(ParameterError, match="strokes are more than"):
        study_of(data(vary=many, refine={}))
