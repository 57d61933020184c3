"""The same MIDI file by `render`, the library for C programs, the page's module and the plug-in."""

import shutil

import mido
import numpy as np
import pytest
from ahead.likeness import NEAR, apart, are_near, begins_alike
from ahead.streams import BLOCK, RATE, REPORTING, Step, Stream, commands_in, record_in
from ahead.test_streams import assert_near
from plugin.sounds import PHRASE, played, prepared, script, write_midi

from yehu_server.core.engine.rig import RIG
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.rendering import performance
from yehu_server.rendering.options import Options, Part
from yehu_server.scores.smf.reader import read_score

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("node") is None, reason="there is no node"),
]
BLOCKS = 750  # two seconds
FRAMES = BLOCKS * BLOCK
REST = 4000  # frames before the first sound, in which there is nothing to compare


@pytest.fixture
def file(tmp_path):
    return write_midi(tmp_path / "phrase.mid", PHRASE, FRAMES)


@pytest.fixture
def messages(file):
    """What is in the file, as a host plays it: frames and bytes."""
    now, found = 0.0, []
    for message in mido.MidiFile(file):
        now += message.time
        if not message.is_meta:
            found.append((round(now * RATE), *message.bytes()))
    return found


def by_render(file, monkeypatch):
    """Samples and commands of `render`, which else takes the lengths of notes from the score."""
    monkeypatch.setattr(performance, "notes_of", lambda _score: ())
    options = Options(rate=int(RATE), tail_s=0.0)
    playing = performance.Performance([Part(read_score(file))], options, reports=True)
    samples = np.concatenate(list(playing.blocks()))[:FRAMES]
    commands = commands_in(playing.ensemble.first._rig)
    return samples, commands[commands["index"] != INDEX["/playing/phrasing"]]


def by_library(path, messages):
    library, memory = prepared(path, RATE)
    record = memory[: RIG.itemsize]
    record.view(np.int64)[REPORTING] = 1
    return played(library, memory, messages, FRAMES), commands_in(record.view(RIG))


def by_page(node, messages, folder):
    steps = [Step("midi", frame, tuple(data), ()) for frame, *data in messages]
    lines, tables = map(str, Stream(steps, []).write(folder))
    job = {"rate": RATE, "steps": lines, "tables": tables, "count": 0, "blocks": BLOCKS}
    files = {name: str(folder / name) for name in ("memory", "samples")}
    assert node("streams.mjs", **job, **files, reporting=REPORTING) == {"finite": True, "lost": 0}
    samples = np.fromfile(folder / "samples", np.float32).reshape(-1, 2)
    return samples, commands_in(record_in(folder / "memory"))


def test_a_file_comes_to_the_same_commands_and_samples(
    file, messages, library, node, play, tmp_path, monkeypatch
):
    """A plug-in reports no commands; its samples are the library's, to the last bit."""
    assert messages == [(frame, *data) for frame, *data in PHRASE]
    rendered, wanted = by_render(file, monkeypatch)
    in_c, found = by_library(library, messages)
    assert len(wanted) > len(PHRASE)
    assert found.tobytes() == wanted.tobytes()
    in_page, found = by_page(node, messages, tmp_path)
    assert_near(found, wanted)
    in_host, _ = play(["0 play 1", *script(messages)], FRAMES)
    assert np.array_equal(in_host, in_c)
    usual = apart(in_c, rendered)
    for samples in (in_c, in_page):
        assert not samples[:REST].any()
        assert begins_alike(samples[REST:], rendered[REST:])
    assert are_near(apart(in_page, rendered), np.maximum(2.0 * usual.max(axis=0), NEAR))
