"""Read jianpu (numbered notation), two-four notation and gongche; write jianpu."""
