"""rosidl's rules for the names of packages, types, fields and constants."""

from __future__ import annotations

import re

from robolink.exceptions import MessageError
from robolink.system.terminal import shown

LOWER = r"[a-z](?:_?[a-z0-9])*"
PATTERNS = {"package": LOWER, "type": r"[A-Z][A-Za-z0-9]*", "field": LOWER, "constant": r"[A-Z](?:_?[A-Z0-9])*"}
"""Regular expressions of the names, as text: every command imports this module, most need one of them at most."""
PART = (
    r"[A-Z][A-Za-z0-9]*_(?:Request|Response|Event|Goal|Result|Feedback|FeedbackMessage"
    r"|(?:SendGoal|GetResult)(?:_Request|_Response|_Event)?)"
)
"""Regular expression of rosidl's names for the parts of a service or an action, such as ``SetBool_Request``."""
LONGEST = 255
"""Upper bound of a name's length in characters; rosidl's own limit (HashedTypeDescription.schema.json)."""

RIGHT = {
    "package": "a-z, digits and single underscores, as in my_robot_msgs",
    "type": "CamelCase of A-Z, a-z and digits, as in WheelSpeeds",
    "field": "a-z, digits and single underscores, as in max_speed",
    "constant": "A-Z, digits and single underscores, as in MAX_SPEED",
}
"""Rules of the names in words."""


def wrong_name(what: str, name: str) -> str:
    """Return the mistake in the name of a `what` (a key of PATTERNS); '' if it is right.

    >>> wrong_name("field", "maxSpeed")
    "'maxSpeed' is not a field name: a-z, digits and single underscores, as in max_speed"
    """
    if len(name) > LONGEST:
        return f"'{shown(name)}' is {len(name)} characters long; a name has at most {LONGEST}"
    if re.fullmatch(PATTERNS[what], name):
        return ""
    return f"'{shown(name)}' is not a {what} name: {RIGHT[what]}"


def split_type_name(name: str) -> tuple[str, str, str]:
    """Split ``std_srvs/srv/SetBool`` into package, kind and name, after checking them. Raises MessageError.

    Parts of services and actions, ``std_srvs/srv/SetBool_Request``, are types too.
    """
    parts = name.split("/")
    if len(parts) != 3 or parts[1] not in ("msg", "srv", "action"):
        raise MessageError(f"'{shown(name)}' is not a full type name; it should look like my_msgs/msg/WheelSpeeds")
    package, kind, short = parts
    wrong = wrong_name("package", package) or (not is_part(kind, short) and wrong_name("type", short))
    if wrong:
        raise MessageError(wrong)
    return package, kind, short


def is_part(kind: str, short: str) -> bool:
    """True if a type is the part of a service or action, by its kind and name: ``srv``, ``SetBool_Request``."""
    return kind != "msg" and "_" in short and len(short) <= LONGEST and re.fullmatch(PART, short) is not None
