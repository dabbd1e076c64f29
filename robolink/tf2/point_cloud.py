"""Transformation of point clouds into another frame: the API of ROS 2's tf2_sensor_msgs."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robolink.interfaces.geometry_msgs.msg import Transform, TransformStamped
from robolink.interfaces.sensor_msgs.msg import PointCloud2, PointField
from robolink.interfaces.std_msgs.msg import Header
from robolink.sensor_msgs_py.point_cloud2 import PointCloudError, row_step_of
from robolink.tf2.buffer_interface import ConvertRegistration, TransformRegistration
from robolink.tf2.geometry import from_msg_msg, rotation_of, to_msg_msg

FLOATS = {PointField.FLOAT32: "f4", PointField.FLOAT64: "f8"}
"""numpy types of the datatypes of coordinates."""


def transform_points(point_cloud: NDArray[Any], transform: Transform) -> NDArray[Any]:
    """Return the points of an N x 3 array, in m, rotated and moved by `transform`."""
    place = transform.translation
    moved: NDArray[Any] = np.asarray(point_cloud) @ rotation_of(transform).T + (place.x, place.y, place.z)
    return moved


def do_transform_cloud(cloud: PointCloud2, transform: Transform | TransformStamped) -> PointCloud2:
    """Return a copy of a cloud with x, y and z in another frame; its other fields and its stamp stay.

    Args:
        cloud: The cloud, with x, y and z as single floats. It is not changed.
        transform: A TransformStamped, whose frame the copy gets; or a Transform, which keeps the frame's name.

    Raises:
        PointCloudError: if the cloud has no coordinates as floats, or too few bytes.
    """
    frame = cloud.header.frame_id
    if isinstance(transform, TransformStamped):
        frame, transform = transform.header.frame_id, transform.transform
    data = bytearray(cloud.data)
    points = _coordinates(cloud, data)
    moved = transform_points(np.stack([each.ravel() for each in points], axis=1).astype(np.float64), transform)
    for column, each in enumerate(points):
        each[...] = moved[:, column].reshape(each.shape)
    return PointCloud2(
        header=Header(stamp=deepcopy(cloud.header.stamp), frame_id=frame),
        height=cloud.height,
        width=cloud.width,
        fields=deepcopy(cloud.fields),
        is_bigendian=cloud.is_bigendian,
        point_step=cloud.point_step,
        row_step=cloud.row_step,
        data=data,
        is_dense=cloud.is_dense,
    )


def _coordinates(cloud: PointCloud2, data: bytearray) -> list[NDArray[Any]]:
    """Return views of x, y and z in a cloud's bytes, each height x width."""
    fields = {each.name: each for each in cloud.fields}
    if not {"x", "y", "z"} <= fields.keys():
        there = ", ".join(fields) or "none"
        raise PointCloudError(f"a cloud without x, y and z cannot be moved to another frame: its fields are {there}")
    row_step = row_step_of(cloud)
    return [_column(cloud, fields[name], data, row_step) for name in "xyz"]


def _column(cloud: PointCloud2, field: PointField, data: bytearray, row_step: int) -> NDArray[Any]:
    kind = FLOATS.get(field.datatype)
    if kind is None or field.count > 1:
        raise PointCloudError(f"the field {field.name} is not a single float (datatype {field.datatype})")
    dtype = np.dtype((">" if cloud.is_bigendian else "<") + kind)
    if field.offset + dtype.itemsize > cloud.point_step:
        raise PointCloudError(f"the field {field.name} reaches beyond the {cloud.point_step} bytes of a point")
    if not cloud.height * cloud.width:
        return np.empty((cloud.height, cloud.width), dtype)
    strides = (row_step, cloud.point_step)
    column: NDArray[Any] = np.ndarray((cloud.height, cloud.width), dtype, data, field.offset, strides)
    return column


TransformRegistration().add(PointCloud2, do_transform_cloud)
ConvertRegistration().add_to_msg(PointCloud2, to_msg_msg)
ConvertRegistration().add_from_msg(PointCloud2, from_msg_msg)
