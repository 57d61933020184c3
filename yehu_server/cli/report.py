"""The texts and tables in which commands report results."""

from __future__ import annotations

import ipaddress
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.errors import one_line
from yehu_server.live.network import ANYWHERE, format_address
from yehu_server.live.page.guests import LISTEN, OWN, PLAY, Guests
from yehu_server.params.table import PREFIX, find
from yehu_server.playing.mapping import Mapping as ControllerMapping
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.rendering.replay import Replayed
from yehu_server.rendering.summary import PartSummary, Summary, counted
from yehu_server.simulation.run import Simulation, faults_of
from yehu_server.util.hints import command_name

if TYPE_CHECKING:
    from rich.table import Table

NOTABLE_BOUND = 1.2  # friction bound; the measured instrument at 44.1 kHz has 1.02


def decibels(level: float) -> str:
    """A level relative to full scale, in dB, for reading."""
    return f"{20.0 * math.log10(level):.1f} dBFS" if level > 0.0 else "silence"


def render_report(target: Path, summary: Summary) -> str:
    """The report on a rendering."""
    pace = f"{summary.duration_s:.1f} s, {summary.real_time_factor:.0f} x real time"
    timing = ", timing shaped (--rubato 0 keeps the file's)" if summary.timing_shaped else ""
    level = f"sample peak {decibels(summary.peak)}, rms {decibels(summary.rms)}"
    if summary.loudness_lufs is not None:
        level += f", {summary.loudness_lufs:.1f} LUFS"
    lines = [f"{target}: {pace}, {level}{timing}"]
    heard = ", ".join(
        f"{channel + 1} ({counted(notes, 'note')})"
        for channel, notes in summary.notes_by_channel.items()
    )
    only = summary.parts[0]
    if len(summary.parts) > 1 or only.people > 1:
        lines += map(_part_line, summary.parts)
    elif only.notes_played and only.heard and not only.heard.startswith("channel "):
        lines.append(f"{one_line(only.heard)}: {_notes(only)}")
    else:
        plural = "s" if len(summary.notes_by_channel) > 1 else ""
        lines.append(f"MIDI channel{plural} {heard}" if heard else "no notes to play")
    lines += summary.remarks("; --channel 10 plays them")
    if summary.friction_bound >= NOTABLE_BOUND:
        lines.append(
            "note: at this sample rate the bow sticks less reliably; a higher --rate is better"
        )
    return "\n".join(lines)


def _part_line(part: PartSummary) -> str:
    side = "middle" if abs(part.pan) < 0.005 else f"{100.0 * abs(part.pan):.0f} % "
    side += "" if side == "middle" else ("left" if part.pan < 0.0 else "right")
    place = f"{side}, {part.distance_m:.1f} m"
    name = one_line(part.name) + (f", {part.people} players" if part.people > 1 else "")
    return f"{name}: {_notes(part)}, {place}"


def _notes(part: PartSummary) -> str:
    """How many notes a part has, and how many with grace notes and trills."""
    if 0 < part.notes_written < part.notes_played:
        return f"{counted(part.notes_written, 'note')} ({part.notes_played} with ornaments)"
    return counted(part.notes_played, "note")


def simulate_report(target: Path, result: Simulation) -> str:
    """The report on a simulation."""
    meta, arrays = result.meta, result.arrays
    intervals = " and ".join(str(N) for N in meta["grid_intervals"])
    size = f"{meta['frames']} samples at {meta['sample_rate']:g} Hz, {intervals} grid intervals"
    iterations = float(np.mean(arrays["iterations"]))
    lines = [f"{target}: {size}, {iterations:.1f} friction iterations a sample"]
    if "energy_error" in arrays:
        flow = max(float(np.abs(arrays["power_in"]).max()), 1e-300)
        error = float(np.abs(arrays["energy_error"]).max())
        lines.append(f"energy error at most {error:.1e} W, {error / flow:.1e} of the power in")
    if faults := faults_of(meta):
        lines.append(faults)
    if meta["friction_bound"] >= NOTABLE_BOUND:
        lines.append(
            "note: at this sample rate and epsilon_0 the equation of friction may have several "
            f"solutions (bound {meta['friction_bound']:.1f}, docs/physics.md)"
        )
    return "\n".join(lines)


def replay_report(target: Path, result: Replayed) -> str:
    """The report on a replay."""
    pace = f"{result.duration_s:.1f} s, {result.real_time_factor:.0f} x real time"
    line = f"{target}: {pace}, peak {decibels(result.peak)}, rms {decibels(result.rms)}"
    return f"{line}\n{counted(result.events, 'event')}"


def follow_report(target: Path, fields: Mapping[str, Any]) -> str:
    """The report on a recording that was followed."""
    notes, strokes = counted(fields["notes"], "note"), counted(fields["strokes"], "stroke")
    line = f"{target}: {fields['duration_s']:.1f} s, {notes} in {strokes}"
    octaves, rest = divmod(abs(fields["transposed"]), 12.0)
    if fields["transposed"]:
        way = "up" if fields["transposed"] > 0.0 else "down"
        by = (
            counted(round(octaves), "octave")
            if not rest
            else f"{abs(fields['transposed']):g} semitones"
        )
        line += f", {by} {way}"
    if fields["notes_moved"]:
        moved = counted(fields["notes_moved"], "note")
        line += f"\n{moved} outside {fields['range']}, moved by octaves"
    return line


