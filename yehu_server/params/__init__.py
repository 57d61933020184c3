"""The one table of what can be set from outside: addresses, ranges, units, defaults."""
