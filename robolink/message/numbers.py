"""Descriptors of a message's number fields: array.array for sequences, numpy arrays for fixed sizes, as in rclpy.

A large sequence that arrives stays a view of the bytes received until a program asks for it: then it becomes an array,
by one copy. A message that is only passed on is never copied here.
"""

from __future__ import annotations

import os
import threading
from array import array
from collections.abc import Callable
from typing import Any

from robolink.exceptions import EncodeError, OutOfRangeError
from robolink.message.annotations import FieldType, once_per_type

DTYPES = {
    "b": "int8",
    "B": "uint8",
    "h": "int16",
    "H": "uint16",
    "i": "int32",
    "I": "uint32",
    "q": "int64",
    "Q": "uint64",
    "f": "float32",
    "d": "float64",
}
"""numpy's type names by type code of `array`."""


@once_per_type
def has_fixed_numbers(cls: type[Any]) -> bool:
    """True if a message of the class `cls`, or one inside it, has a fixed number of numbers: a numpy array."""
    return any(
        (kind.shape == "array" and kind.code is not None)
        or (kind.message is not None and has_fixed_numbers(kind.message))
        for kind in cls.__ros_fields__.values()
    )


def import_numpy_for(cls: type[Any]) -> None:
    """Import numpy if messages of the class `cls`, or those of a service, need it.

    Endpoints call this when they are made: the import takes 0.1 to 0.7 s, which would stop all timers if the first
    message did it within a callback. It is not done with the package, since most programs never make such a message.
    """
    if has_fixed_numbers(cls) if hasattr(cls, "__ros_fields__") else _service_has_fixed_numbers(cls):
        import numpy  # noqa: F401 - for what comes


def _service_has_fixed_numbers(cls: type[Any]) -> bool:
    from robolink.interfaces.standard import stated  # late: that package needs this one

    known = stated(cls)
    return any(map(has_fixed_numbers, (cls.Request, cls.Response))) if known is None else known.has_fixed_numbers


VIEW_FROM = 65536
"""Size in bytes from which numbers stay a view of bytes, received or assigned, until a program asks for them."""

_settling = threading.RLock()
"""Lock under which a view becomes an array, so that two threads that ask at once get the same one. Freed by a fork."""
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_settling._at_fork_reinit)  # type: ignore[attr-defined]


class Numbers:
    """Descriptor of a field that is a sequence of numbers, kept as an array.array.

    An assignment converts at once. The constructor, which stores without asking, is made good at the first look.
    """

    def __init__(self, cls: Any, name: str, kind: FieldType) -> None:
        member = cls.__dict__[name]
        self.stored: Callable[[Any], Any] = member.__get__
        self.store: Callable[[Any, Any], None] = member.__set__
        self.kind, self.code = kind, kind.code or "d"
        self.shape = (kind.size,)
        self.where = f"{cls.__ros_type__.rpartition('/')[2]}.{name}"

    def __get__(self, message: Any, owner: type | None = None) -> Any:
        if message is None:
            return self
        value = self.stored(message)
        if type(value) is memoryview:
            return self._settle(message)
        if type(value) is not array or value.typecode != self.code:
            value = self.convert(value)
            self.store(message, value)
        return value

    def _settle(self, message: Any) -> Any:
        with _settling:
            value = self.convert(self.stored(message))
            self.store(message, value)
        return value

    def __set__(self, message: Any, value: Any) -> None:
        if type(value) is bytes and len(value) >= VIEW_FROM and self.code == "B" and self.kind.shape != "array":
            made: Any = memoryview(value)  # nobody can change them: copied only if the field is read
        else:
            made = self.convert(value)
        if type(self.stored(message)) is memoryview:
            with _settling:  # else a thread that just makes an array of the view would store it over this one
                self.store(message, made)
        else:
            self.store(message, made)

    def packable(self, message: Any) -> Any:
        """Return the numbers for the encoder: a view of bytes received as it is, else as `__get__`."""
        value = self.stored(message)
        if type(value) is bytes and self.code == "B":
            return memoryview(value)
        if type(value) is memoryview and value.format == self.code and value.ndim == 1 and value.c_contiguous:
            return value
        return self.__get__(message)

    def convert(self, value: Any) -> Any:
        """Return `value` as it is kept. Raises EncodeError that names the field."""
        if type(value) is array and value.typecode == self.code:
            return value
        try:
            if type(value) is memoryview and value.format == self.code and value.ndim == 1 and value.c_contiguous:
                return self._filled(value)  # `array` itself would take it number by number
            if type(value) is memoryview or hasattr(value, "__array_interface__"):
                return self._filled(_as_numpy(_in_a_row(value), self.code))
            return array(self.code, value)
        except (TypeError, ValueError, OverflowError) as error:
            raise self._refused(value, error) from None

    def _refused(self, value: Any, error: Exception) -> EncodeError:
        kind = OutOfRangeError if isinstance(error, OverflowError) else EncodeError
        return kind(f"{self.where}: expected {self.kind}, got {_shown(value)} ({error})")

    def _filled(self, numbers: Any) -> Any:
        made, view = array(self.code), memoryview(numbers)
        if view.nbytes:  # else it may have a shape that cannot be cast
            made.frombytes(view.cast("B"))
        return made


