"""The live server: connects instruments, players, audio output, OSC, MIDI, OSCQuery and the page.

web thread ─> OSC thread ──┐
             pages process ┤
                           ├─> Player ─> ring ─> C callback, in the audio process ─> device
              MIDI process ┘                              └─> meters, applied commands, tape
"""
