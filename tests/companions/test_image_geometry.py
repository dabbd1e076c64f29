"""image_geometry: known cameras, OpenCV's projections and distortions, and cameras that are not calibrated."""

from __future__ import annotations

import math
import sys
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from robolink.companions.image_geometry import PinholeCameraModel, StereoCameraModel
from robolink.image import ImageError
from robolink.interfaces.sensor_msgs.msg import CameraInfo, RegionOfInterest
from robolink.interfaces.std_msgs.msg import Header

TURN = cv2.Rodrigues(np.array([0.01, -0.03, 0.02]))[0]
LENSES = {
    "none": [],
    "zeros": [0.0] * 5,
    "four": [-0.36, 0.16, -8e-5, -4e-4],
    "plumb_bob": [-0.3635, 0.1612, -8.1e-5, -4.5e-4, -0.02],
    "rational": [0.1, -0.05, 1e-3, -2e-3, 0.01, 0.3, -0.05, 0.01],
    "thin prism": [0.1, -0.05, 1e-3, -2e-3, 0.01, 0.3, -0.05, 0.01, 1e-3, -1e-3, 2e-3, 1e-3],
    "no tilt": [-0.3, 0.1, 1e-3, 1e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
}


def info(d: Any = (), **more: Any) -> CameraInfo:
    """A camera of 640 x 480 pixels, rectified into a slightly larger view."""
    k = [430.0, 0.0, 311.0, 0.0, 431.0, 221.0, 0.0, 0.0, 1.0]
    p = [295.0, 0.0, 319.5, 0.0, 0.0, 296.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0]
    values = {"width": 640, "height": 480, "k": k, "p": p, "r": TURN.reshape(-1), "d": d, **more}
    return CameraInfo(header=Header(frame_id="camera_optical_frame"), **values)


def camera(*args: Any, **more: Any) -> PinholeCameraModel:
    model = PinholeCameraModel()
    model.fromCameraInfo(info(*args, **more))
    return model


def matrices(message: CameraInfo) -> tuple[Any, Any, Any, Any]:
    d = np.asarray(message.d) if len(message.d) else None
    return np.reshape(message.k, (3, 3)), d, np.reshape(message.r, (3, 3)), np.reshape(message.p, (3, 4))


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(0.1, 50))
def test_points_to_pixels_and_back(x: float, y: float, z: float) -> None:
    model = camera()
    u, v = model.project3dToPixel((x, y, z))
    seen = cv2.projectPoints(np.array([[x, y, z]]), np.zeros(3), np.zeros(3), np.asarray(model.P)[:, :3], None)[0]
    assert_allclose((u, v), seen[0, 0], rtol=1e-9, atol=1e-9)
    ray = np.array(model.projectPixelTo3dRay((u, v)))
    assert_allclose(ray * (z / ray[2]), (x, y, z), rtol=1e-9, atol=1e-9)
    assert np.linalg.norm(ray) == pytest.approx(1)


@pytest.mark.parametrize("lens", LENSES)
def test_points_are_rectified_as_opencv_does_it(lens: str) -> None:
    message = info(LENSES[lens])
    model, (k, d, r, p) = camera(LENSES[lens]), matrices(message)
    for uv in [(0, 0), (311, 221), (639, 479), (100.5, 400.25), (600, 20)]:
        point = np.array([[uv]], np.float64)
        end = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 500, 1e-12)
        exact = getattr(cv2, "undistortPointsIter", cv2.undistortPoints)  # the first is OpenCV 4's
        expected = exact(point, k, d, R=r, P=p, criteria=end)[0, 0]
        found = model.rectifyPoint(uv)
        assert_allclose(found, expected, atol=1e-4)
        assert_allclose(model.unrectifyPoint(found), uv, atol=1e-5)


@pytest.mark.parametrize("lens", LENSES)
def test_points_go_through_the_lens_as_opencv_projects_them(lens: str) -> None:
    k, d, r, p = matrices(info(LENSES[lens]))
    model = camera(LENSES[lens])
    for x, y in [(0.0, 0.0), (0.3, -0.2), (-0.6, 0.4)]:
        raw = cv2.projectPoints(np.array([[x, y, 1.0]]), np.zeros(3), np.zeros(3), k, d)[0][0, 0]
        turned = p[:, :3] @ r @ [x, y, 1.0]
        assert_allclose(model.unrectifyPoint(turned[:2] / turned[2]), raw, atol=1e-8)


