"""Write what an LV2 bundle declares, in Turtle: ports, parameters, presets."""

import json
from collections.abc import Iterable, Sequence

from yehu_server.plugin.carried import Carried
from yehu_server.plugin.header import LV2_URI
from yehu_server.plugin.parameters import PRESET, ROOM, HostParameter
from yehu_server.util import __version__

PREFIXES = """\
@prefix atom: <http://lv2plug.in/ns/ext/atom#> .
@prefix doap: <http://usefulinc.com/ns/doap#> .
@prefix foaf: <http://xmlns.com/foaf/0.1/> .
@prefix lv2: <http://lv2plug.in/ns/lv2core#> .
@prefix midi: <http://lv2plug.in/ns/ext/midi#> .
@prefix pg: <http://lv2plug.in/ns/ext/port-groups#> .
@prefix pprops: <http://lv2plug.in/ns/ext/port-props#> .
@prefix pset: <http://lv2plug.in/ns/ext/presets#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix time: <http://lv2plug.in/ns/ext/time#> .
@prefix ui: <http://lv2plug.in/ns/extensions/ui#> .
@prefix units: <http://lv2plug.in/ns/extensions/units#> .
@prefix urid: <http://lv2plug.in/ns/ext/urid#> .
"""
PLUGIN = """\
<http://kx.studio/ns/lv2ext/control-input-port-change-request>
    a lv2:Feature .

<{uri}>
    a lv2:InstrumentPlugin , lv2:Plugin , doap:Project ;
    doap:name "Yehu" ;
    doap:license <https://spdx.org/licenses/MIT> ;
    doap:maintainer [ foaf:name "yehu-server" ] ;
    rdfs:comment "A physical model of the yehu, the Chinese two-stringed fiddle." ;
    lv2:minorVersion {minor} ;
    lv2:microVersion {micro} ;
    lv2:requiredFeature urid:map ;
    lv2:optionalFeature lv2:hardRTCapable ,
        <http://kx.studio/ns/lv2ext/control-input-port-change-request> ;
    lv2:port [
        a lv2:InputPort , atom:AtomPort ;
        atom:bufferType atom:Sequence ;
        atom:supports midi:MidiEvent , time:Position ;
        lv2:designation lv2:control ;
        lv2:index 0 ; lv2:symbol "events" ; lv2:name "Events"
    ] , [
        a lv2:OutputPort , lv2:AudioPort ;
        lv2:designation pg:left ; pg:group <{uri}#group_output_pair> ;
        lv2:index 1 ; lv2:symbol "left" ; lv2:name "Left"
    ] , [
        a lv2:OutputPort , lv2:AudioPort ;
        lv2:designation pg:right ; pg:group <{uri}#group_output_pair> ;
        lv2:index 2 ; lv2:symbol "right" ; lv2:name "Right"
    ] , [
        a lv2:OutputPort , lv2:ControlPort ;
        lv2:designation lv2:latency ; lv2:portProperty lv2:reportsLatency , lv2:integer ;
        units:unit units:frame ;
        lv2:index 3 ; lv2:symbol "latency" ; lv2:name "Latency" ;
        lv2:minimum 0 ; lv2:maximum 192 ; lv2:default 0
    ] , {ports} .

<{uri}#group_output_pair> a pg:OutputGroup , pg:StereoGroup ;
    lv2:symbol "output_pair" ; lv2:name "Output" .
{groups}"""
WINDOW = """\
<{uri}#window>
    a {kind} ;
    ui:binary <{library}> ;
    lv2:requiredFeature ui:parent , <http://lv2plug.in/ns/ext/instance-access> ;
    lv2:optionalFeature ui:resize , ui:touch ;
    lv2:extensionData ui:idleInterface , ui:resize .
"""
FIRST_PARAMETER = 4  # number of its port
UNITS = {
    "dB": "units:db",
    "Hz": "units:hz",
    "1/s": "units:hz",
    "ms": "units:ms",
    "s": "units:s",
    "m": "units:m",
    "cents": "units:cent",
    "semitones": "units:semitone12TET",
}


def in_lv2(shown: Iterable[HostParameter]) -> list[HostParameter]:
    """The parameters that are ports: but for preset and room, as LV2 has presets of its own."""
    return [each for each in shown if each.address not in (PRESET, ROOM)]


