"""A sound server's period may differ from the block size: rhythm is kept, status has both."""

import subprocess
import sys
import time

import pytest

pytestmark = pytest.mark.slow

DEVICE = "system, JACK Audio Connection Kit"
BLOCK = 128
MESSAGES = 80
ASK_FOR = """
import os, sys, jack

client = jack.Client("period", servername=sys.argv[1], no_start_server=True)
client.blocksize = int(sys.argv[2])
os._exit(0)
"""


def ask_for(jackd, period: int) -> None:
    """Change the period of a running JACK server."""
    words = [sys.executable, "-c", ASK_FOR, jackd.name, str(period)]
    run = subprocess.run(words, env=jackd.environment, timeout=20.0, check=False)
    assert run.returncode == 0


def share_late(osc) -> float:
    """Share of messages that came too late for their frame."""
    before = osc.status()
    for number in range(MESSAGES):
        osc.send("/finger/1/position", 0.1 + 1e-4 * (number % 50))
        time.sleep(0.001 * (3 + number % 5))
    time.sleep(0.1)
    after = osc.status()
    assert after["applied_events"] - before["applied_events"] == MESSAGES
    return (after["late_events"] - before["late_events"]) / MESSAGES


def settled(osc, until, period: int) -> dict:
    """The status, once it shows the period."""
    until(lambda: osc.status()["period"] == period, f"a period of {period}", 20.0)
    status = osc.status()
    assert status["blocksize"] == BLOCK
    return status


def covered(osc, until, period: int) -> dict:
    """The status, once the delay exceeds a period; the loop takes a moment to settle."""
    settled(osc, until, period)
    length = 1e3 * period / 48000
    until(lambda: osc.status()["delay_ms"] > length, f"a delay of more than {length} ms", 20.0)
    return osc.status()


@pytest.fixture
def player(jackd, serve):
    """Start a server on JACK with some period; return a client of it."""

    def start(period: int, *words: object):
        jackd.start(period)
        server = serve("--midi-api", "none", "--blocksize", BLOCK, *words)
        osc = server.osc()
        server.said(f"playing on {DEVICE}")
        return osc

    return start


def test_rhythm_is_kept_where_the_period_changes_while_it_plays(jackd, player, until):
    osc = player(64)
    assert settled(osc, until, BLOCK)["delay_ms"] < 1e3 * 1024 / 48000
    ask_for(jackd, 1024)
    status = covered(osc, until, 1024)
    assert status["device_losses"] == 0
    # With a delay of one block half came too late. The system itself may sometimes hold us up.
    assert share_late(osc) < 0.2
    ask_for(jackd, 256)
    covered(osc, until, 256)
    assert share_late(osc) < 0.2


def test_a_delay_that_is_asked_for_stays_whatever_the_period_is(player, until):
    osc = player(1024, "--jitter-buffer", 5)
    assert settled(osc, until, 1024)["delay_ms"] == pytest.approx(5.0)
