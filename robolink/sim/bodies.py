"""Physical bodies out of descriptions: the one place that makes pymunk shapes."""

from __future__ import annotations

import pymunk

from robolink.sim.description import Obstacle, Pose, Shape, Wall

FRICTION = 0.2
"""Between any two things that touch; low, as of plastic on painted wood."""

FLOOR_FRICTION = 0.3
"""Between the floor and what can be pushed over it."""

GRAVITY = 9.81


def body_at(pose: Pose, mass: float | None, shape: Shape) -> pymunk.Body:
    """Make a body at a pose: fixed without a mass, else free to move, with the inertia of a solid."""
    body = fixed_body() if mass is None else pymunk.Body(mass, shape.inertia(mass))
    body.position = (pose.x, pose.y)
    body.angle = pose.theta
    return body


def fixed_body() -> pymunk.Body:
    """Make a body that never moves."""
    return pymunk.Body(body_type=pymunk.Body.STATIC)


def solid(shape: Shape, body: pymunk.Body) -> pymunk.Shape:
    """Make the shape of an obstacle or robot on its body."""
    made: pymunk.Shape
    made = pymunk.Poly(body, shape.corners()) if shape.circle is None else pymunk.Circle(body, shape.circle)
    made.friction = FRICTION
    return made


def wall_shapes(wall: Wall, body: pymunk.Body) -> list[pymunk.Segment]:
    """Make a wall's segments; their radius is 0, since the lidar sees lines."""
    shapes = [pymunk.Segment(body, start, end, 0.0) for start, end in wall.segments()]
    for shape in shapes:
        shape.friction = FRICTION
    return shapes


def floor_friction(body: pymunk.Body, floor: pymunk.Body, obstacle: Obstacle) -> list[pymunk.Constraint]:
    """Make the joints that brake a pushable body as Coulomb friction with the floor would."""
    weight = FLOOR_FRICTION * body.mass * GRAVITY
    slide = pymunk.PivotJoint(floor, body, (0.0, 0.0), (0.0, 0.0))
    turn = pymunk.GearJoint(floor, body, 0.0, 1.0)
    for joint, limit in ((slide, weight), (turn, weight * obstacle.outer_radius() * 2 / 3)):
        joint.max_bias = 0.0
        joint.max_force = limit
    return [slide, turn]
