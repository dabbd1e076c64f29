"""Point clouds to and from numpy: sensor_msgs' PointCloud2 as structured arrays, one field for each of the cloud's.

>>> cloud = create_cloud_xyz32(Header(frame_id="lidar"), [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0)])
>>> read_points_numpy(cloud, ("x", "z"))
array([[1., 3.],
       [4., 6.]], dtype=float32)

Names and rules are those of ROS 2's sensor_msgs_py.point_cloud2. An organized cloud is an array of (width, height)
there, and so it is here. What upstream stumbles over works: rows with padding, bytes in the other order, a cloud whose
data is a read-only view. `uvs` are always places in the cloud, also together with `skip_nans`.
"""

from __future__ import annotations

import sys
from array import array
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from robolink.exceptions import MessageError
from robolink.interfaces.sensor_msgs.msg import PointCloud2, PointField
from robolink.interfaces.std_msgs.msg import Header

__all__ = [
    "DUMMY_FIELD_PREFIX",
    "PointCloudError",
    "create_cloud",
    "create_cloud_xyz32",
    "dtype_from_fields",
    "read_points",
    "read_points_list",
    "read_points_numpy",
]

DUMMY_FIELD_PREFIX = "unnamed_field"
"""Prefix of the name of a field without a name; its number follows."""

_FORMATS = {
    PointField.INT8: "i1",
    PointField.UINT8: "u1",
    PointField.INT16: "i2",
    PointField.UINT16: "u2",
    PointField.INT32: "i4",
    PointField.UINT32: "u4",
    PointField.FLOAT32: "f4",
    PointField.FLOAT64: "f8",
}
_IS_BIG = sys.byteorder == "big"
MOST_VALUES = 4096
"""Most values of a point: more are a mistake in a field's count, and would take minutes to name."""


class PointCloudError(MessageError, AssertionError):
    """A cloud that contradicts itself, a field that it lacks, or points that do not fit the fields."""


