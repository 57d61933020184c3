"""Write expression maps (keys of articulations) as Cubase and Dorico do; no format is described."""

from collections.abc import Iterator
from itertools import count
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.plugin.carried import Carried

NAME = "Yehu"
SWITCHES = "keyboard-articulations"  # the mapping of these keys
DECLARATION = '<?xml version="1.0" encoding="utf-8"?>\n'
NOTE_ON, VELOCITY = 0x90, 100
# Dorico's names of playing techniques, of those articulations that it has one for.
TECHNIQUES = {
    "ordinary": "pt.natural",
    "short": "pt.staccato",
    "staccato": "pt.staccatissimo",
    "spiccato": "pt.spiccato",
    "tremolo": "pt.tremolo",
    "sforzando": "pt.marcato",
    "pizzicato": "pt.pizzicato",
    "straight": "pt.nonVibrato",
    "rolling-vibrato": "pt.vibrato",
    "flageolet": "pt.naturalHarmonic1",
}
# All lists of a library of Dorico's, of which it wants each.
LISTS = (
    *("temperaments", "accidentalSystems", "accidentalDefinitions", "tonalitySystemDefinitions"),
    *("ensembles", "instruments", "instrumentNames", "instrumentFamilies", "clefDefinitions"),
    *("ottavaLineDefinitions", "noteheadSetDefinitions", "noteheadDefinitions"),
    *("restSetDefinitions", "restDefinitions", "flagSetDefinitions", "flagDefinitions"),
    *("graphicDefinitions", "blobDefinitions", "drawingDefinitions", "textDefinitions"),
    *("glyphDefinitions", "compositeDefinitions", "tempoPresetDefinitions"),
    *("rhythmicFeelDefinitions", "penstyles", "fontstyles", "brushstyles"),
    *("pagePairDefinitionSets", "pageDimensionPresets", "paragraphStyles", "characterStyles"),
    *("playingTechniques", "ornamentDefinitions", "multiSegmentLineDefinitions"),
    *("playingTechniqueAppearanceCollectionDefinition", "expressionMapDefinitions"),
    *("drumKitNoteMapDefinitions", "repeatableCompositeCollectionDefinitions"),
    "chordSymbolAppearanceCollectionDefinitions",
    "chordSymbolAppearanceComponentCollectionDefinitions",
    "percussionKitDefinitionCollectionDefinition",
    "percussionInstrumentDataCollectionDefinition",
    "frettedInstrumentDataCollectionDefinition",
    *("chordDiagramCollectionDefinition", "lineAnnotationCollectionDefinition"),
    *("lineBodyStyleCollectionDefinition", "lineStyleCollectionDefinition"),
)


def put_expression_maps(folder: Path, data: Carried) -> list[Path]:
    """Put the maps for Cubase and Dorico into a folder; return their files."""
    made = {"expressionmap": cubase_map(data), "doricolib": dorico_map(data)}
    paths = [folder / f"{NAME}.{ending}" for ending in made]
    for path, text in zip(paths, made.values(), strict=True):
        path.write_bytes(text)
    return paths


def cubase_map(data: Carried) -> bytes:
    """Write a map for Cubase, with a slot for each articulation."""
    ids = count(1)
    root = Element("InstrumentMap")
    _string(root, "name", NAME)
    visuals, slots = _list(root, "slotvisuals"), _list(root, "slots")
    for number, articulation in enumerate(ARTICULATIONS):
        _visual(visuals, articulation.name, ids)
        slot = _object(slots, "PSoundSlot", ids)
        remote = _object(slot, "PSlotThruTrigger", ids, name="remote")
        _values(remote, status=NOTE_ON, data1=-1)
        action = _object(slot, "PSlotMidiAction", ids, name="action")
        _values(action, version=600)
        changer = _object(_list(action, "noteChanger"), "PSlotNoteChanger", ids)
        _values(changer, channel=-1, velocityFact=1, lengthFact=1)
        _values(changer, minVelocity=0, maxVelocity=127, transpose=0, minPitch=0, maxPitch=127)
        event = _object(_list(action, "midiMessages"), "POutputEvent", ids)
        key = data.switches[SWITCHES] + number
        _values(event, status=NOTE_ON, data1=key, data2=VELOCITY)
        _values(action, channel=-1, velocityFact=1, lengthFact=1, minVelocity=0)
        _values(action, maxVelocity=127, transpose=0, maxPitch=127, minPitch=0, key=key)
        _visual(_list(slot, "sv", ownership=2), articulation.name, ids)
        _string(SubElement(slot, "member", name="name"), "s", articulation.name)
        _values(slot, color=number % 16)
    _values(SubElement(root, "member", name="controller"), ownership=1)
    return _text(root)


