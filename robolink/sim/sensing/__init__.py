"""Sensing: the devices that measure, and the scene that they see."""
