"""The older name of robolink.event_handler."""

import warnings

from robolink.event_handler import *  # noqa: F403
from robolink.exceptions import imported_as

_NAME = imported_as()
warnings.warn(f"{_NAME}.qos_event is the older name of {_NAME}.event_handler: import that", stacklevel=2)
