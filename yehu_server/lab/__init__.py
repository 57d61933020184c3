"""The model studied: simulation, regimes, sweeps, data sets, bodies, pictures."""
