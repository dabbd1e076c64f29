"""XML and YAML launch files: the elements that both share, and the tables of the actions and substitutions in them."""
