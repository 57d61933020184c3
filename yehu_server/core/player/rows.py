"""Numbers of the parameters in the player's arrays: their rows in ``params.table.TABLE``."""

from __future__ import annotations

import numpy as np

from yehu_server.params.spec import Place
from yehu_server.params.table import FINGERS, SLOT, TABLE

ROW = {param.address: row for row, param in enumerate(TABLE)}
ROWS = len(TABLE)
SLOT_OF = np.array([SLOT.get(param.address, -1) for param in TABLE])  # -1: not the engine's
IS_PLAYER_CONTROLLED = np.array([param.player_controlled for param in TABLE])
IS_ENGINES = np.array([param.place is Place.ENGINE for param in TABLE])
LOWEST, HIGHEST = np.array([param.lo for param in TABLE]), np.array([param.hi for param in TABLE])
SMOOTH_MS = np.array([param.smooth_ms for param in TABLE])

# What the player moves.
BOW_SPEED, BOW_SIDE = ROW["/bow/speed"], ROW["/bow/side"]
BOW_FORCE, BOW_PRESSURE = ROW["/bow/force"], ROW["/bow/pressure"]
BOW_ASSIST = ROW["/bow/assist"]
BOW_POSITION, BOW_TREMOLO = ROW["/bow/position"], ROW["/bow/tremolo"]
BOW_TREMOLO_DEPTH = ROW["/bow/tremolo_depth"]
FINGER_COUNT = len(FINGERS)
FINGER_POSITION = np.array([ROW[f"/finger/{number}/position"] for number in FINGERS])
FINGER_PRESS = np.array([ROW[f"/finger/{number}/press"] for number in FINGERS])
VIBRATO_DEPTH, VIBRATO_RATE = ROW["/vibrato/depth"], ROW["/vibrato/rate"]
VIBRATO_PRESS, VIBRATO_ONSET = ROW["/vibrato/press"], ROW["/vibrato/onset"]
VIBRATO_UPWARD = ROW["/vibrato/upward"]
PLUCK_FORCE, PLUCK_POSITION = ROW["/pluck/force"], ROW["/pluck/position"]
BODY_BRILLIANCE = ROW["/body/brilliance"]
BRILLIANCE_FREQUENCY = ROW["/body/brilliance_frequency"]
OUTPUT_LEVEL, OUTPUT_BALANCE = ROW["/output/level"], ROW["/output/balance"]

# What it is requested.
EVENNESS, BRILLIANCE = ROW["/body/evenness"], ROW["/playing/brilliance"]
DYNAMICS, SPEED = ROW["/playing/dynamics"], ROW["/playing/speed"]
PRESSURE, POSITION = ROW["/playing/pressure"], ROW["/playing/bow_position"]
TREMOLO, PIZZICATO = ROW["/playing/tremolo"], ROW["/playing/pizzicato"]
TREMOLO_DEPTH = ROW["/playing/tremolo_depth"]
BOW_LENGTH, NOTE_LENGTH = ROW["/playing/bow_length"], ROW["/playing/note_length"]
ARTICULATION = ROW["/playing/articulation"]
STRING, DIRECTION = ROW["/playing/string"], ROW["/playing/direction"]
PRESS, BEND = ROW["/playing/press"], ROW["/playing/bend"]
VIBRATO, PLAYING_VIBRATO_PRESS = ROW["/playing/vibrato"], ROW["/playing/vibrato_press"]
PLAYING_VIBRATO_RATE, PLAYING_VIBRATO_DELAY = (
    ROW["/playing/vibrato_rate"],
    ROW["/playing/vibrato_delay"],
)
VOLUME, EXPRESSION = ROW["/playing/volume"], ROW["/playing/expression"]
ASSIST, VARIATION = ROW["/playing/assist"], ROW["/playing/variation"]
PHRASING = ROW["/playing/phrasing"]
ATTACK, RELEASE = ROW["/playing/attack"], ROW["/playing/release"]
PORTAMENTO, PORTAMENTO_TIME = ROW["/playing/portamento"], ROW["/playing/portamento_time"]
VELOCITY = ROW["/playing/velocity"]
LISTENING = ROW["/playing/listening"]
SHARPENING_CORRECTION, SEED = ROW["/engine/calibration"], ROW["/engine/seed"]
