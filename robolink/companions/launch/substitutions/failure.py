"""Error of a substitution that has no value."""

from robolink.companions.launch.bases import LaunchError


class SubstitutionFailure(LaunchError):  # noqa: N818 - ROS 2's name
    """A substitution has no value; the text has the reason."""
