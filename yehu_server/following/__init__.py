"""Analyse a recording of one voice, and make a performance of it."""