def test_a_fisheye() -> None:
    d = [0.05, -0.01, 0.002, -0.001]
    model, (k, coefficients, r, p) = camera(d, distortion_model="equidistant"), matrices(info(d))
    for uv in [(20, 20), (311, 221), (600, 400)]:
        point = np.array([[uv]], np.float64)
        expected = cv2.fisheye.undistortPoints(point, k, coefficients, R=r, P=p[:, :3])[0, 0]
        assert_allclose(model.rectifyPoint(uv), expected, atol=1e-4)
        assert_allclose(model.unrectifyPoint(model.rectifyPoint(uv)), uv, atol=1e-6)


@pytest.mark.parametrize("shape", [(480, 640), (480, 640, 3)])
def test_images_are_rectified_as_opencv_does_it(shape: tuple[int, ...]) -> None:
    d = LENSES["plumb_bob"]
    raw = cv2.GaussianBlur(np.random.default_rng(3).integers(0, 256, shape, np.uint8), (0, 0), 3)
    model, (k, coefficients, r, p) = camera(d), matrices(info(d))
    mapx, mapy = cv2.initUndistortRectifyMap(k, coefficients, r, p, (640, 480), cv2.CV_32FC1)
    expected = cv2.remap(raw, mapx, mapy, cv2.INTER_CUBIC)
    rectified = np.zeros_like(raw)
    model.rectifyImage(raw, rectified)
    assert_allclose(model.mapx, mapx, atol=1e-3)
    assert_allclose(model.mapy, mapy, atol=1e-3)
    assert np.abs(rectified.astype(int) - expected).max() <= 2
    assert_array_equal(model.rectifyImage(raw), rectified)


def test_a_region_and_binning() -> None:
    whole = camera()
    part = camera(roi=RegionOfInterest(x_offset=100, y_offset=40, width=200, height=100), binning_x=2, binning_y=4)
    point = (0.4, -0.2, 2.0)
    u, v = whole.project3dToPixel(point)
    assert part.project3dToPixel(point) == pytest.approx(((u - 100) / 2, (v - 40) / 4))
    assert part.fullIntrinsicMatrix()[0, 2] == 311
    assert part.fullProjectionMatrix()[0, 0] == 295
    assert (part.fullResolution(), part.fx(), part.fy()) == ((640, 480), 147.5, 74)
    assert (part.binning_x, part.raw_roi.width, whole.raw_roi.width) == (2, 200, 640)


def test_matrices_multiply_as_matrices() -> None:
    model = camera(LENSES["plumb_bob"])
    assert isinstance(model.K, np.matrix)
    assert model.intrinsicMatrix() is model.K
    assert (model.K @ np.array([[0.0], [0.0], [1.0]])).tolist() == [[311.0], [221.0], [1.0]]
    assert (model.P @ np.array([0.0, 0.0, 1.0, 1.0])).shape == (1, 3)
    assert (model.D.shape if model.D is not None else None) == (5, 1)
    assert camera().distortionCoeffs() is None
    assert model.rotationMatrix().shape == (3, 3)
    assert model.projectionMatrix().shape == (3, 4)


def test_figures() -> None:
    model = camera()
    assert (model.cx(), model.cy(), model.fx(), model.fy(), model.Tx(), model.Ty()) == (319.5, 239.5, 295, 296, 0, 0)
    assert model.fovX() == pytest.approx(2 * math.atan(320 / 295))
    assert model.fovY() == pytest.approx(2 * math.atan(240 / 296))
    assert (model.tfFrame(), model.get_tf_frame()) == ("camera_optical_frame", "camera_optical_frame")
    assert model.getDeltaX(model.getDeltaU(0.3, 2.0), 2.0) == pytest.approx(0.3)
    assert model.getDeltaY(model.getDeltaV(0.3, 2.0), 2.0) == pytest.approx(0.3)
    assert (model.getDeltaU(1, 0), model.getDeltaV(1, 0)) == (math.inf, math.inf)
    assert all(math.isnan(each) for each in model.project3dToPixel((1, 1, 0)))


