"""Exercises with automatic checks: programs to mend or to write, tried in a simulated world in virtual time."""
