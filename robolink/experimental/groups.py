"""TaskGroup of asyncio, or of its backport for Python 3.10."""

from __future__ import annotations

import sys

if sys.version_info >= (3, 11):
    from asyncio import TaskGroup
else:
    from taskgroup import TaskGroup

__all__ = ["TaskGroup"]
