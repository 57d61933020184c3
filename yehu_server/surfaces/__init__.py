"""Control surfaces from the parameter table: TouchOSC, Max, Pd, Open Stage Control, HTML."""
