"""Command line `robolink`: `main` is the entry point, `root` the table of commands, each noun a package or file."""
