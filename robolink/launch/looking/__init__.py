"""Static inspection of a system: `look` into its nodes, `validate` them, draw their `graph`, without starting it."""
