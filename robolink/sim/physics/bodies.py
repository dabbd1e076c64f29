"""Physical bodies from descriptions: the only place that makes pymunk shapes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pymunk

from robolink.sim.description import GRAVITY, Obstacle, Shape, Wall, signed_area
from robolink.sim.physics.convex import convex_parts
from robolink.sim.quantities import Point, Pose

FRICTION = 0.2
"""Coefficient of friction between any two things that touch; low, as of plastic on painted wood."""

FLOOR_FRICTION = 0.3
"""Coefficient of friction between the floor and an obstacle that can be pushed."""


def body_at(pose: Pose, mass: float | None, shape: Shape) -> pymunk.Body:
    """Make a body at a pose: fixed without a mass, else free to move, its mass centred on the shape's origin."""
    body = fixed_body() if mass is None else pymunk.Body(mass, shape.inertia(mass))
    return placed(body, pose)


def pushable_body(obstacle: Obstacle, mass: float) -> pymunk.Body:
    """Make the body of an obstacle that can be pushed: a solid of this shape, turning about its own middle."""
    x, y = centroid(obstacle.corners()) if obstacle.polygon is not None else (0.0, 0.0)
    body = pymunk.Body(mass, obstacle.inertia(mass) - mass * (x * x + y * y))
    body.center_of_gravity = (x, y)
    return placed(body, obstacle.start)


def moving_body(obstacle: Obstacle) -> pymunk.Body:
    """Make the body of an obstacle that moves by itself, whatever it meets."""
    return placed(pymunk.Body(body_type=pymunk.Body.KINEMATIC), obstacle.start)


def fixed_body() -> pymunk.Body:
    """Make a body that never moves."""
    return pymunk.Body(body_type=pymunk.Body.STATIC)


def placed(body: pymunk.Body, pose: Pose) -> pymunk.Body:
    """Put a body's origin at a pose; the angle first, since it turns a body about its centre of gravity."""
    body.angle = pose.theta
    body.position = (pose.x, pose.y)
    return body


def solids(shape: Shape, body: pymunk.Body) -> list[pymunk.Shape]:
    """Make the shapes of an obstacle or robot on its body: several if its outline is concave."""
    made: list[pymunk.Shape]
    if shape.circle is not None:
        made = [pymunk.Circle(body, shape.circle)]
    else:
        made = [pymunk.Poly(body, part) for part in convex_parts(shape.corners())]
    for each in made:
        each.friction = FRICTION
    return made


def centroid(corners: Sequence[Point]) -> Point:
    """Return the centroid of a polygon."""
    x = y = 0.0
    for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]], strict=True):
        cross = x1 * y2 - x2 * y1
        x, y = x + (x1 + x2) * cross, y + (y1 + y2) * cross
    six_areas = 6 * signed_area(corners)
    return x / six_areas, y / six_areas


def wall_shapes(wall: Wall, body: pymunk.Body) -> list[pymunk.Segment]:
    """Make a wall's segments; their radius is 0, since the lidar sees lines."""
    shapes = [pymunk.Segment(body, start, end, 0.0) for start, end in wall.segments()]
    for shape in shapes:
        shape.friction = FRICTION
    return shapes


def floor_friction(body: pymunk.Body, floor: pymunk.Body, obstacle: Obstacle) -> list[pymunk.Constraint]:
    """Make the joints that brake a pushable body as Coulomb friction with the floor would."""
    weight, middle = FLOOR_FRICTION * body.mass * GRAVITY, body.center_of_gravity
    radius = obstacle.circle or max(math.dist(middle, corner) for corner in obstacle.corners())
    slide = pymunk.PivotJoint(floor, body, (0.0, 0.0), middle)
    turn = pymunk.GearJoint(floor, body, 0.0, 1.0)
    for joint, limit in ((slide, weight), (turn, weight * radius * 2 / 3)):
        joint.max_bias = 0.0
        joint.max_force = limit
    return [slide, turn]
