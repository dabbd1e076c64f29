"""Convex decomposition of polygons by ear clipping: a physics engine collides only convex parts.

Chipmunk's own `convex_decomposition` ends the process for some polygons whose corners lie almost in a line.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from robolink.sim.description import signed_area, turn
from robolink.sim.quantities import Point

Ring: TypeAlias = "list[int]"

_NOTHING = 1e-12
"""Area of a part below which it is left out, in m²."""


def convex_parts(corners: Sequence[Point]) -> list[list[Point]]:
    """Cut a polygon, its corners counter-clockwise, into convex ones; a convex one stays whole.

    Of a polygon that crosses itself the parts are some triangles of its corners; nothing is raised.
    """
    points = list(corners)
    whole = list(range(len(points)))
    if _is_convex(points, whole):
        return [points]
    rings = _joined(points, _triangles(points, whole))
    parts = [[points[each] for each in ring] for ring in rings]
    return [part for part in parts if signed_area(part) > _NOTHING]


def _is_convex(points: Sequence[Point], ring: Ring) -> bool:
    following = zip(ring, [*ring[1:], *ring[:1]], [*ring[2:], *ring[:2]], strict=True)
    return all(turn(points[a], points[b], points[c]) >= 0.0 for a, b, c in following)


def _triangles(points: Sequence[Point], ring: Ring) -> list[Ring]:
    """Cut off one ear after the other: a corner whose triangle holds no other corner."""
    ring, found = list(ring), []
    while len(ring) > 3:
        at = next((at for at in range(len(ring)) if _is_ear(points, ring, at)), None)
        if at is None:  # rounding: the sharpest corner will do
            at = max(range(len(ring)), key=lambda each: turn(*(points[corner] for corner in _around(ring, each))))
        found.append(list(_around(ring, at)))
        del ring[at]
    return [*found, ring]


def _around(ring: Ring, at: int) -> tuple[int, int, int]:
    return ring[at - 1], ring[at], ring[(at + 1) % len(ring)]


def _is_ear(points: Sequence[Point], ring: Ring, at: int) -> bool:
    corners = _around(ring, at)
    a, b, c = (points[each] for each in corners)
    if turn(a, b, c) <= 0.0:
        return False
    others = [points[each] for each in ring if each not in corners]
    return not any(turn(a, b, each) >= 0.0 and turn(b, c, each) >= 0.0 and turn(c, a, each) >= 0.0 for each in others)


def _joined(points: Sequence[Point], rings: list[Ring]) -> list[Ring]:
    """Join rings across shared edges if the result is convex (the algorithm of Hertel and Mehlhorn)."""
    owners = {edge: ring for ring in rings for edge in _edges(ring)}
    for p, q in list(owners):
        left, right = owners.get((p, q)), owners.get((q, p))
        if left is None or right is None:
            continue
        whole = [*_from(left, q), *_from(right, p)[1:-1]]
        if _is_convex(points, whole):
            del owners[p, q], owners[q, p]
            owners.update(dict.fromkeys(_edges(whole), whole))
    return list({id(ring): ring for ring in owners.values()}.values())


def _edges(ring: Ring) -> list[tuple[int, int]]:
    return list(zip(ring, [*ring[1:], ring[0]], strict=True))


def _from(ring: Ring, start: int) -> Ring:
    """Turn a ring so that it begins with a corner."""
    at = ring.index(start)
    return [*ring[at:], *ring[:at]]
