"""The scores that `scripts/generate` writes by rule, and the tunes that measures play."""
