"""The older name of robolink.event_handler."""

import warnings

from robolink.event_handler import *  # noqa: F403

warnings.warn("robolink.qos_event is the older name of robolink.event_handler: import that", stacklevel=2)