def test_rolling_spells_them_otherwise() -> None:
    for kind in (PinholeCameraModel, StereoCameraModel):
        old = {name for name in vars(kind) if not name.startswith("_") and name != name.lower()}
        assert all(any(vars(kind)[name] is each for other, each in vars(kind).items() if other != name) for name in old)


def stereo(left_cx: float = 319.5) -> StereoCameraModel:
    model = StereoCameraModel()
    left = info(p=[295.0, 0.0, left_cx, 0.0, 0.0, 296.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0])
    right = info(p=[295.0, 0.0, 319.5, -295 * 0.09, 0.0, 296.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0])
    model.fromCameraInfo(left, right)
    return model


@pytest.mark.parametrize("left_cx", [319.5, 300.0])
def test_two_cameras(left_cx: float) -> None:
    model = stereo(left_cx)
    for point in [(0.1, 0.2, 1.0), (-1.0, 0.5, 4.0)]:
        (u, v), (other, row) = model.project3dToPixel(point)
        assert row == pytest.approx(v)
        scale = model.left.fx() / model.left.fy()
        x, y, z = model.projectPixelTo3d((u, v), u - other)
        assert (x, z) == pytest.approx((point[0], point[2]))
        assert y / scale == pytest.approx(point[1], rel=0.01)
        assert model.getZ(u - other) == pytest.approx(point[2])
        assert model.getDisparity(point[2]) == pytest.approx(u - other)
    assert model.getZ(model.left.cx() - model.right.cx()) == math.inf
    assert model.getDisparity(0) == math.inf
    assert model.tfFrame() == "camera_optical_frame"
    assert (model.get_left_camera(), model.get_right_camera()) == (model.left, model.right)


def test_what_is_infinitely_far_away_is_nowhere() -> None:
    assert stereo().projectPixelTo3d((1, 1), 0) == (0, 0, 0)


def refusals() -> dict[str, Any]:
    empty = PinholeCameraModel()
    uncalibrated = PinholeCameraModel()
    uncalibrated.fromCameraInfo(CameraInfo(width=640, height=480))
    raw = np.zeros((480, 640), np.uint8)
    return {
        "call fromCameraInfo(msg) with a CameraInfo first": lambda: empty.project3dToPixel((1, 2, 3)),
        "knows no camera yet": lambda: empty.rectifyPoint((1, 2)),
        "the camera model knows no camera": lambda: StereoCameraModel().projectPixelTo3d((1, 2), 3),
        "P of its CameraInfo has a focal length of 0": lambda: uncalibrated.projectPixelTo3dRay((1, 2)),
        "K of its CameraInfo has a focal length of 0": lambda: uncalibrated.rectifyPoint((1, 2)),
        "the camera is not calibrated": lambda: uncalibrated.fovX(),
        "expected a sensor_msgs.msg.CameraInfo, got NoneType": lambda: empty.fromCameraInfo(None),  # type: ignore[arg-type]
        "has 3 coefficients; 4, 5, 8, 12 are understood": lambda: camera([1, 2, 3]),
        "has 14 coefficients": lambda: camera([0.1] * 14),
        "equidistant has 4 coefficients of distortion, not 5": lambda: camera([0] * 5, distortion_model="equidistant"),
        "the rectified image must be like the raw one": lambda: camera().rectifyImage(raw, raw[:10]),
        "has no baseline": lambda: StereoCameraModel().fromCameraInfo(info(), info()),
    }


@pytest.mark.parametrize("said", refusals())
def test_refusals_are_one_line(said: str) -> None:
    with pytest.raises(ImageError) as caught:
        refusals()[said]()
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_without_a_rotation_there_is_none() -> None:
    assert_allclose(
        camera(r=np.zeros(9)).rectifyPoint((50, 60)), camera(r=np.eye(3).reshape(-1)).rectifyPoint((50, 60))
    )


def test_where_no_ray_comes_through_the_lens() -> None:
    assert np.isnan(camera([-0.5, 0.0, 0.0, 0.0]).rectifyPoint((5000, 5000))).all()


def test_without_opencv(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    model = camera(LENSES["plumb_bob"])
    assert np.isfinite(model.rectifyPoint((10, 10))).all()
    with pytest.raises(ImageError, match="rectifying an image needs OpenCV, which is not installed"):
        model.rectifyImage(np.zeros((480, 640), np.uint8))
