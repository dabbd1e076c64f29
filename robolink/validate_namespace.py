"""Check of a node's namespace."""

from __future__ import annotations

from typing import Literal

from robolink.exceptions import InvalidNamespaceException
from robolink.text.names import FULL_NAME_RULES, MAX_NAMESPACE, find_problem


def validate_namespace(namespace: str) -> Literal[True]:
    """Return True if `namespace` is absolute and valid, such as '/' or '/arm/left'.

    Raises InvalidNamespaceException with the index of the bad character, also for '' and 'arm', which a node's
    constructor accepts.
    """
    problem = None if namespace == "/" else find_problem(namespace, FULL_NAME_RULES, MAX_NAMESPACE)
    if problem is None:
        return True
    raise InvalidNamespaceException(namespace, *problem)
