"""The instrument as a plug-in for music programs: CLAP, LV2 and VST3."""
