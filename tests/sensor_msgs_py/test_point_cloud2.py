"""Point clouds become numpy arrays and back: any fields, either order of bytes, padding, and nonsense."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.lib.recfunctions import structured_to_unstructured

from robolink.interfaces.sensor_msgs.msg import LaserScan, PointCloud2, PointField
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import decode, encode
from robolink.sensor_msgs_py.point_cloud2 import (
    _FORMATS,
    DUMMY_FIELD_PREFIX,
    PointCloudError,
    create_cloud,
    create_cloud_xyz32,
    dtype_from_fields,
    read_points,
    read_points_list,
    read_points_numpy,
)

POINTS = [(0.0, 0.5, 1.0), (2.0, float("nan"), 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)]
HEADER = Header(frame_id="lidar")


def field(name: str, offset: int, kind: int = PointField.FLOAT32, count: int = 1) -> PointField:
    return PointField(name=name, offset=offset, datatype=kind, count=count)


@pytest.fixture
def cloud() -> PointCloud2:
    return create_cloud_xyz32(HEADER, POINTS)


no_cloud: Any = LaserScan()


def same(found: Any, wanted: Any) -> bool:
    return bool(np.array_equal(np.asarray(found, float), np.asarray(wanted, float), equal_nan=True))


def test_a_cloud_of_three_coordinates(cloud: PointCloud2) -> None:
    assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step) == (4, 1, 12, 48)
    assert (cloud.header.frame_id, cloud.is_dense, cloud.is_bigendian) == ("lidar", False, sys.byteorder == "big")
    assert [(each.name, each.offset) for each in cloud.fields] == [("x", 0), ("y", 4), ("z", 8)]
    assert same(read_points_numpy(cloud), POINTS)
    arrived = decode(PointCloud2, encode(cloud))
    assert arrived == cloud
    assert same(read_points_numpy(arrived), POINTS)


def test_structured_points_and_lists(cloud: PointCloud2) -> None:
    points = read_points(cloud)
    assert points.dtype.names == ("x", "y", "z")
    assert same(points["z"], [1.0, 3.0, 6.0, 9.0])
    listed = read_points_list(cloud, ["z", "x"])
    assert (listed[2].z, listed[2].x, type(listed[2].x)) == (6.0, 4.0, float)
    assert same(read_points_numpy(cloud, ("z", "x")), [(z, x) for x, _, z in POINTS])


def test_nan_and_chosen_points(cloud: PointCloud2) -> None:
    assert same(read_points_numpy(cloud, skip_nans=True), [POINTS[0], *POINTS[2:]])
    assert len(read_points(cloud, ["x"], skip_nans=True)) == 4
    assert same(read_points_numpy(cloud, uvs=[3, 1]), [POINTS[3], POINTS[1]])
    assert same(read_points_numpy(cloud, uvs=iter([3, 1]), skip_nans=True), [POINTS[3]])  # 3 is the cloud's third
    assert same(read_points_numpy(cloud, uvs=np.array([-1])), [POINTS[3]])
    assert read_points(cloud, uvs=[]).shape == (0,)
    cloud.is_dense = True
    assert len(read_points(cloud, skip_nans=True)) == 4


def test_an_organized_cloud() -> None:
    grid = np.arange(2 * 3 * 3, dtype=np.float32).reshape(2, 3, 3)
    cloud = create_cloud_xyz32(HEADER, grid)
    assert (cloud.width, cloud.height, cloud.row_step) == (2, 3, 24)
    assert same(read_points_numpy(cloud), grid.reshape(6, 3))
    assert same(read_points_numpy(cloud, reshape_organized_cloud=True), grid)
    assert same(read_points_numpy(cloud, uvs=[(1, 2), (0, 1)]), grid.reshape(6, 3)[[5, 2]])
    with pytest.raises(PointCloudError, match="has no width and height"):
        read_points(cloud, uvs=[0], reshape_organized_cloud=True)


def test_rows_with_padding_and_the_other_order_of_bytes() -> None:
    layout = {"names": ["x", "n"], "formats": [">f4", ">u2"], "offsets": [0, 6], "itemsize": 12}
    rows: Any = np.zeros((2, 3), np.dtype(layout))  # type: ignore[call-overload]
    rows["x"], rows["n"] = [[1, 2, 3], [4, 5, 6]], [[1, 2, 3], [4, 5, 6]]
    data = b"".join(row.tobytes() + b"\xff" * 5 for row in rows)[:-5]
    cloud = PointCloud2(
        width=3,
        height=2,
        fields=[field("x", 0), field("n", 6, PointField.UINT16)],
        is_bigendian=True,
        point_step=12,
        row_step=41,
        data=data,
    )
    points = read_points(cloud)
    assert points["x"].tolist() == points["n"].tolist() == [1, 2, 3, 4, 5, 6]
    assert points["x"].dtype.isnative


def test_fields_of_several_values_and_without_names() -> None:
    fields = [field("rgb", 0, PointField.UINT8, 3), field("", 4)]
    assert dtype_from_fields(fields).names == ("rgb_0", "rgb_1", "rgb_2", f"{DUMMY_FIELD_PREFIX}_1")
    cloud = create_cloud(HEADER, fields, [(1, 2, 3, 0.5)], point_step=16)
    assert read_points_list(cloud)[0] == (1, 2, 3, 0.5)
    assert bytes(cloud.data[8:]) == bytes(8)
    assert read_points(cloud).dtype == dtype_from_fields(fields, 16)


def test_a_structured_array_goes_in_as_it_is(cloud: PointCloud2) -> None:
    fields = [field("a", 0, PointField.FLOAT64), field("b", 8, PointField.INT8)]
    points = np.array([(0.1, -5), (0.2, 7)], dtype_from_fields(fields))
    made = create_cloud(HEADER, fields, points)
    assert read_points(made).tolist() == points.tolist()
    assert made.point_step == 9
    assert same(structured_to_unstructured(read_points(cloud)), read_points_numpy(cloud))


def test_no_points() -> None:
    empty: tuple[Any, ...] = ([], np.zeros((0, 3), np.float32))
    for nothing in empty:
        cloud = create_cloud_xyz32(HEADER, nothing)
        assert (cloud.width, len(cloud.data)) == (0, 0)
        assert read_points_numpy(cloud).shape == (0, 3)
    assert read_points(PointCloud2()).shape == (0,)


@pytest.mark.parametrize(
    ("act", "report"),
    [
        (lambda it: read_points(no_cloud), "expected a sensor_msgs.msg.PointCloud2, got LaserScan"),
        (lambda it: read_points(it, ["x", "w"]), "the cloud has no field w; it has x, y, z"),
        (lambda it: read_points(it, ["x", "x"]), "the fields asked for"),
        (lambda it: read_points(it, uvs=[4]), "uvs: expected numbers of points below 4"),
        (lambda it: read_points(it, uvs=[0.5]), "uvs: expected numbers"),
        (lambda it: create_cloud_xyz32(HEADER, [(1, 2)]), "a point has 3 values (x, y, z), got (1, 2)"),
        (
            lambda it: create_cloud_xyz32(HEADER, np.zeros((4, 2))),
            "a point has 3 values (x, y, z), got an array of (4, 2)",
        ),
        (lambda it: create_cloud_xyz32(HEADER, np.zeros((2, 2, 2, 3))), "got 3 dimensions"),
        (lambda it: create_cloud_xyz32(HEADER, [("a", "b", "c")]), "points that do not fit their fields"),
        (lambda it: create_cloud(HEADER, [field("x", 0, 9)], []), "field 'x': there is no datatype 9"),
        (lambda it: create_cloud(HEADER, [field("x", 0, count=0)], []), "field 'x': a count of 0"),
        (lambda it: create_cloud(HEADER, [field("x", 0, count=2**31)], []), "field 'x': a count of 2147483648"),
        (lambda it: create_cloud(HEADER, [field("x", 0), field("x", 4)], []), "two fields are named 'x'"),
        (lambda it: create_cloud(HEADER, it.fields, [], point_step=8), "the fields make no point"),
        (lambda it: create_cloud(HEADER, it.fields, np.zeros(1, "f4,f4")), "the points are of"),
        (
            lambda it: create_cloud(HEADER, [field("a", 0), field("b", 4, PointField.INT8)], np.zeros((2, 2))),
            "fields of several types need a structured array",
        ),
        (
            lambda it: read_points_numpy(create_cloud(HEADER, [field("a", 0), field("b", 4, 1)], [(1, 2)])),
            "the fields are of several types (float32, int8)",
        ),
    ],
)
def test_what_does_not_fit_is_told(act: Any, report: str, cloud: PointCloud2) -> None:
    with pytest.raises(PointCloudError) as caught:
        act(cloud)
    assert report in str(caught.value)
    assert isinstance(caught.value, AssertionError)  # what upstream raises


FIELDS = st.lists(
    st.builds(
        field,
        st.sampled_from(["x", "y", "z", "", "rgb"]),
        st.integers(0, 40),
        st.integers(0, 9),
        st.integers(0, 3) | st.just(2**32 - 1),
    ),
    max_size=5,
)


@given(
    FIELDS,
    st.integers(0, 48) | st.just(2**32 - 1),
    st.integers(0, 3),
    st.integers(0, 3),
    st.integers(0, 200),
    st.binary(max_size=600),
    st.booleans(),
)
def test_any_cloud_is_read_or_refused(
    fields: list[PointField], step: int, width: int, height: int, row: int, data: bytes, big: bool
) -> None:
    cloud = PointCloud2(
        fields=fields, point_step=step, width=width, height=height, row_step=row, data=data, is_bigendian=big
    )
    try:
        points = read_points(cloud)
    except PointCloudError:
        return
    assert points.shape == (width * height,) or step == 0
    assert len(read_points_list(cloud, skip_nans=True)) <= len(points)


@given(st.data())
def test_what_goes_in_comes_out(data: st.DataObject) -> None:
    kinds = data.draw(st.lists(st.sampled_from(sorted(_FORMATS)), min_size=1, max_size=4))
    fields, offset = [], 0
    for number, kind in enumerate(kinds):
        offset += data.draw(st.integers(0, 3))
        fields.append(field(f"f{number}", offset, kind))
        offset += int(_FORMATS[kind][1])
    values = [st.floats(width=32) if _FORMATS[kind][0] == "f" else st.integers(0, 127) for kind in kinds]
    points = data.draw(st.lists(st.tuples(*values), max_size=5))
    assert same(read_points_list(create_cloud(HEADER, fields, points)), points)


def test_points_of_a_padded_cloud_make_one_like_it() -> None:
    fields = [field("x", 0), field("intensity", 8, PointField.UINT16)]
    padded = create_cloud(HEADER, fields, [(1.0, 2), (3.0, 4)], point_step=32)
    again = create_cloud(HEADER, fields, read_points(padded))
    assert again == padded
    assert create_cloud(HEADER, fields, read_points(padded), point_step=32) == padded
    with pytest.raises(PointCloudError, match="the fields say"):
        create_cloud(HEADER, fields, read_points(padded), point_step=16)
