"""The scores of examples/, which `scripts/generate` writes; everything follows fixed rules.

shi_bei_jiu   the traditional tune, phrased for a yehu
mo_li_hua     the traditional tune for four yehus, in heterophony
slow_air      swells (CC 11), late vibrato (CC 77) and slides (CC 65, CC 5), for the mapping
              keyboard-expressive
bow_pressure  from flautando to scratch (CC 71) and from sul tasto to sul ponticello (CC 74), for
              the same mapping
mpe_phrase    pitch bend, pressure and bow position for each note, for the mapping mpe
"""

from __future__ import annotations

from tunes.expressive import bow_pressure, mpe_phrase, slow_air
from tunes.mo_li_hua import mo_li_hua
from tunes.shi_bei_jiu import shi_bei_jiu

EXAMPLES = {
    make.__name__: make for make in (shi_bei_jiu, mo_li_hua, slow_air, bow_pressure, mpe_phrase)
}