def read_points(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> np.ndarray[Any, Any]:
    """Return a cloud's points as a structured array; it is a view of the cloud's data if nothing has to be moved.

    Args:
        cloud: The point cloud.
        field_names: Names of the fields to read, in this order; None: all.
        skip_nans: True: leave out points with a NaN in a field that is read, unless the cloud is dense.
        uvs: Numbers of the wanted points, or their (column, row); None: all.
        reshape_organized_cloud: True: an organized cloud becomes an array of (width, height).

    Raises:
        PointCloudError: if the cloud contradicts itself, lacks a field, or cannot be reshaped.
    """
    _check_is_cloud(cloud)
    points = _selected(_all_points(cloud), field_names)
    if uvs is not None:
        points = points[_places(uvs, cloud)]
    whole = len(points)
    if skip_nans and not cloud.is_dense:
        points = points[~_has_nan(points)]
    if reshape_organized_cloud and cloud.height > 1:
        if uvs is not None or len(points) < whole:
            raise PointCloudError("a part of an organized cloud has no width and height: read it without reshaping")
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> np.ndarray[Any, Any]:
    """Return the points as a plain array, a column for each value.

    Args:
        cloud: The point cloud.
        field_names: Names of the fields to read, in this order, all of one type; None: all.
        skip_nans: True: leave out points with a NaN in a field that is read, unless the cloud is dense.
        uvs: Numbers of the wanted points, or their (column, row); None: all.
        reshape_organized_cloud: True: an organized cloud becomes an array of (width, height, values).

    Raises:
        PointCloudError: if the fields are of several types, and as `read_points`.
    """
    _check_is_cloud(cloud)
    names = None if field_names is None else list(field_names)
    points = read_points(cloud, names, skip_nans, uvs, reshape_organized_cloud)
    types = {points.dtype[name] for name in points.dtype.names or ()}
    if len(types) > 1:
        listed = ", ".join(sorted(str(each) for each in types))
        raise PointCloudError(f"the fields are of several types ({listed}): name some of one type, or use read_points")
    columns = [points[name] for name in points.dtype.names or ()]
    return np.stack(columns, axis=-1) if columns else np.zeros((*points.shape, 0))


def read_points_list(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
) -> list[Any]:
    """Return the points as namedtuples of Python's numbers.

    Args:
        cloud: The point cloud.
        field_names: Names of the fields to read, in this order; None: all.
        skip_nans: True: leave out points with a NaN in a field that is read, unless the cloud is dense.
        uvs: Numbers of the wanted points, or their (column, row); None: all.

    Raises:
        PointCloudError: as `read_points`.
    """
    points = read_points(cloud, field_names, skip_nans, uvs)
    point = namedtuple("Point", points.dtype.names or (), rename=True)  # type: ignore[misc]
    return [point._make(each) for each in points.tolist()]


def dtype_from_fields(fields: Iterable[PointField], point_step: int | None = None) -> np.dtype[Any]:
    """Return the structured dtype of a point with `fields`; its size is `point_step` bytes (None: that of the fields).

    A field of several values becomes ``name_0``, ``name_1`` ... Raises PointCloudError for fields that make no type.
    """
    return _dtype(fields, point_step, "=")


def create_cloud(
    header: Header, fields: Sequence[PointField], points: Iterable[Any], point_step: int | None = None
) -> PointCloud2:
    """Make a cloud of points.

    Args:
        header: The cloud's header.
        fields: The fields of a point.
        points: A structured array, a plain one with a column for each value, or tuples. An array with one more
            dimension, (width, height), makes an organized cloud.
        point_step: Bytes of a point; None: those of its fields, or of an element of a structured array, so that
            points that `read_points` returned make a cloud with the padding of theirs.

    Raises:
        PointCloudError: if the fields make no type, or the points do not fit them.
    """
    fields = list(fields)
    if point_step is None and isinstance(points, np.ndarray) and points.dtype.names is not None:
        # Where the fields need more, the points do not fit them, which is told below.
        point_step = max(points.dtype.itemsize, dtype_from_fields(fields).itemsize)
    found = _as_points(points, dtype_from_fields(fields, point_step))
    if found.ndim not in (1, 2):
        raise PointCloudError(f"points are a row or, in an organized cloud, a grid; got {found.ndim} dimensions")
    width, height = (found.shape[0], 1) if found.ndim == 1 else found.shape
    return PointCloud2(
        header=header,
        height=height,
        width=width,
        is_dense=False,
        is_bigendian=_IS_BIG,
        fields=fields,
        point_step=found.dtype.itemsize,
        row_step=found.dtype.itemsize * width,
        data=array("B", found.tobytes()),
    )


def create_cloud_xyz32(header: Header, points: Iterable[Any]) -> PointCloud2:
    """Make a cloud with `header` of `points`: x, y and z in metres, in single precision."""
    names = enumerate("xyz")
    fields = [PointField(name=name, offset=4 * at, datatype=PointField.FLOAT32, count=1) for at, name in names]
    return create_cloud(header, fields, points)


def _check_is_cloud(cloud: Any) -> None:
    if not isinstance(cloud, PointCloud2):
        raise PointCloudError(f"expected a sensor_msgs.msg.PointCloud2, got {type(cloud).__name__}")


def _all_points(cloud: PointCloud2) -> np.ndarray[Any, Any]:
    """Return all points in a row, in this machine's byte order."""
    dtype = _dtype(cloud.fields, cloud.point_step, ">" if cloud.is_bigendian else "<")
    strides = (row_step_of(cloud), cloud.point_step)
    if not cloud.height * cloud.width * cloud.point_step:
        return np.zeros(0, dtype.newbyteorder("="))
    data: Any = cloud.data
    shape = (cloud.height, cloud.width)
    grid: np.ndarray[Any, Any] = np.ndarray(shape, dtype, buffer=memoryview(data), strides=strides)
    points = grid.reshape(-1)
    return points if bool(cloud.is_bigendian) == _IS_BIG else points.astype(dtype.newbyteorder("="))


def row_step_of(cloud: PointCloud2) -> int:
    """Return the bytes from one row of `cloud` to the next; a single row, or a `row_step` of 0, has no padding.

    Raises PointCloudError where rows would overlap or the data is too short.
    """
    row = cloud.width * cloud.point_step
    row_step = cloud.row_step if cloud.row_step and cloud.height > 1 else row
    needed = row_step * (cloud.height - 1) + row if cloud.height else 0
    if row_step < row or needed > len(cloud.data):
        raise PointCloudError(
            f"{cloud.width} x {cloud.height} points of {cloud.point_step} bytes in rows of {row_step} need"
            f" {needed} bytes; there are {len(cloud.data)}"
        )
    return row_step


def _dtype(fields: Iterable[PointField], point_step: int | None, order: str) -> np.dtype[Any]:
    values = list(_values(fields))
    names = [name for name, _, _ in values]
    twice = next((name for at, name in enumerate(names) if name in names[:at]), None)
    if twice is not None:
        raise PointCloudError(f"two fields are named '{twice}'")
    layout: dict[str, Any] = {
        "names": names,
        "formats": [order + kind for _, kind, _ in values],
        "offsets": [offset for _, _, offset in values],
    }
    if point_step is not None:
        layout["itemsize"] = point_step
    try:
        return np.dtype(layout)  # type: ignore[call-overload,no-any-return]
    except (ValueError, TypeError, OverflowError) as error:
        raise PointCloudError(f"the fields make no point: {error}") from None


def _values(fields: Iterable[PointField]) -> Iterable[tuple[str, str, int]]:
    """Yield the name, type and offset of each value of a point."""
    total = 0
    for number, field in enumerate(fields):
        kind = _FORMATS.get(field.datatype)
        if kind is None:
            raise PointCloudError(f"field '{field.name}': there is no datatype {field.datatype}")
        total += field.count
        if not field.count or total > MOST_VALUES:
            raise PointCloudError(
                f"field '{field.name}': a count of {field.count}; a point has 1 to {MOST_VALUES} values"
            )
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{number}"
        for index in range(field.count):
            yield (f"{name}_{index}" if field.count > 1 else name), kind, field.offset + index * int(kind[1])


def _selected(points: np.ndarray[Any, Any], field_names: Iterable[str] | None) -> np.ndarray[Any, Any]:
    if field_names is None:
        return points
    expected, known = list(field_names), points.dtype.names or ()
    missing = [name for name in expected if name not in known]
    if missing:
        raise PointCloudError(f"the cloud has no field {', '.join(missing)}; it has {', '.join(known) or 'none'}")
    try:
        return points[expected]
    except (KeyError, ValueError) as error:  # one name twice
        raise PointCloudError(f"the fields asked for: {error}") from None


def _places(uvs: Iterable[Any], cloud: PointCloud2) -> np.ndarray[Any, Any]:
    """Return the numbers of points; a pair is (column, row)."""
    found = np.asarray(uvs if isinstance(uvs, np.ndarray) else list(uvs))
    if found.size == 0:
        return np.zeros(0, int)
    if found.ndim == 2 and found.shape[1] == 2 and found.dtype.kind in "iu":
        found = found[:, 1] * cloud.width + found[:, 0]
    count = cloud.width * cloud.height
    if found.ndim != 1 or found.dtype.kind not in "iu" or found.min() < -count or found.max() >= count:
        raise PointCloudError(f"uvs: expected numbers of points below {count}, or pairs of (column, row)")
    return found


def _has_nan(points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    found = np.zeros(len(points), bool)
    for name in points.dtype.names or ():
        found |= np.isnan(points[name])
    return found


def _as_points(points: Iterable[Any], dtype: np.dtype[Any]) -> np.ndarray[Any, Any]:
    """Return points as a structured array whose padding is zero."""
    if isinstance(points, np.ndarray) and points.dtype.names is not None:
        if points.dtype != dtype:
            raise PointCloudError(f"the points are of {points.dtype}; the fields say {dtype}")
        return points
    names = dtype.names or ()
    if not isinstance(points, np.ndarray):
        rows = [tuple(each) for each in points]
        wrong = next((each for each in rows if len(each) != len(names)), None)
        if wrong is not None:
            raise PointCloudError(f"a point has {len(names)} values ({', '.join(names)}), got {wrong!r:.80}")
        return _filled(dtype, (len(rows),), [[row[at] for row in rows] for at in range(len(names))])
    if points.ndim < 2 or points.shape[-1] != len(names):
        raise PointCloudError(f"a point has {len(names)} values ({', '.join(names)}), got an array of {points.shape}")
    types = {dtype[name] for name in names}
    if len(types) > 1:
        raise PointCloudError("fields of several types need a structured array, or tuples")
    return _filled(dtype, points.shape[:-1], [points[..., at] for at in range(len(names))])


def _filled(dtype: np.dtype[Any], shape: tuple[int, ...], columns: Sequence[Any]) -> np.ndarray[Any, Any]:
    made = np.zeros(shape, dtype)
    try:
        for name, values in zip(dtype.names or (), columns, strict=True):
            made[name] = values
    except (ValueError, TypeError, OverflowError) as error:
        raise PointCloudError(f"points that do not fit their fields: {error}") from None
    return made