def manifest(library: str, data: Carried, window: str = "") -> str:
    """Write manifest.ttl, for the library, presets and kind of window (of LV2's) of the bundle."""
    about = f"a lv2:Plugin ;\n    lv2:binary <{library}> ;\n    rdfs:seeAlso <Yehu.ttl>"
    about += f" ;\n    ui:ui <{LV2_URI}#window> .\n" if window else " .\n"
    texts = [f"<{LV2_URI}>\n    {about}"]
    if window:
        texts.append(WINDOW.format(uri=LV2_URI, kind=window, library=library))
    texts += [
        f"<{_preset(name)}>\n    a pset:Preset ;\n    lv2:appliesTo <{LV2_URI}> ;\n"
        f"    rdfs:label {_text(label)} ;\n    rdfs:seeAlso <presets.ttl> .\n"
        for name, label in _labels(data).items()
    ]
    return "\n".join([PREFIXES, *texts])


def plugin_text(shown: Sequence[HostParameter]) -> str:
    """Write the description of the plug-in."""
    major, minor, micro = __version__.split(".")
    ports = [_port(FIRST_PARAMETER + i, each) for i, each in enumerate(in_lv2(shown))]
    groups = dict.fromkeys(each.group for each in in_lv2(shown))
    return f"{PREFIXES}\n" + PLUGIN.format(
        uri=LV2_URI,
        # An odd number, or zero, would say that it is not yet to be used. LV2 has no major one.
        minor=2 * (100 * int(major) + int(minor)),
        micro=2 * int(micro),
        ports=" , ".join(ports),
        groups="".join(
            f"\n<{_group(name)}> a pg:InputGroup ;\n"
            f'    lv2:symbol "{_group_symbol(name)}" ; lv2:name {_text(name)} .\n'
            for name in groups
        ),
    )


def presets_text(shown: Iterable[HostParameter], data: Carried) -> str:
    """Write the presets, each with the ports it sets."""
    symbols = {each.address: each.symbol for each in shown}
    texts = []
    for name in _labels(data):
        ports = " , ".join(
            f'[\n        lv2:symbol "{symbols[address]}" ; pset:value {value:.9g}\n    ]'
            for address, value in (data.presets | data.rooms)[name].items()
        )
        texts.append(f"<{_preset(name)}>\n    a pset:Preset ;\n    lv2:port {ports} .\n")
    return "\n".join([PREFIXES, *texts])


def _labels(data: Carried) -> dict[str, str]:
    """What hosts call each preset in their one list, which shows the one that was chosen last."""
    sounds = {name: name for name, values in data.presets.items() if values}
    return sounds | {name: f"{name} (room)" for name, values in data.rooms.items() if values}


def _port(index: int, each: HostParameter) -> str:
    lines = [
        "a lv2:InputPort , lv2:ControlPort",
        f'lv2:index {index} ; lv2:symbol "{each.symbol}" ; lv2:name {_text(each.name)}',
        f"lv2:minimum {each.lo:.9g} ; lv2:maximum {each.hi:.9g} ; lv2:default {each.default:.9g}",
        f"rdfs:comment {_text(each.doc)}",
        f"pg:group <{_group(each.group)}>",
    ]
    if each.choices:
        lines.append("lv2:portProperty lv2:integer , lv2:enumeration")
        labels = map(_text, each.choices)
        numbered = enumerate(labels, round(each.lo))
        points = (f"[ rdfs:label {name} ; rdf:value {number} ]" for number, name in numbered)
        lines.append(f"lv2:scalePoint {' , '.join(points)}")
    elif each.steps > 0:
        lines.append("lv2:portProperty lv2:integer")
    if each.is_exponential:
        lines.append("lv2:portProperty pprops:logarithmic")
    if each.unit:
        lines.append(f"units:unit {UNITS.get(each.unit) or _unit(each.unit)}")
    return "[\n        " + " ;\n        ".join(lines) + "\n    ]"


def _unit(unit: str) -> str:
    texts = (_text(text) for text in (unit, unit, f"%f {unit}"))
    return "[ a units:Unit ; rdfs:label {} ; units:symbol {} ; units:render {} ]".format(*texts)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _preset(name: str) -> str:
    return f"{LV2_URI}:preset:{name}"


def _group(name: str) -> str:
    return f"{LV2_URI}#{_group_symbol(name)}"


def _group_symbol(name: str) -> str:
    return f"group_{name.lower().replace('-', '_')}"