def dorico_map(data: Carried) -> bytes:
    """Write a library for Dorico, with the techniques that it has for articulations."""
    root = Element("kScoreLibrary")
    for name in LISTS:
        group = SubElement(root, name)
        if name == "instrumentNames":
            SubElement(group, "language").text = "kEnglish"
        entities = SubElement(group, "entities", array="true")
        if name == "expressionMapDefinitions":
            _dorico_definition(SubElement(entities, "ExpressionMapDefinition"), data)
    return _text(root)


def _dorico_definition(made: Element, data: Carried) -> None:
    _texts(
        made,
        name=NAME,
        entityID="xmap.user.yehu-server.yehu",
        parentEntityID="",
        inheritanceMask="0",
        creator="yehu-server",
        description=f"Choose {SWITCHES} as the mapping of the plug-in.",
        version="1",
        pluginNames=NAME,
        autoMutualExclusion="true",
        allowMultipleNotesAtSamePitch="false",
    )
    begin = SubElement(made, "initSwitchData")
    _texts(begin, enabled="true")
    SubElement(begin, "initActions", array="true")
    combinations = SubElement(made, "playingTechniqueCombinations", array="true")
    for number, articulation in enumerate(ARTICULATIONS):
        if articulation.name not in TECHNIQUES:
            continue
        each = SubElement(combinations, "playingTechniqueCombination")
        _texts(
            each,
            baseSwitchID=str(len(combinations) - 1),
            techniqueIDs=TECHNIQUES[articulation.name],
            enabled="true",
            exclusionGroup="1",
            flags="0",
            conditionString="",
            velocityRange="1,127",
            pitchRange="0,127",
            transpose="0",
            ticksBefore="0",
            velocityFactor="1.000000",
            lengthFactor="1.000000",
        )
        _texts(SubElement(each, "volumeType"), type="kCC", param1="11")
        _texts(SubElement(each, "attackType"), type="kNoteVelocity", param1="0")
        action = SubElement(SubElement(each, "switchOnActions", array="true"), "switchOnAction")
        key = data.switches[SWITCHES] + number
        _texts(action, type="kKeySwitch", param1=str(key), param2=str(VELOCITY))
        SubElement(each, "switchOffActions", array="true")
    SubElement(made, "techniqueAddOns", array="true")
    SubElement(made, "mutualExclusionGroups", array="true")


def _visual(into: Element, name: str, ids: Iterator[int]) -> None:
    visual = _object(into, "USlotVisuals", ids)
    _values(visual, displaytype=1, articulationtype=1, symbol=73)  # a direction, shown as text
    _string(visual, "text", name)
    _string(visual, "description", name)
    _values(visual, group=0)


def _object(into: Element, kind: str, ids: Iterator[int], **more: str) -> Element:
    return SubElement(into, "obj", {"class": kind, **more, "ID": str(next(ids))})


def _list(into: Element, name: str, ownership: int = 1) -> Element:
    member = SubElement(into, "member", name=name)
    _values(member, ownership=ownership)
    return SubElement(member, "list", name="obj", type="obj")


def _values(into: Element, **values: int) -> None:
    for name, value in values.items():
        kind = "float" if name.endswith("Fact") else "int"
        SubElement(into, kind, name=name, value=str(value))


def _string(into: Element, name: str, value: str) -> None:
    SubElement(into, "string", name=name, value=value, wide="true")


def _texts(into: Element, **texts: str) -> None:
    for name, text in texts.items():
        SubElement(into, name).text = text


def _text(root: Element) -> bytes:
    indent(root)
    return f"{DECLARATION}{tostring(root, encoding='unicode')}\n".encode()
