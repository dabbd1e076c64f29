"""Validation of descriptions beyond their types: each problem with its place."""
