"""What every source of transforms offers, and which function transforms which type of object."""

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


class TypeException(RobolinkError, TypeError):  # noqa: N818 - tf2's name
    """An object's type was never registered."""

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(RobolinkError, NotImplementedError):  # noqa: N818 - tf2's name
    """A subclass of BufferInterface lacks what it must have."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class BufferInterface:
    """The base of buffers: a subclass says how to look up, and gets transforming for it.

    Times are `Time` or `builtin_interfaces/msg/Time`, where zero is the latest; `timeout` is how long to wait until
    the transform is there.
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
        """Give an object that has a header as it is in another frame, on request converted to another type.

        Raises TypeException for a type that was not registered, and what `lookup_transform` raises.
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
        """Give an object as it is in another frame at another time; `fixed_frame` stands still in between."""
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
        """Give the transform that takes what is given in `source_frame` to `target_frame`."""
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
        """Give the transform from one frame and time to another; `fixed_frame` stands still in between."""
        raise NotImplementedException

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> Any:
        """Say whether `lookup_transform` would succeed."""
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
        """Say whether `lookup_transform_full` would succeed."""
        raise NotImplementedException


class TransformRegistration:
    """The functions that transform objects, by type; all instances share them."""

    _functions: ClassVar[dict[type[Any], DoTransform]] = {}

    def print_me(self) -> None:
        """Print what is registered."""
        print(self._functions)  # noqa: T201 - that is what it is for

    def add(self, key: TransformableObjectType, callback: DoTransform) -> None:
        """Have objects of a type transformed by ``callback(object, transform)``, which gives a new object."""
        self._functions[key] = callback

    def get(self, key: TransformableObjectType) -> DoTransform:
        """Give the function for a type. Raises TypeException for one that was not registered."""
        return _registered(self._functions, key)


class ConvertRegistration:
    """The functions that convert objects, by type; all instances share them."""

    _to_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _from_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _convert: ClassVar[dict[Any, Callable[[Any], Any]]] = {}

    def add_to_msg(self, key: TransformableObjectType, callback: Callable[[Any], Any]) -> None:
        """Have objects of a type made into messages so."""
        self._to_msg[key] = callback

    def add_from_msg(self, key: TransformableObjectType, callback: Callable[[Any], Any]) -> None:
        """Have objects of a type made of messages so."""
        self._from_msg[key] = callback

    def add_convert(self, key: tuple[type[Any], type[Any]], callback: Callable[[Any], Any]) -> None:
        """Have objects of the first type made into the second so."""
        self._convert[key] = callback

    def get_to_msg(self, key: TransformableObjectType) -> Callable[[Any], Any]:
        """Give what makes a message of a type. Raises TypeException."""
        return _registered(self._to_msg, key)

    def get_from_msg(self, key: TransformableObjectType) -> Callable[[Any], Any]:
        """Give what makes a type of a message. Raises TypeException."""
        return _registered(self._from_msg, key)

    def get_convert(self, key: tuple[type[Any], type[Any]]) -> Callable[[Any], Any]:
        """Give what makes the second type of the first. Raises TypeException."""
        return _registered(self._convert, key)


def _registered(functions: dict[Any, Callable[..., Any]], key: Any) -> Callable[..., Any]:
    if key not in functions:
        for module in KNOW_THE_STANDARD_TYPES:  # in ROS 2 one must import them oneself
            importlib.import_module(module)
    if key not in functions:
        raise TypeException(f"Type {key} is not loaded or supported")
    return functions[key]


def convert(a: TransformableObject, b_type: TransformableObjectType) -> Any:
    """Give `a` as an object of another type; a copy where it is of that type already. Raises TypeException."""
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
    """Give an object a header, and give it back."""
    obj.header = Header(stamp=stamp, frame_id=frame_id)
    return obj
