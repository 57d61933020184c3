"""All elements of MusicXML 4.0, as its schema has them: played, rightly silent, or told.

What is told is not understood, or has no meaning for this instrument; so is an element that
MusicXML does not have, wherever it stands. Marks of notes and chord symbols are told where they are
read.
"""

from collections import Counter
from xml.etree.ElementTree import Element

from yehu_server.scores.score import printable

_PLAYED = """
accent accidental-mark alter arpeggiate articulations artificial attributes backup barline
base-pitch beat-repeat beat-type beat-unit beat-unit-dot beats breath-mark caesura chord chromatic
coda dashes delayed-inverted-turn delayed-turn detached-legato direction direction-type divisions
doit dot down-bow duration dynamics ending f falloff fermata ff fff ffff fffff ffffff fifths
fingering first forward fp fz glissando grace harmonic haydn inverted-mordent inverted-turn
inverted-vertical-turn key measure measure-repeat measure-style metronome mf mordent movement-title
mp n natural notations note octave octave-change offset open open-string ornaments
other-articulation other-dynamics other-ornament other-technical p part part-list part-name
per-minute pf pitch plop pluck pp ppp pppp ppppp pppppp repeat rest rf rfz scoop score-part
score-partwise score-timewise second segno sf sffz sfp sfpp sfz sfzp shake slash-dot slash-type
slide slur snap-pizzicato soft-accent sound sounding-pitch spiccato staccatissimo staccato staff
step straight stress string strong-accent swing swing-type technical tenuto tie tied time
touching-pitch transpose tremolo trill-mark turn type unstress up-bow vertical-turn voice wavy-line
wedge words work work-title
"""
_TOLD = """
accordion-registration arrow bend brass-bend cue damp damp-all double-tongue eyeglasses figured-bass
fingernails flip fret golpe half-muted hammer-on handbell harmon-mute harmony harp-pedals heel hole
non-arpeggiate other-direction other-notation pedal percussion pull-off schleifer scordatura slash
smear stopped string-mute symbol tap thumb-position toe triple-tongue unpitched
"""
# Print, layout, lyrics, names, other programs' sounds; and parts of elements that are told.
_SILENT = """
accidental accidental-text accord accordion-high accordion-low accordion-middle actual-notes
appearance arrow-direction arrow-style arrowhead assess bar-style barre bass bass-alter
bass-separator bass-step beam beat-unit-tied beater bend-alter bookmark bottom-margin bracket cancel
capo circular-arrow clef clef-octave-change concert-score creator credit credit-image credit-symbol
credit-type credit-words defaults degree degree-alter degree-type degree-value diatonic directive
display-octave display-step display-text distance double effect elevation elision encoder encoding
encoding-date encoding-description end-line end-paragraph ensemble except-voice extend feature
figure figure-number first-fret footnote for-part frame frame-frets frame-note frame-strings
function glass glyph group group-abbreviation group-abbreviation-display group-barline group-link
group-name group-name-display group-symbol group-time grouping harmon-closed hole-closed hole-shape
hole-type humming identification image instrument instrument-abbreviation instrument-change
instrument-link instrument-name instrument-sound instruments interchangeable inversion ipa
key-accidental key-alter key-octave key-step kind laughing left-divider left-margin level line
line-detail line-width link listen listening lyric lyric-font lyric-language measure-distance
measure-layout measure-numbering membrane metal metronome-arrows metronome-beam metronome-dot
metronome-note metronome-relation metronome-tied metronome-tuplet metronome-type midi-bank
midi-channel midi-device midi-instrument midi-name midi-program midi-unpitched millimeters
miscellaneous miscellaneous-field mode movement-number multiple-rest music-font mute normal-dot
normal-notes normal-type note-size notehead notehead-text numeral numeral-alter numeral-fifths
numeral-key numeral-mode numeral-root octave-shift opus other-appearance other-listen
other-listening other-percussion other-play page-height page-layout page-margins page-width pan
part-abbreviation part-abbreviation-display part-clef part-group part-link part-name-display
part-symbol part-transpose pedal-alter pedal-step pedal-tuning pitched play player player-name
pre-bend prefix principal-voice print rehearsal relation release right-divider right-margin rights
root root-alter root-step scaling score-instrument semi-pitched senza-misura sign software solo
source staff-details staff-distance staff-divide staff-layout staff-lines staff-size staff-tuning
staff-type staves stem stick stick-location stick-material stick-type suffix supports swing-style
syllabic sync system-distance system-dividers system-layout system-margins tenths text
time-modification time-relation timpani top-margin top-system-distance tuning-alter tuning-octave
tuning-step tuplet tuplet-actual tuplet-dot tuplet-normal tuplet-number tuplet-type
virtual-instrument virtual-library virtual-name volume wait with-bar wood word-font work-number
"""
PLAYED, TOLD, SILENT = (frozenset(names.split()) for names in (_PLAYED, _TOLD, _SILENT))
READ_ELSEWHERE = frozenset({"notations", "harmony", "figured-bass"})  # which tells of their own
SAID_THERE = frozenset({"cue", "unpitched"})  # as notes that are not played
BY_BAR = frozenset({"slash"})  # under which notes have no pitch: the place is told
_NAMED = TOLD - SAID_THERE
SCHEMA = PLAYED | TOLD | SILENT


def tell_strange(root: Element, unknown: Counter[str]) -> None:
    """Count elements of a score that MusicXML does not have."""
    unknown.update(printable(each.tag) for each in root.iter() if each.tag not in SCHEMA)


def tell(measure: Element, number: str, unknown: Counter[str]) -> None:
    """Count elements of a bar that are not understood."""
    inner = [measure]
    while inner:
        for child in inner.pop():
            tag = child.tag
            if tag in READ_ELSEWHERE:
                continue
            if tag in _NAMED and child.get("type") != "stop":
                place = f" (bar {number})" if tag in BY_BAR else ""
                unknown[f"{tag}{place}"] += 1
            if tag not in _NAMED and len(child):
                inner.append(child)
