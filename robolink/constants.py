"""Numbers that several rooms share."""

S_TO_NS = 1_000_000_000
"""Nanoseconds in one second."""

LAST_DOMAIN = 232
"""Largest ROS domain id."""

MOST_SEED = 2**32 - 1
"""Largest seed of a run: that of numpy's generator."""

LARGEST_MESSAGE = 1 << 30
"""Largest message in bytes, with Zenoh's overhead: rmw_zenoh's limit. A session silently drops larger ones."""
