"""The parameter table: addresses, ranges, units and defaults of all that can be set."""
