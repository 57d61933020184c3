"""Makes and tries what a release brings; ``scripts/release`` runs it."""
