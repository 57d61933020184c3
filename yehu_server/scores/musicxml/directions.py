"""Read directions of MusicXML: dynamics, hairpins, tempi, words and jumps."""

from collections import Counter
from xml.etree.ElementTree import Element

from yehu_server.scores.musicxml.elements import SCHEMA
from yehu_server.scores.musicxml.marks import VALUES, number
from yehu_server.scores.score import printable
from yehu_server.scores.written.notated import DYNAMICS, FORCED, HIGHEST_TEMPO, LOWEST_TEMPO
from yehu_server.scores.written.ticks import Ticks
from yehu_server.scores.written.voices import RawDirection
from yehu_server.scores.written.words import meaning_of

FORTE = 90.0  # the MIDI velocity of which <sound dynamics> is a percentage
LONGEST_WORDS = 200
JUMPS = ("dacapo", "dalsegno", "tocoda", "fine", "segno", "coda")


class DirectionReader:
    """Appends what directions say to a bar's."""

    def __init__(self, found: list[RawDirection], jumps: set[str], unknown: Counter[str]) -> None:
        self._found = found
        self._jumps = jumps
        self._unknown = unknown

    def read(self, direction: Element, now: Ticks, at: Ticks) -> None:
        """Read one <direction>: what it says at a beat, and its <sound> at that or `now`."""
        sound = direction.find("sound")
        if direction.find("offset[@sound='yes']") is not None:
            now = at
        tempo = None if sound is None else sound.get("tempo")
        has_dynamics = direction.find("direction-type/dynamics") is not None
        if sound is not None:
            self.sound(sound, now, with_dynamics=not has_dynamics)
        jumps = sound is not None and any(sound.get(name) for name in JUMPS)
        has_tempo = tempo is not None or direction.find("direction-type/metronome") is not None
        for child in direction.iterfind("direction-type/*"):
            tag = child.tag
            if tag == "dynamics":
                self.dynamics(child, at)
            elif tag == "wedge":
                self._add(at, "wedge", child.get("type", ""), None, child.get("number", "1")[:8])
            elif tag == "dashes":
                self._add(at, "dashes", child.get("type", ""))
            elif tag == "metronome" and tempo is None:
                self._metronome(child, at)
            elif tag == "words":
                self._words(child.text or "", at, has_tempo=has_tempo, jumps=jumps)
            elif tag in ("segno", "coda"):
                self._jumps.add(tag)

    def _add(
        self, at: Ticks, kind: str, name: str = "", value: float | None = None, which: str = ""
    ) -> None:
        self._found.append(RawDirection(at, kind, name, value, which))

    def dynamics(self, dynamics: Element, at: Ticks) -> None:
        """Read one <dynamics>."""
        for child in dynamics:
            name = child.tag
            if name == "other-dynamics":
                name = (child.text or "").strip()
            if name in DYNAMICS or name in FORCED:
                self._add(at, "sign", name)
            elif set(name) in ({"p"}, {"f"}):  # five and six of them
                self._add(at, "sign", name[:4])
            elif child.tag in SCHEMA:
                self._unknown[f"dynamics {printable(name)}"] += 1

    def sound(self, sound: Element, at: Ticks, *, with_dynamics: bool = True) -> None:
        """Read one <sound>."""
        if sound.get("time-only"):
            self._unknown["time-only of a sound"] += 1
        tempo = number(sound.get("tempo"))
        if LOWEST_TEMPO <= tempo <= HIGHEST_TEMPO:
            self._add(at, "tempo", "playback", tempo)
        percent = number(sound.get("dynamics"))
        if percent > 0.0 and with_dynamics:
            self._add(at, "sign", "velocity", min(max(FORTE * percent / 100.0, 1.0), 127.0))
        plucked = sound.get("pizzicato")
        if plucked in ("yes", "no"):
            self._add(at, "sign", "pizz" if plucked == "yes" else "arco")
        self._jumps.update(name for name in JUMPS if sound.get(name))

    def _metronome(self, metronome: Element, at: Ticks) -> None:
        unit = VALUES.get((metronome.findtext("beat-unit") or "").strip())
        dots = len(metronome.findall("beat-unit-dot")[:3])
        minute = (metronome.findtext("per-minute") or "").split()
        tempo = number(minute[-1].strip("().=")) if minute else 0.0
        if unit is None or tempo <= 0.0:
            self._unknown["metronome"] += 1
            return
        tempo *= float(unit) * (2.0 - 0.5**dots)
        if LOWEST_TEMPO <= tempo <= HIGHEST_TEMPO:
            self._add(at, "tempo", "figures", tempo)

    def _words(self, text: str, at: Ticks, *, has_tempo: bool, jumps: bool) -> None:
        words = text.strip()[:LONGEST_WORDS]
        if not words:
            return
        meaning = meaning_of(words)
        if meaning is None:
            if not has_tempo:  # beside a figure, any words are the tempo's name
                self._unknown[f'words "{printable(words)}"'] += 1
        elif meaning.kind == "jump":
            self._jumps.update(() if jumps else (meaning.name,))
        elif meaning.kind != "tempo":
            self._add(at, meaning.kind, meaning.name, meaning.value)
        elif not has_tempo:
            self._add(at, "tempo", "words", meaning.value)
