"""Commands that run nodes: `run`, and what a launcher starts, `run-together` and `look-into`."""
