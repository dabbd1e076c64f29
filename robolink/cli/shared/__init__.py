"""Shared parts of the commands: sessions, output, options, names of the graph, shell completion."""
