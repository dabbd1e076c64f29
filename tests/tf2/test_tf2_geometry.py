"""Geometry and point clouds in another frame, against scipy; and what Buffer.transform makes of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    Polygon,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    QuaternionStamped,
    TransformStamped,
    Twist,
    Vector3,
    Vector3Stamped,
    Wrench,
    WrenchStamped,
)
from robolink.interfaces.sensor_msgs.msg import PointCloud2, PointField
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import decode, encode
from robolink.sensor_msgs_py.point_cloud2 import PointCloudError
from robolink.tf2 import (
    Buffer,
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
from robolink.tf2 import geometry as geo
from robolink.tf2.point_cloud import do_transform_cloud, transform_points
from robolink.time import Time
from tests.support.transforms import matrix, rotation, transform
from tests.tf2.test_tf2_core import PLACE, TURN

HEADER = Header(stamp=TimeMsg(sec=3), frame_id="map")


def xyz(message: Any) -> Any:
    return np.array([message.x, message.y, message.z])


def given_as(kind: Any, numbers: tuple[float, ...]) -> Any:
    return kind(**dict(zip("xyzw", numbers, strict=False)))


moves = st.builds(lambda place, turn: transform("map", "base", 3, place, turn), PLACE, TURN)


@given(moves, PLACE)
def test_points_move_and_vectors_only_turn(move: TransformStamped, numbers: tuple[float, ...]) -> None:
    point, vector = given_as(Point, numbers), given_as(Vector3, numbers)
    moved, turned = matrix(move) @ (*numbers, 1.0), rotation(move).apply(numbers)
    before = encode(move)
    assert np.allclose(xyz(geo.do_transform_point(point, move)), moved[:3])
    assert np.allclose(xyz(geo.do_transform_point(PointStamped(point=point), move).point), moved[:3])
    assert np.allclose(xyz(geo.do_transform_vector3(vector, move)), turned)
    stamped = geo.do_transform_vector3(Vector3Stamped(vector=vector), move)
    assert np.allclose(xyz(stamped.vector), turned)
    assert stamped.header == HEADER
    assert stamped.header is not move.header
    assert encode(move) == before  # tf2's own sets its translation to zero
    assert np.allclose(xyz(point), numbers)


@given(moves, PLACE, TURN)
def test_poses_move_and_turn(move: TransformStamped, place: Any, turn: Any) -> None:
    pose = Pose(position=given_as(Point, place), orientation=given_as(Quaternion, turn))
    wanted = matrix(move) @ matrix(transform("a", "b", 0, place, turn))
    stamped = PoseStamped(pose=pose)
    for found in (
        geo.do_transform_pose(pose, move),
        geo.do_transform_pose_stamped(stamped, move).pose,
        geo.do_transform_pose(stamped, move).pose,
        geo.do_transform_pose_with_covariance(PoseWithCovariance(pose=pose), move).pose,
    ):
        assert np.allclose(xyz(found.position), wanted[:3, 3])
        assert found.orientation.w >= 0.0
        q = found.orientation
        again = transform("a", "b", 0, tuple(xyz(found.position)), (q.x, q.y, q.z, q.w))
        assert np.allclose(matrix(again), wanted)
    turned = geo.do_transform_quaternion(QuaternionStamped(quaternion=pose.orientation), move)
    assert turned.quaternion == geo.do_transform_pose(pose, move).orientation
    assert geo.do_transform_quaternion(pose.orientation, move) == turned.quaternion
    assert geo.do_transform_pose_stamped(stamped, move).header == turned.header == HEADER


@given(moves, st.integers(0, 1000))
def test_a_covariance_turns_in_its_four_quarters(move: TransformStamped, seed: int) -> None:
    covariance = np.random.default_rng(seed).uniform(-1, 1, (6, 6))
    turn = np.kron(np.identity(2), rotation(move).as_matrix())
    wanted = (turn @ covariance @ turn.T).ravel()
    assert np.allclose(geo.transform_covariance(covariance.ravel(), move), wanted)
    stamped = PoseWithCovarianceStamped(pose=PoseWithCovariance(covariance=covariance.ravel()))
    found = geo.do_transform_pose_with_covariance_stamped(stamped, move)
    assert np.allclose(found.pose.covariance, wanted)
    assert decode(PoseWithCovarianceStamped, encode(found)) == found


@given(moves, PLACE, PLACE)
def test_a_force_gets_a_lever(move: TransformStamped, force: Any, torque: Any) -> None:
    wrench = Wrench(force=given_as(Vector3, force), torque=given_as(Vector3, torque))
    turned = rotation(move).apply(force)
    lever = np.cross(matrix(move)[:3, 3], turned)
    for found in (
        geo.do_transform_wrench(wrench, move),
        geo.do_transform_wrench(WrenchStamped(wrench=wrench), move).wrench,
        geo.do_transform_wrench_stamped(WrenchStamped(wrench=wrench), move).wrench,
    ):
        assert np.allclose(xyz(found.force), turned)
        assert np.allclose(xyz(found.torque), rotation(move).apply(torque) + lever)


@given(moves, st.lists(PLACE, max_size=4))
def test_all_points_of_a_polygon_move(move: TransformStamped, corners: list[Any]) -> None:
    polygon = Polygon(points=[given_as(Point32, each) for each in corners])
    found = geo.do_transform_polygon_stamped(PolygonStamped(polygon=polygon), move)
    wanted = [(matrix(move) @ (*each, 1.0))[:3] for each in corners]
    assert np.allclose([xyz(each) for each in found.polygon.points], wanted)
    assert found.header == HEADER


def test_a_rotation_of_nothing_turns_nothing() -> None:
    move = transform("map", "base", 0, (1, 2, 3), (0, 0, 0, 0))
    assert geo.do_transform_point(Point(x=1.0), move) == Point(x=2.0, y=2.0, z=3.0)
    scaled = transform("map", "base", 0, turn=(0, 0, 0, 5))
    assert geo.do_transform_point(Point(x=1.0), scaled) == Point(x=1.0)


# --- point clouds ---------------------------------------------------------------------------------------------


def cloud(
    points: Any, kind: str = "<f4", step: int = 24, rows: int = 1, padding: int = 0, **changed: Any
) -> PointCloud2:
    """A cloud of N x 3 points; each has an intensity before and bytes behind, each row some bytes more."""
    points = np.asarray(points, float).reshape(rows, -1, 3)
    dtype = np.dtype(kind)
    datatype = PointField.FLOAT32 if dtype.itemsize == 4 else PointField.FLOAT64
    offsets = {name: 4 + at * dtype.itemsize for at, name in enumerate("xyz")}
    fields = [PointField(name="intensity", offset=0, datatype=PointField.UINT32, count=1)]
    fields += [PointField(name=name, offset=at, datatype=datatype, count=1) for name, at in offsets.items()]
    row_step = points.shape[1] * step + padding
    data = bytearray(b"\xaa" * rows * row_step)
    for at, name in enumerate("xyz"):
        column: Any = np.ndarray(points.shape[:2], dtype, data, offsets[name], (row_step, step))
        column[...] = points[:, :, at]
    made = PointCloud2(
        header=Header(stamp=TimeMsg(sec=9), frame_id="lidar"),
        height=rows,
        width=points.shape[1],
        fields=fields,
        is_bigendian=kind[0] == ">",
        point_step=step,
        row_step=row_step,
        data=data,
    )
    for name, value in changed.items():
        setattr(made, name, value)
    return made


@given(
    moves,
    st.lists(PLACE, min_size=2, max_size=6).filter(lambda each: len(each) % 2 == 0),
    st.sampled_from([("<f4", 16), ("<f4", 24), (">f4", 17), ("<f8", 32), (">f8", 28)]),
    st.sampled_from([(1, 0), (2, 0), (2, 5)]),
)
def test_a_cloud_moves_and_all_else_of_it_stays(move: TransformStamped, points: Any, form: Any, shape: Any) -> None:
    points = np.array(points, form[0]).astype(float)  # as exact as the cloud can be
    given_cloud = cloud(points, *form, *shape)
    bytes_before = bytes(given_cloud.data)
    found = do_transform_cloud(given_cloud, move)
    wanted = transform_points(points, move.transform)
    assert np.allclose(wanted, [(matrix(move) @ (*each, 1.0))[:3] for each in points])
    assert bytes(given_cloud.data) == bytes_before
    again = cloud(wanted, *form, *shape)
    again.header.frame_id = "map"
    assert (found.fields, found.header, found.row_step) == (again.fields, again.header, again.row_step)
    assert bytes(found.data) == bytes(again.data)
    assert decode(PointCloud2, encode(found)) == found
    back = do_transform_cloud(found, buffer_of(move).lookup_transform("base", "map", Time(seconds=3)))
    assert np.allclose(coordinates(back), points, atol=1e-4)


def buffer_of(move: TransformStamped) -> Buffer:
    buffer = Buffer()
    buffer.set_transform(move, "test")
    return buffer


def coordinates(message: PointCloud2) -> Any:
    kind = (">" if message.is_bigendian else "<") + ("f4" if message.fields[1].datatype == PointField.FLOAT32 else "f8")
    data = bytes(message.data)
    columns = [
        np.ndarray((message.height, message.width), kind, data, each.offset, (message.row_step, message.point_step))
        for each in message.fields[1:]
    ]
    return np.stack([each.ravel() for each in columns], axis=1)


def test_a_bare_transform_leaves_the_frame_and_nan_stays_nan() -> None:
    found = do_transform_cloud(cloud([[1, 2, 3], [float("nan")] * 3]), transform("map", "x", 0, (1, 0, 0)).transform)
    assert found.header.frame_id == "lidar"
    assert coordinates(found)[0].tolist() == [2, 2, 3]
    assert np.isnan(coordinates(found)[1]).all()


def test_an_empty_cloud_stays_empty() -> None:
    for rows in (0, 1):
        empty = cloud([[1, 2, 3]], height=rows, width=0, row_step=0, data=b"")
        assert do_transform_cloud(empty, transform("map", "lidar")).width == 0


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"fields": []}, "without x, y and z cannot be moved to another frame: its fields are none"),
        ({"data": b"short"}, "2 x 1 points of 24 bytes in rows of 48 need 48 bytes; there are 5"),
        ({"height": 2, "width": 1, "row_step": 10}, "in rows of 10 need 34 bytes; there are 48"),
        ({"width": 2**31, "row_step": 0}, "need 51539607552 bytes; there are 48"),
        ({"point_step": 8, "row_step": 48}, "the field y reaches beyond the 8 bytes of a point"),
    ],
)
def test_a_cloud_that_is_none_is_an_error(changed: Any, said: str) -> None:
    with pytest.raises(PointCloudError, match=said):
        do_transform_cloud(cloud([[1, 2, 3]] * 2, **changed), transform("map", "lidar"))


@pytest.mark.parametrize(("datatype", "count"), [(PointField.INT32, 1), (PointField.FLOAT32, 3), (0, 1)])
def test_coordinates_are_single_floats(datatype: int, count: int) -> None:
    bad = cloud([[1, 2, 3]])
    bad.fields[1].datatype, bad.fields[1].count = datatype, count
    with pytest.raises(PointCloudError, match="the field x is not a single float"):
        do_transform_cloud(bad, transform("map", "lidar"))


# --- Buffer.transform -----------------------------------------------------------------------------------------


@pytest.fixture
def buffer() -> Buffer:
    made = Buffer()
    for second in (1, 2):
        made.set_transform(transform("map", "base", second, (second, 0, 0)), "test")
    return made


def stamped(kind: Any, seconds: int = 1) -> Any:
    return Stamped(kind(), TimeMsg(sec=seconds), "base")


@pytest.mark.parametrize(
    "kind",
    [
        PointStamped,
        Vector3Stamped,
        PoseStamped,
        PoseWithCovarianceStamped,
        PolygonStamped,
        QuaternionStamped,
        WrenchStamped,
    ],
)
def test_every_stamped_type_is_transformed_without_importing_anything(kind: Any, buffer: Buffer) -> None:
    found = buffer.transform(stamped(kind), "map", new_type=kind)
    assert type(found) is kind
    assert found.header == Header(stamp=TimeMsg(sec=1), frame_id="map")


def test_clouds_are_transformed_as_well(buffer: Buffer) -> None:
    given_cloud = cloud([[1, 0, 0]])
    given_cloud.header = Header(stamp=TimeMsg(sec=2), frame_id="base")
    assert coordinates(buffer.transform(given_cloud, "map"))[0].tolist() == [3, 0, 0]


def test_from_one_time_to_another(buffer: Buffer) -> None:
    found = buffer.transform_full(stamped(PointStamped), "base", Time(seconds=2), "map")
    assert (found.point.x, found.header.stamp.sec) == (-1.0, 2)


def test_a_type_that_nobody_registered_is_an_error(buffer: Buffer) -> None:
    with pytest.raises(TypeException, match=r"Type .*Twist.* is not loaded or supported"):
        buffer.transform(Twist(), "map")
    with pytest.raises(TypeException):
        buffer.transform(stamped(PointStamped), "map", new_type=Twist)


class Arrow:
    """A type of one's own."""

    def __init__(self, x: float) -> None:
        self.x = x
        self.header = Header(stamp=TimeMsg(sec=1), frame_id="base")


