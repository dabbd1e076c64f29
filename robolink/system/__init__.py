"""Operating system helpers: clocks, regular files, terminal escaping, own command line, timed waits."""
