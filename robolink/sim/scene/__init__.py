"""Scenery: what a camera sees of a world, as surfaces with colours and heights, apart from how it is rendered."""
