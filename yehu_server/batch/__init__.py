"""Many jobs at a time on processes of their own, and what is up to date of earlier ones."""
