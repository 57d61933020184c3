"""Where sound goes: files (and, live, devices)."""
