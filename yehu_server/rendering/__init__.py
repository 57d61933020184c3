"""Scores and captures to sound files, faster than real time: one, or a folder, or on a cluster."""
