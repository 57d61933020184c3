"""Indices of the parameters in the player's arrays: their places in ``params.table.TABLE``."""

from __future__ import annotations

import numpy as np

from yehu_server.params.spec import Place
from yehu_server.params.table import FINGERS, SLOT, TABLE

INDEX = {param.address: index for index, param in enumerate(TABLE)}
PARAMETER_COUNT = len(TABLE)
SLOT_OF = np.array([SLOT.get(param.address, -1) for param in TABLE])  # -1: not the engine's
IS_PLAYER_CONTROLLED = np.array([param.player_controlled for param in TABLE])
IS_ENGINES = np.array([param.place is Place.ENGINE for param in TABLE])
LOWER_BOUNDS, UPPER_BOUNDS = (
    np.array([param.lo for param in TABLE]),
    np.array([param.hi for param in TABLE]),
)
SMOOTH_MS = np.array([param.smooth_ms for param in TABLE])

# What the player moves.
BOW_SPEED, BOW_SIDE = INDEX["/bow/speed"], INDEX["/bow/side"]
BOW_FORCE, BOW_PRESSURE = INDEX["/bow/force"], INDEX["/bow/pressure"]
BOW_ASSIST = INDEX["/bow/assist"]
BOW_POSITION, BOW_TREMOLO = INDEX["/bow/position"], INDEX["/bow/tremolo"]
BOW_TREMOLO_DEPTH = INDEX["/bow/tremolo_depth"]
FINGER_COUNT = len(FINGERS)
FINGER_POSITION = np.array([INDEX[f"/finger/{number}/position"] for number in FINGERS])
FINGER_PRESS = np.array([INDEX[f"/finger/{number}/press"] for number in FINGERS])
VIBRATO_DEPTH, VIBRATO_RATE = INDEX["/vibrato/depth"], INDEX["/vibrato/rate"]
VIBRATO_PRESS, VIBRATO_ONSET = INDEX["/vibrato/press"], INDEX["/vibrato/onset"]
VIBRATO_UPWARD = INDEX["/vibrato/upward"]
PLUCK_FORCE, PLUCK_POSITION = INDEX["/pluck/force"], INDEX["/pluck/position"]
BODY_BRILLIANCE = INDEX["/body/brilliance"]
BRILLIANCE_FREQUENCY = INDEX["/body/brilliance_frequency"]
OUTPUT_LEVEL, OUTPUT_BALANCE = INDEX["/output/level"], INDEX["/output/balance"]

# What it is requested.
EVENNESS, BRILLIANCE = INDEX["/body/evenness"], INDEX["/playing/brilliance"]
DYNAMICS, SPEED = INDEX["/playing/dynamics"], INDEX["/playing/speed"]
INTENSITY = INDEX["/playing/intensity"]
PRESSURE, POSITION = INDEX["/playing/pressure"], INDEX["/playing/bow_position"]
TREMOLO, PIZZICATO = INDEX["/playing/tremolo"], INDEX["/playing/pizzicato"]
TREMOLO_DEPTH = INDEX["/playing/tremolo_depth"]
BOW_LENGTH, NOTE_LENGTH = INDEX["/playing/bow_length"], INDEX["/playing/note_length"]
ARTICULATION = INDEX["/playing/articulation"]
STRING, DIRECTION = INDEX["/playing/string"], INDEX["/playing/direction"]
PRESS, BEND = INDEX["/playing/press"], INDEX["/playing/bend"]
VIBRATO, PLAYING_VIBRATO_PRESS = INDEX["/playing/vibrato"], INDEX["/playing/vibrato_press"]
PLAYING_VIBRATO_RATE, PLAYING_VIBRATO_DELAY = (
    INDEX["/playing/vibrato_rate"],
    INDEX["/playing/vibrato_delay"],
)
VOLUME, EXPRESSION = INDEX["/playing/volume"], INDEX["/playing/expression"]
ASSIST, VARIATION = INDEX["/playing/assist"], INDEX["/playing/variation"]
PHRASING, LEFT_HAND = INDEX["/playing/phrasing"], INDEX["/playing/left_hand"]
ATTACK, RELEASE = INDEX["/playing/attack"], INDEX["/playing/release"]
PORTAMENTO, PORTAMENTO_TIME = INDEX["/playing/portamento"], INDEX["/playing/portamento_time"]
VELOCITY = INDEX["/playing/velocity"]
LISTENING = INDEX["/playing/listening"]
SHARPENING_CORRECTION, SEED = INDEX["/engine/calibration"], INDEX["/engine/seed"]
