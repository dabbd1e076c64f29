"""Robot models in URDF: links and joints as data, and the transform of a joint at a position."""

from robolink.counterparts.urdf.model import Joint, Mimic, Robot, placed
from robolink.counterparts.urdf.parser import parse_urdf, read_urdf

__all__ = ["Joint", "Mimic", "Robot", "parse_urdf", "placed", "read_urdf"]
