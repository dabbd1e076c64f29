"""Physics with pymunk: bodies from descriptions, contacts, and free places."""
