"""First reflections come from where a mirror would show the player, at the right time and level."""

from typing import Any

import numpy as np
import pytest

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.layout import new_record
from yehu_server.core.stage.seat import (
    SEAT,
    mute_after_fade_out,
    prepare_seat,
    reflect,
    set_reflections,
)

SOUND = 343.0
PLACES = [
    # size, decay, distance, pan
    (5.0, 0.4, 2.0, 0.0),
    (5.0, 0.4, 1.0, -1.0),
    (14.0, 0.8, 6.0, 0.4),
    (25.0, 1.6, 20.0, 1.0),
    (2.0, 0.2, 2.0, 0.7),
]


@compiled_exactly
def _run(seat: Any, first: int, sound: Any, heard: Any) -> None:
    for n in range(sound.shape[0]):
        reflect(seat[0], first + n, sound[n])
        heard[n, 0], heard[n, 1] = seat[0].early[0], seat[0].early[1]


@compiled_exactly
def _place(
    seat: Any, size: float, decay: float, damping: float, distance: float, pan: float
) -> None:
    set_reflections(seat[0], size, decay, damping, distance, pan)


@compiled_exactly
def _silence(seat: Any) -> None:
    mute_after_fade_out(seat[0])


class Player:
    """A player in a room, of whom only the reflections are heard."""

    def __init__(self, rate: float, place: tuple[float, ...], damping: float = 0.0) -> None:
        self.seat = new_record(SEAT)
        self.rate, self.frame = rate, 0
        prepare_seat(self.seat[0], rate)
        self.stand(place, damping)

    def stand(self, place: tuple[float, ...], damping: float = 0.0) -> None:
        size, decay, distance, pan = place
        _place(self.seat, size, decay, damping, distance, pan)

    def hear(self, sound: Any) -> Any:
        heard = np.zeros((len(sound), 2))
        _run(self.seat, self.frame, np.asarray(sound, float), heard)
        self.frame += len(sound)
        return heard

    def response(self, seconds: float = 0.3) -> Any:
        sound = np.zeros(round(seconds * self.rate))
        sound[0] = 1.0
        return self.hear(sound)

    def silence(self) -> None:
        _silence(self.seat)


def mirrored(place: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray, float]:
    """Images of a player [shape=(6, 3)], both ears [shape=(2, 3)], and the way straight ahead."""
    size, _, distance, pan = place
    room = np.array([0.83, 1.0, 0.62]) * size
    head = np.array([0.46 * room[0], 0.31 * room[1], min(1.2, 0.45 * room[2])])
    angle = np.radians(45.0 * pan)
    player = head + distance * np.array([np.sin(angle), np.cos(angle), 0.0])
    player[:2] = np.clip(player[:2], 0.3, room[:2] - 0.3)
    player[2] = min(0.8, 0.3 * room[2])
    images = []
    for axis in range(3):
        for wall in (0.0, room[axis]):
            image = player.copy()
            image[axis] = 2.0 * wall - player[axis]
            images.append(image)
    ears = head + np.array([[-0.085, 0.0, 0.0], [0.085, 0.0, 0.0]])
    return np.array(images), ears, float(np.linalg.norm(player - head))


@pytest.mark.parametrize("rate", [44100.0, 192000.0])
@pytest.mark.parametrize("place", PLACES)
def test_reflections_come_from_the_mirror_images_to_the_sample(place, rate):
    heard = Player(rate, place).response()
    images, ears, direct = mirrored(place)
    size, decay = place[:2]
    volume, walls = 0.83 * 0.62 * size**3, 2.0 * size**2 * (0.83 + 0.62 + 0.83 * 0.62)
    # What a wall keeps, so that sound which meets one each mean free path decays as asked [Eyring].
    kept = 10.0 ** (-3.0 * (4.0 * volume / walls / SOUND) / decay)
    head = ears.mean(axis=0)
    for ear in range(2):
        ways = np.linalg.norm(images - ears[ear], axis=1)
        frames = np.round(np.maximum(ways - direct, 0.0) / SOUND * rate).astype(int)
        assert set(np.flatnonzero(np.abs(heard[:, ear]) > 1e-9)) == set(frames)
        sideways = (images[:, 0] - head[0]) / np.linalg.norm(images - head, axis=1)
        shading = np.sqrt(1.0 + (2 * ear - 1) * 0.7 * sideways)
        requested = np.zeros(len(heard))
        np.add.at(requested, frames, kept * 2.0 / np.maximum(ways, 2.0) * shading)
        assert np.allclose(heard[:, ear], requested, rtol=0.01, atol=1e-12)


def test_reflections_follow_whatever_is_changed(subtests):
    for name, change in {
        "size": ((6.0, 0.4, 2.0, 0.0), 0.4),
        "decay": ((5.0, 0.8, 2.0, 0.0), 0.4),
        "damping": ((5.0, 0.4, 2.0, 0.0), 0.9),
        "distance": ((5.0, 0.4, 3.0, 0.0), 0.4),
        "pan": ((5.0, 0.4, 2.0, 0.5), 0.4),
    }.items():
        with subtests.test(name):
            player = Player(48000.0, PLACES[0], 0.4)
            before = player.response()
            player.stand(*change)
            player.hear(np.zeros(9600))
            after = player.response()
            assert np.allclose(after, Player(48000.0, *change).response(), atol=1e-9)
            assert np.abs(after - before).max() > 0.01


@pytest.mark.parametrize("moves_to", [PLACES[2], (2.0, 0.2, 1.0, 0.0)], ids=["stays", "moves"])
def test_nothing_that_sounded_before_a_silence_is_reflected_once_the_room_has_closed(moves_to):
    player = Player(48000.0, PLACES[2])
    player.hear(np.ones(9600))
    player.stand(moves_to)  # the reflections of before fade for 30 ms
    player.silence()
    player.hear(np.zeros(288))  # 6 ms, in which the room closes
    assert not player.hear(np.zeros(48000)).any()
