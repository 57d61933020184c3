"""Pictures of sweeps, studies and bodies, with matplotlib."""
