"""YAML parser into Structs, with limits, the places of errors, and readable messages."""
