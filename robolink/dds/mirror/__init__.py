"""Mirror between two networks, such as Zenoh and DDS: what one side has is announced on the other, and data flows."""

from robolink.dds.mirror.mirror import Count, Mirror

__all__ = ["Count", "Mirror"]
