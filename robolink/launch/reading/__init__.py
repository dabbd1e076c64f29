"""Parser of launch files: YAML text in, a flat list of nodes and commands to start out (`entries`)."""
