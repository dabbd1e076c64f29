"""What is seen of a system without starting it: `look` into its nodes, `validate` them, draw their `graph`."""
