"""The running instrument: commands, player, controls, model, output, in one compiled callback."""
