"""How hot code is compiled, and where compiled code is kept."""
