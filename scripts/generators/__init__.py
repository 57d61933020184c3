"""What `scripts/generate` writes; `written` has each file."""
