"""Random bytes through random mappings: no trap, no number that is not finite, no note left."""

import json
import shutil
import subprocess

import pytest
from ahead.programs import compiled, run_in_plain_python
from ahead.tables import some_tables

from yehu_server.core.engine.rig import MIDI_AT
from yehu_server.core.midi.record import MIDI

midi_fields = MIDI.fields or {}
HELD, SOUNDING = ((MIDI_AT + midi_fields[name][1]) // 8 for name in ("held", "sounding"))
SOME, MANY = 50_000, 1_000_000
TABLES = 30  # that plain Python plays through


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_no_random_bytes_through_random_mappings_leave_a_note(library, tmp_path, everything):
    made = [tables for tables in some_tables(1, 40) if tables["received"] == -1.0]
    (tmp_path / "tables").write_bytes(b"".join(each.tobytes() for each in made))
    program = compiled(library, tmp_path / "fuzz", "fuzz.c")
    count = MANY if everything else SOME
    command = [program, str(count), "1", tmp_path / "tables", str(HELD), str(SOUNDING)]
    numbers = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    posted, taken, refused, wrong, left, beyond, lost = map(int, numbers)
    assert posted >= count
    assert min(taken, refused) >= count // 1000 // 25  # both are tried
    assert (wrong, left, beyond, lost) == (0, 0, 0, 0)


def test_no_tables_that_are_taken_lead_outside_an_array_or_to_a_number_that_is_not_finite(tmp_path):
    # Plain Python checks each index, and raises at a division by zero.
    run_in_plain_python("tables.py", TABLES, tmp_path / "counts")
    counts = json.loads((tmp_path / "counts").read_text())
    assert min(counts["taken"], counts["refused"]) > TABLES // 5
    assert counts["commands"] > 10 * TABLES
