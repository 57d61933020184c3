"""Pictures of sounds, simulations, studies and bodies, with matplotlib."""
