"""Let a sound be heard: by a player in a notebook, or by the sound device."""

import base64
import io
import sys
import wave
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from yehu_server.errors import DeviceError, ParameterError
from yehu_server.live.audio.devices import load_portaudio
from yehu_server.plot.sounds import is_pressure, sound_of
from yehu_server.util.files import replace_any
from yehu_server.util.sound_file import format_of, is_rendered, sound_file
from yehu_server.util.subtypes import SUBTYPES

Sound = NDArray[Any]

Subtype = Literal["16", "24", "float"]
FULL_SCALE = 32767  # of 16 bits
SHELL_OF_NOTEBOOKS = "ZMQInteractiveShell"
PEAK = 10.0 ** (-1.0 / 20.0)  # of a sound that is normalized
MAX_BYTES = 200 * 2**20  # of a sound within a page


class AudioWidget:
    """A sound that a notebook shows as a player.

    The page holds the sound itself, as 16 bit WAV: it plays without this program.

    Parameters
    ----------
    sound : ndarray [shape=(frames,) or (frames, 2)]
        Full scale is 1; what is louder is clipped.
    sample_rate : int
        Hz.
    """

    def __init__(self, sound: Sound, sample_rate: int) -> None:
        self.sound, self.sample_rate = sound, sample_rate

    def __repr__(self) -> str:
        return f"<yehu_server.AudioWidget of {len(self.sound) / self.sample_rate:.2f} s>"

    def wav(self) -> bytes:
        """Return the sound as a WAV file.

        Examples
        --------
        >>> import numpy as np, yehu_server as yehu
        >>> len(yehu.AudioWidget(np.zeros(100), 44100).wav())
        244
        """
        samples = np.clip(np.asarray(self.sound, np.float64), -1.0, 1.0)
        file = io.BytesIO()
        with wave.open(file, "wb") as writer:
            writer.setnchannels(1 if samples.ndim == 1 else samples.shape[1])
            writer.setsampwidth(2)
            writer.setframerate(self.sample_rate)
            writer.writeframes(np.rint(FULL_SCALE * samples).astype("<i2").tobytes())
        return file.getvalue()

    def _repr_html_(self) -> str:
        if 2 * self.sound.size > MAX_BYTES:
            return "this sound is too long for a page: save it as a file"
        data = base64.b64encode(self.wav()).decode()
        return f'<audio controls src="data:audio/wav;base64,{data}"></audio>'


Player = AudioWidget


def play(
    sound: Any, sample_rate: float | None = None, *, normalize: bool = False
) -> AudioWidget | None:
    """Let a sound be heard.

    In a notebook it returns a player. Elsewhere it plays through the default sound device, and
    returns once the sound has ended.

    Parameters
    ----------
    sound : Rendering, Simulation or ndarray [shape=(frames,) or (frames, 2)]
        Of a simulation, the radiated pressure is heard, scaled to -1 dB of full scale.
    sample_rate : float, optional
        Of an array, in Hz.
    normalize : bool
        Scale it to a peak of -1 dB of full scale.

    Returns
    -------
    AudioWidget
        In a notebook, else None.

    Raises
    ------
    ParameterError
        Where it is no sound.
    DeviceError
        Where there is no sound device.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> yehu.play(yehu.render([("A4", 0.0, 0.3)]))  # doctest: +SKIP
    """
    samples, rate = sound_of(sound, sample_rate)
    peak = float(np.abs(samples).max(initial=0.0))
    if (normalize or is_pressure(sound)) and peak > 0.0:
        samples = samples * (PEAK / peak)
    if is_notebook():
        return AudioWidget(samples, round(rate))
    _play_aloud(samples, rate)
    return None


def is_notebook() -> bool:
    """Whether this runs in the kernel of a notebook."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == SHELL_OF_NOTEBOOKS


def _play_aloud(samples: Sound, rate: float) -> None:
    """Play through the default device, to the end; raises DeviceError where there is none."""
    sounddevice = load_portaudio()
    try:
        sounddevice.play(np.asarray(samples, np.float32), rate, blocking=True)
    except (sounddevice.PortAudioError, ValueError) as error:
        raise DeviceError(
            f"there is no sound device to play on ({error}): save it as a file"
        ) from None


def write_sound(
    sound: Sound, sample_rate: int, target: Path, subtype: Subtype, *, overwrite: bool
) -> None:
    """Write a sound file, WAV or FLAC; raises OutputError, ParameterError for the subtype."""
    if subtype not in SUBTYPES:
        raise ParameterError(f"subtype: {subtype!r} is not one of {', '.join(SUBTYPES)}")
    form, channels = format_of(target), 1 if sound.ndim == 1 else sound.shape[1]
    may_replace = replace_any if overwrite else is_rendered
    with sound_file(target, sample_rate, form, subtype, may_replace, channels=channels) as file:
        file.write(np.ascontiguousarray(sound))
