"""The instrument as a plug-in for music programs: CLAP, LV2 and VST3.

All formats wrap the instrument that `ahead` compiles. What they report of parameters, presets,
mappings and tunings is made from the same tables and files that the server reads.
"""
