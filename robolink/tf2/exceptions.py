# ruff: noqa: N818 - tf2's names
"""Exceptions of tf2.

TransformException (RobolinkError)
├─ LookupException (LookupError)             a frame is not known, or frames form a loop
├─ ConnectivityException (LookupError)       both frames are known, but no chain of transforms connects them
├─ ExtrapolationException (LookupError)      the chain has no data at the time that was asked for
├─ InvalidArgumentException (ValueError)     a frame name that cannot be one
└─ TimeoutException (TimeoutError)           a buffer server did not answer in time
"""

from __future__ import annotations

from robolink.exceptions import RobolinkError


class TransformException(RobolinkError):
    """Base class of all errors of tf2."""


class LookupException(TransformException, LookupError):
    """A frame is not known, or frames form a loop."""


class ConnectivityException(TransformException, LookupError):
    """Both frames are known, but no chain of transforms connects them."""


class ExtrapolationException(TransformException, LookupError):
    """A transform of the chain has no data at the time that was asked for."""


class InvalidArgumentException(TransformException, ValueError):
    """A frame name is empty or begins with a slash."""


class TimeoutException(TransformException, TimeoutError):
    """A buffer server did not answer in time."""
