"""Bow, fingers and gains at each sample, from targets that others set. Compiled.

What depends on the frame is done here: parameters move along ramps, the bow force follows the
bow's speed, the bow keeps its relative position as the sounding length changes, vibrato and
tremolo oscillate, and a lifted finger moves away.
"""
