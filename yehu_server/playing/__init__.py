"""Mappings, tunings, presets, sections, calibration and bowing tables, from files to tables."""
