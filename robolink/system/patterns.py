"""Regular expressions that are compiled when they are first used: most of a module's never are in a given process."""

from __future__ import annotations

import re
from typing import Any, AnyStr, cast


class _Late:
    """Stand-in for a compiled pattern: its methods become attributes of this object, each at its first use."""

    def __init__(self, source: Any, flags: int) -> None:
        self._source = source, flags

    def __getattr__(self, name: str) -> Any:
        value = getattr(re.compile(*self._source), name)
        setattr(self, name, value)  # from now on as fast as the pattern itself
        return value

    def __repr__(self) -> str:
        return repr(re.compile(*self._source))


def late(source: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """Return a regular expression that is compiled at the first use of one of its methods.

    Compiling the hundred patterns of the modules that a node imports took a tenth of its start. A test compiles all
    of them. The functions of `re` do not take the result in the place of a pattern: call its methods.

    Args:
        source: The pattern, as for `re.compile`.
        flags: Flags, as for `re.compile`.
    """
    return cast("re.Pattern[AnyStr]", _Late(source, int(flags)))
