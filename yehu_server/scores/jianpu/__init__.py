"""Read jianpu, numbered notation, and its kin: two-four notation and gongche."""