class FixedNumbers(Numbers):
    """Descriptor of a field that is a fixed number of numbers, kept as a numpy array."""

    dtype: Any = "not known before numpy is imported"

    def packable(self, message: Any) -> Any:
        """Return the numbers for the encoder."""
        return self.__get__(message)

    def __get__(self, message: Any, owner: type | None = None) -> Any:
        if message is None:
            return self
        value = self.stored(message)
        if getattr(value, "dtype", None) is not self.dtype or value.shape != self.shape or not value.flags.c_contiguous:
            value = self.convert(value)
            self.store(message, value)
        return value

    def convert(self, value: Any) -> Any:
        """Return `value` as it is kept. Raises EncodeError that names the field."""
        try:
            found = _as_numpy(value, self.code)
        except (TypeError, ValueError, OverflowError) as error:
            raise self._refused(value, error) from None
        if found.size != self.shape[0]:
            raise EncodeError(f"{self.where}: expected {self.kind}, got {found.size} elements")
        self.dtype = found.dtype
        return found.reshape(self.shape)  # a covariance is often given as a matrix: row by row


def _as_numpy(value: Any, code: str) -> Any:
    import numpy as np

    dtype = np.dtype(DTYPES[code])
    given = np.asarray(memoryview(value) if code == "B" and isinstance(value, (bytes, bytearray)) else value)
    if given.dtype.kind == "f" and code == "Q" and isinstance(value, (list, tuple)) and _are_uint64(value):
        given = np.array(value, dtype)  # numpy makes floats of ints that lie on both sides of 2**63
    if given.dtype == dtype:
        return np.ascontiguousarray(given)
    # Python ints are int64 to numpy: they may go into narrower types when the values fit.
    narrowed = given.dtype.kind in "iub" and dtype.kind in "iu"
    if given.size and not narrowed and not np.can_cast(given.dtype, dtype, "same_kind"):
        raise TypeError(f"{given.dtype} is not {dtype}")
    if dtype.kind in "iu" and given.size:
        low, high = np.iinfo(dtype).min, np.iinfo(dtype).max
        if given.min() < low or given.max() > high:
            raise OverflowError(f"out of {low} to {high}")
    return np.ascontiguousarray(given.astype(dtype))


def _in_a_row(value: Any) -> Any:
    """Return an array of one dimension. Raises TypeError for another one, which in ROS 2 fits no sequence either."""
    import numpy as np

    shape = np.shape(value)
    if len(shape) == 1 or 0 in shape:
        return value
    raise TypeError(f"an array of the shape {shape}: give its elements in a row, x.ravel()")


def _are_uint64(values: Any) -> bool:
    return all(isinstance(each, int) and 0 <= each < 1 << 64 for each in values)


def _shown(value: Any) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."
