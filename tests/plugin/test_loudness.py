"""The plug-in is as loud as what is rendered, by presets and rooms, and plucked as bowed."""

import pytest
from loudness import BEGINS, LENGTHS, NAMES, VELOCITY, check, phrase
from plugin.sounds import script

import yehu_server as yehu
from yehu_server.playing.pitch_and_level import note_name

pytestmark = pytest.mark.slow
RATE = 48000
KEYS = {note_name(key): key for key in range(65, 90)}


@pytest.mark.parametrize("preset", ["vibrato", "pizzicato", "sul-tasto", "hall"])
def test_a_phrase_is_as_loud_as_rendered(play, shown, preset):
    chosen = shown["/room" if preset in shown["/room"].choices else "/preset"]
    messages = [
        (round((0.1 + begin + shift) * RATE), status, KEYS[name], VELOCITY)
        for name, begin, length in zip(NAMES, BEGINS, LENGTHS, strict=False)
        for status, shift in ((0x90, 0.0), (0x80, length))
    ]
    # Ends before begins, where one note ends as the next begins.
    messages.sort(key=lambda message: (message[0], message[1]))
    lines = [f"0 set {chosen.number} {chosen.choices.index(preset)}", *script(messages)]
    samples, _ = play(lines, round((BEGINS[-1] + 1.5) * RATE), rate=RATE)
    made = yehu.render(phrase(), preset=preset, phrasing=0.0, sample_rate=RATE)
    loudness = check(samples, RATE)
    assert loudness == pytest.approx(check(made.sound, RATE), abs=0.5)
