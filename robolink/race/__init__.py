"""Races of simulated robots: programs get a score for a seed, which anybody can compute again."""
