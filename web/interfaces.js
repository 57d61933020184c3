/**
 * The types that parts of the page share; nothing here runs.
 *
 * @typedef {(frame: number | null, kind: number, index: number, value: number, other: number)
 *   => void} Post One command; frame null is now.
 *
 * @typedef {object} Heard What the ear finds in the bowed string.
 * @property {number} certainty 0 to 1: how alike its motion is to that some periods ago
 * @property {number} errorCents of the pitch, from the one asked for
 * @property {number} slips in a period
 *
 * @typedef {object} Bow
 * @property {0 | 1 | -1} string -1: lifted
 * @property {number} speed m/s; the sign is its direction
 * @property {number} force N
 * @property {number} beta distance from the bridge, as a share of the sounding length
 * @property {number} x m from the loop
 *
 * @typedef {object} Hair
 * @property {number} place of the string on it, m from the frog
 * @property {number} length m; 0: it has no ends
 *
 * @typedef {object} Finger
 * @property {number} x m from the loop
 * @property {number} press N
 * @property {number} string
 *
 * @typedef {object} Snapshot The instrument at one moment, some 60 times a second.
 * @property {number} frame
 * @property {number} time s
 * @property {number} pitch fractional MIDI note; NaN in silence
 * @property {Heard} heard
 * @property {number} level dBFS
 * @property {[Float32Array, Float32Array]} shape displacement of each string from loop to bridge, m
 * @property {Bow} bow
 * @property {Hair} hair of the bow
 * @property {Finger[]} fingers those that press
 * @property {number} period s
 * @property {{length: number}} string m, from the loop to the bridge
 * @property {{min: number, max: number}} schelleng limits of the bow force here and now, N
 *
 * @typedef {object} Status
 * @property {'worklet' | 'script' | 'remote' | 'listening'} backend the latter two: a server's
 * @property {number} rate Hz
 * @property {number} loadPercent
 * @property {number} latencyMs
 * @property {number} dropouts
 * @property {boolean} running
 *
 * @typedef {object} Microphone
 * @property {() => Promise<void>} start
 * @property {(tuning: number[]) => void} follow its voice, moved to these pitches if there are any
 * @property {() => void} stop
 *
 * @typedef {object} SoundMembers
 * @property {Post} post
 * @property {() => void} close
 * @property {() => void} [resume] go on after the browser has suspended it
 * @property {Snapshot} state the latest; the event 'state' is of a new one
 * @property {Status} status
 * @property {AnalyserNode | null} analyser null: the page hears nothing
 * @property {{start: () => void, stop: () => Blob | Promise<Blob>}} [record] writes WAV
 * @property {{start: () => void, stop: () => Promise<CapturedCommands>}} [keep] what is applied
 * @property {Microphone} [voice] follows a microphone
 * @property {number} [heard] pitch of the voice; NaN for none
 * @property {(address: string) => number | undefined} [target] where a parameter of bow and
 *   fingers moves to
 * @property {(address: string) => number | undefined} [reported] the value of any other parameter, where
 *   others set them too
 * @property {number} [maxPlayers] most that may play the part; by default one
 * @property {number} [frame] that sounds now, about; else that of the state
 *
 * @typedef {object} CapturedCommands
 * @property {number} from frame
 * @property {number} to frame
 * @property {number[]} commands five numbers each: frame, kind, index, value, other
 *
 * @typedef {EventTarget & SoundMembers} Sound
 *
 * @typedef {import('./playing/player.js').Player} Player What the page asks of the instrument.
 * @typedef {import('./playing/player.js').NoteId} NoteId
 * @typedef {import('./playing/table.js').Param} Parameter A row of the parameter table.
 */

export {};
