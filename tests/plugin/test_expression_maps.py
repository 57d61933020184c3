"""The expression maps for Cubase and Dorico: what they choose is what the plug-in reads."""

from xml.etree.ElementTree import fromstring

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.playing.mapping import load
from yehu_server.plugin.carried import carried
from yehu_server.plugin.expression_maps import (
    SWITCHES,
    TECHNIQUES,
    cubase_map,
    dorico_map,
    put_expression_maps,
)

NAMES = [each.name for each in ARTICULATIONS]
FIRST_KEY = load(SWITCHES).key_switches


def test_cubase_has_a_slot_for_each_articulation_and_its_key():
    root = fromstring(cubase_map(carried()))  # noqa: S314 - our own
    slots = root.findall("member[@name='slots']/list/obj")
    found = [
        (
            slot.find("member[@name='name']/string").get("value"),
            int(slot.find(".//obj[@class='POutputEvent']/int[@name='data1']").get("value")),
            slot.find("member[@name='sv']/list/obj/string[@name='text']").get("value"),
        )
        for slot in slots
    ]
    assert found == [(name, FIRST_KEY + i, name) for i, name in enumerate(NAMES)]
    identities = [each.get("ID") for each in root.iter("obj")]
    assert len(set(identities)) == len(identities)


def test_dorico_has_its_own_techniques_with_keys():
    root = fromstring(dorico_map(carried()))  # noqa: S314 - our own
    combinations = list(root.iter("playingTechniqueCombination"))
    found = {
        each.findtext("techniqueIDs"): int(each.findtext("switchOnActions/switchOnAction/param1"))
        for each in combinations
    }
    wanted = {which: FIRST_KEY + NAMES.index(name) for name, which in TECHNIQUES.items()}
    assert found == wanted
    assert [int(each.findtext("baseSwitchID")) for each in combinations] == list(range(len(found)))


def test_the_same_maps_come_each_time(tmp_path):
    paths = put_expression_maps(tmp_path, carried())
    assert [path.name for path in paths] == ["Yehu.expressionmap", "Yehu.doricolib"]
    assert paths[0].read_bytes() == cubase_map(carried())
