"""The scores that `scripts/make_examples.py` writes by rule, and the tunes that measures play."""
