"""Geometry as pure functions: poses in the plane; rotations as matrices, angles and quaternions."""
