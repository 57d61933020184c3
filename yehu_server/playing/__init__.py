"""Mappings, tunings, presets, sections, the calibration and the practice, from files to tables."""