def mapping_report(mapping: ControllerMapping) -> None:
    """Print a mapping as a table of sources, targets and ranges."""
    from rich.console import Console
    from rich.table import Table

    console = Console(markup=False, emoji=False, highlight=False)
    console.print(one_line(f"{mapping.name}: {mapping.about}" if mapping.about else mapping.name))
    table = Table()
    for column in ("you move", "what moves", "from", "to", "curve"):
        table.add_column(column, overflow="fold")
    if any(bind.terms for bind in mapping.binds):
        table.add_column("terms", overflow="fold")
    for bind in mapping.binds:
        param = find(bind.target)
        unit = "" if param.unit == "1" else f" {param.unit}"
        ends = [f"{end:g}{unit}" for end in bind.output_range]
        if bind.is_by_range:
            ends = ["- bend range", "+ bend range"][:: -1 if bind.invert else 1]
        cells = (bind.source, bind.target, *ends, bind.curve_name, "; ".join(bind.terms))
        table.add_row(*map(one_line, cells[: len(table.columns)]))
    console.print(table)
    for address, value in mapping.start:
        param = find(address)
        unit = "" if param.unit == "1" else f" {param.unit}"
        console.print(f"starts with {address} = {value:g}{unit}")
    if mapping.mpe:
        console.print("starts with one MPE zone of 15 member channels on every port")


def bindings_table(rows: Sequence[Sequence[Any]]) -> Table:
    """A table of the binds of a running server, with present positions and values."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for column in ("you move", "what moves", "from, to", "is at", "value", "terms"):
        table.add_column(column, overflow="fold", no_wrap=column in ("you move", "what moves"))
    for source, target, first, last, _curve, terms, position, value in rows:
        param = find(target.removeprefix(PREFIX))
        unit = "" if param.unit == "1" else f" {param.unit}"
        at = "-" if position < 0.0 else f"{100.0 * position:.0f} %"
        span = f"{first:.4g}, {last:.4g}{unit}"
        cells = (source, param.address, span, at, f"{value:.4g}{unit}", terms)
        table.add_row(*map(one_line, cells))
    return table


def status_line(status: Mapping[str, float | str]) -> str:
    """The status of a running server in one line."""
    note, speed = float(status["note"]), float(status["bow_speed"])
    arrow = "" if speed == 0.0 else (" down" if speed > 0.0 else " up")
    gaps = [f"missed {status['missed_deadlines']}", f"under-runs {status['underruns']}"]
    has_gaps = int(status["missed_deadlines"]) or int(status["underruns"])
    parts = [  # a narrow terminal shows the first of them
        *(gaps[::-1] if has_gaps else ()),
        str(status["device"]),
        f"{float(status['peak_db']):6.1f} dBFS",
        f"note {note_name(note):>7}" if note >= 0.0 else "note    none",
        f"bow {abs(speed):.2f} m/s{arrow}",
        f"load {100.0 * float(status['load']):.0f} %",
        *(() if has_gaps else gaps),
        f"MIDI {status['midi_ports'] or 'none'}",
    ]
    if status["recording"]:
        parts.append(f"recording {status['recording']}")
    return one_line(" | ".join(parts))


def connect_lines(
    host: str, port: int, lan: ipaddress.IPv4Interface, *, is_open: bool
) -> list[str]:
    """Lines that say how to reach the server; `is_open` where it accepts any sender."""
    lines = [f"OSC at {format_address(host, port)} (UDP and TCP), such as {PREFIX}/note 67 90"]
    address = ipaddress.ip_address(host)
    if address.is_loopback:
        hint = f"add --osc {lan.ip}:{port} --osc-allow {lan.network}"
        lines.append(f"for OSC from other machines of this network: {hint}")
    else:
        where = lan.ip if address.is_unspecified else host
        lines.append(f"on a phone (TouchOSC): host {where}, send port {port}")
        if not address.is_unspecified:
            hint = f"--osc {ANYWHERE}:{port} hears both"
            lines.append(f"programs of this machine send to {host} too, not to 127.0.0.1; {hint}")
        if is_open:
            lines.append("anyone on this network may play; --osc-allow restricts it")
    return lines


GUESTS = {LISTEN: "listen", PLAY: "play and listen", OWN: "play, listen and change everything"}


def page_lines(
    host: str, port: int, lan: str, *, networks: Sequence[str], guests: Guests | None = None
) -> list[str]:
    """Lines that say where the page is, and who may play with it."""
    is_anywhere = ipaddress.ip_address(host).is_unspecified
    lines = [f"the page at http://{format_address('127.0.0.1' if is_anywhere else host, port)}/"]
    phones = page_for_phones(host, port, lan, guests)
    if not phones:
        lines.append(f"for a phone on this network: {command_name()} serve --lan")
        return lines
    if is_anywhere:
        lines.append(f"on a phone: {phones}")
    others = [
        network
        for network in networks
        if not ipaddress.ip_network(network, strict=False).is_loopback
    ]
    who = f"at {' or '.join(others)}" if others else "on this network"
    if guests is None:
        lines.append(f"anyone {who} may play and listen, without a password")
    else:
        lines.append(f"whoever {who} has the PIN {guests.pin} may {GUESTS[guests.role]}")
    return lines


def page_for_phones(host: str, port: int, lan: str, guests: Guests | None = None) -> str:
    """The address of the page for other machines, with guests' PIN; empty where there are none."""
    address = ipaddress.ip_address(host)
    if address.is_loopback:
        return ""
    pin = "" if guests is None else f"?pin={guests.pin}"
    return f"http://{format_address(lan if address.is_unspecified else host, port)}/{pin}"


def query_line(host: str, port: int, lan: str) -> str:
    """A line with the address of OSCQuery."""
    address = ipaddress.ip_address(host)
    return f"OSCQuery at http://{format_address(lan if address.is_unspecified else host, port)}/"
