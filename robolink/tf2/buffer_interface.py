"""Base class of transform buffers, and the registries of functions that transform and convert objects by type."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from copy import deepcopy
from typing import Any, ClassVar, TypeAlias

from robolink.duration import Duration
from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import (
    PointStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
)
from robolink.interfaces.sensor_msgs.msg import PointCloud2
from robolink.interfaces.std_msgs.msg import Header

MsgStamped: TypeAlias = PointStamped | PoseStamped | PoseWithCovarianceStamped | Vector3Stamped | PointCloud2
TransformableObject: TypeAlias = Any
TransformableObjectType: TypeAlias = "type[Any]"
DoTransform: TypeAlias = Callable[[Any, TransformStamped], Any]

KNOW_THE_STANDARD_TYPES = ("robolink.tf2.geometry", "robolink.tf2.point_cloud")
"""Modules that register the standard message types."""


class TypeException(RobolinkError, TypeError):  # noqa: N818 - tf2's name
    """An object's type was never registered; `errstr` says which."""

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(RobolinkError, NotImplementedError):  # noqa: N818 - tf2's name
    """A subclass of BufferInterface lacks a method that it must have."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class BufferInterface:
    """Base class of buffers: a subclass implements the look-ups, and `transform` works with them.

    Times are `Time` or `builtin_interfaces/msg/Time`; zero means the latest.
    """

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self,
        object_stamped: TransformableObject,
        target_frame: str,
        timeout: Duration = Duration(),  # noqa: B008 - tf2's signature
        new_type: TransformableObjectType | None = None,
    ) -> Any:
        """Transform an object with a header into another frame, at the time of its header.

        Args:
            object_stamped: The object, of a registered type: the stamped messages of geometry_msgs, PointCloud2, or one
                that was added to `TransformRegistration`. It is not changed.
            target_frame: Name of the frame into which it is transformed.
            timeout: Longest wait for the transform; zero does not wait.
            new_type: Type to which the result is converted, see `convert`; None keeps the type.

        Returns:
            A new object.

        Raises:
            TypeException: if the object's type or `new_type` is not registered.
            TransformException: any of `lookup_transform`.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout)
        return _converted(do_transform(object_stamped, found), new_type)

    def transform_full(
        self,
        object_stamped: TransformableObject,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
        new_type: TransformableObjectType | None = None,
    ) -> Any:
        """Transform an object with a header into another frame at another time.

        Args:
            object_stamped: The object, of a registered type. It is not changed.
            target_frame: Name of the frame into which it is transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the object's time and `target_time`.
            timeout: Longest wait for the transform; zero does not wait.
            new_type: Type to which the result is converted, see `convert`; None keeps the type.

        Returns:
            A new object.

        Raises:
            TypeException: if the object's type or `new_type` is not registered.
            TransformException: any of `lookup_transform_full`.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        source = (header.frame_id, header.stamp)
        found = self.lookup_transform_full(target_frame, target_time, *source, fixed_frame, timeout)
        return _converted(do_transform(object_stamped, found), new_type)

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Return the transform that takes coordinates in `source_frame` to coordinates in `target_frame` (abstract).

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.
            timeout: Longest wait for the transform; zero does not wait.

        Raises:
            NotImplementedException: always, here.
        """
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Return the transform from one frame and time to another (abstract).

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.
            timeout: Longest wait for the transform; zero does not wait.

        Raises:
            NotImplementedException: always, here.
        """
        raise NotImplementedException

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> Any:
        """True if `lookup_transform` would succeed (abstract).

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.
            timeout: Longest wait for the transform; zero does not wait.

        Raises:
            NotImplementedException: always, here.
        """
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> Any:
        """True if `lookup_transform_full` would succeed (abstract).

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.
            timeout: Longest wait for the transform; zero does not wait.

        Raises:
            NotImplementedException: always, here.
        """
        raise NotImplementedException


class TransformRegistration:
    """Registry of the functions that transform objects, by type; all instances share it."""

    _functions: ClassVar[dict[type[Any], DoTransform]] = {}

    def print_me(self) -> None:
        """Print the registry."""
        print(self._functions)  # noqa: T201 - that is what it is for

    def add(self, key: TransformableObjectType, callback: DoTransform) -> None:
        """Register `callback(object, transform)`, which returns a new object, for the type `key`."""
        self._functions[key] = callback

    def get(self, key: TransformableObjectType) -> DoTransform:
        """Return the function of the type `key`. Raises TypeException if it is not registered."""
        return _registered(self._functions, key)


class ConvertRegistration:
    """Registry of the functions that convert objects, by type; all instances share it."""

    _to_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _from_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _convert: ClassVar[dict[Any, Callable[[Any], Any]]] = {}

    def add_to_msg(self, key: TransformableObjectType, callback: Callable[[Any], Any]) -> None:
        """Register `callback(object)`, which returns a message, for the type `key`."""
        self._to_msg[key] = callback

    def add_from_msg(self, key: TransformableObjectType, callback: Callable[[Any], Any]) -> None:
        """Register `callback(message)`, which returns an object, for the type `key`."""
        self._from_msg[key] = callback

    def add_convert(self, key: tuple[type[Any], type[Any]], callback: Callable[[Any], Any]) -> None:
        """Register `callback(object)`, which converts from the first type of `key` to the second."""
        self._convert[key] = callback

    def get_to_msg(self, key: TransformableObjectType) -> Callable[[Any], Any]:
        """Return the function from the type `key` to a message. Raises TypeException if it is not registered."""
        return _registered(self._to_msg, key)

    def get_from_msg(self, key: TransformableObjectType) -> Callable[[Any], Any]:
        """Return the function from a message to the type `key`. Raises TypeException if it is not registered."""
        return _registered(self._from_msg, key)

    def get_convert(self, key: tuple[type[Any], type[Any]]) -> Callable[[Any], Any]:
        """Return the function from the first type of `key` to the second. Raises TypeException if there is none."""
        return _registered(self._convert, key)


def _registered(functions: dict[Any, Callable[..., Any]], key: Any) -> Callable[..., Any]:
    if key not in functions:
        for module in KNOW_THE_STANDARD_TYPES:  # in ROS 2 one must import them oneself
            importlib.import_module(module)
    if key not in functions:
        raise TypeException(f"Type {key} is not loaded or supported")
    return functions[key]


def convert(a: TransformableObject, b_type: TransformableObjectType) -> Any:
    """Convert `a` to the type `b_type`; a deep copy if it is of that type already.

    Raises TypeException if no conversion is registered.
    """
    registered = ConvertRegistration()
    try:
        direct = registered.get_convert((type(a), b_type))
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
        return registered.get_from_msg(b_type)(registered.get_to_msg(type(a))(a))
    return direct(a)


def _converted(found: Any, new_type: TransformableObjectType | None) -> Any:
    return found if new_type is None else convert(found, new_type)


def Stamped(obj: TransformableObject, stamp: Any, frame_id: str) -> Any:  # noqa: N802 - tf2's name
    """Set the header of `obj` from `stamp` (a time message) and `frame_id`, and return `obj`."""
    obj.header = Header(stamp=stamp, frame_id=frame_id)
    return obj
