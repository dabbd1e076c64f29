"""Rendering: what a pinhole camera sees of a world's surfaces, exactly, by numpy alone.

Each surface is a plane patch or an upright cylinder. Inverse depth, and the place on a patch over depth, are affine in
the pixel, so that a patch takes three sums for each of its pixels. All is + - * / and square roots of IEEE numbers, and
comparisons: the same bits on every machine.
"""