def test_types_of_ones_own_are_transformed_and_converted(buffer: Buffer) -> None:
    def move(arrow: Arrow, by: TransformStamped) -> Arrow:
        return Arrow(arrow.x + by.transform.translation.x)

    TransformRegistration().add(Arrow, move)
    register = ConvertRegistration()
    register.add_to_msg(Arrow, lambda arrow: PointStamped(point=Point(x=arrow.x)))
    register.add_from_msg(Arrow, lambda message: Arrow(message.point.x))
    register.add_convert((Arrow, float), lambda arrow: arrow.x)
    assert buffer.transform(Arrow(5.0), "map").x == 6.0
    assert buffer.transform(Arrow(5.0), "map", new_type=PointStamped).point.x == 6.0
    assert buffer.transform(stamped(PointStamped), "map", new_type=Arrow).x == 1.0
    assert convert(Arrow(2.0), float) == 2.0
    arrow = Arrow(3.0)
    assert convert(arrow, Arrow) is not arrow
    assert convert(arrow, Arrow).x == 3.0


def test_what_is_registered_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    TransformRegistration().print_me()
    assert "PointStamped" in capsys.readouterr().out


def test_an_interface_alone_looks_up_nothing() -> None:
    bare, now = BufferInterface(), Time()
    for ask in (
        lambda: bare.lookup_transform("a", "b", now),
        lambda: bare.lookup_transform_full("a", now, "b", now, "c"),
        lambda: bare.can_transform("a", "b", now),
        lambda: bare.can_transform_full("a", now, "b", now, "c"),
    ):
        with pytest.raises(NotImplementedException):
            ask()
