"""OpenCV that is missing, broken, old or new: one line that tells what to install."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from robolink.image.codecs import decoded, encoded
from robolink.image.encodings import ImageError
from robolink.image.opencv import lacking, opencv


def importing(monkeypatch: pytest.MonkeyPatch, error: Exception) -> None:
    def fail(_: str) -> Any:
        raise error

    monkeypatch.setattr(importlib, "import_module", fail)


def refusal() -> str:
    with pytest.raises(ImageError) as caught:
        opencv("JPEG")
    return str(caught.value)


def test_it_is_there() -> None:
    assert opencv("JPEG") is cv2


def test_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    importing(monkeypatch, ModuleNotFoundError("No module named 'cv2'", name="cv2"))
    assert refusal() == "JPEG needs OpenCV, which is not installed: pip install opencv-python"


@pytest.mark.parametrize(
    "error",
    [
        ImportError("libGL.so.1: cannot open shared object file:\n No such file or directory"),
        ModuleNotFoundError("No module named 'numpy.core.multiarray'", name="numpy.core.multiarray"),
        ImportError("numpy.core.multiarray failed to import"),
        AttributeError("_ARRAY_API not found"),
    ],
)
def test_broken(monkeypatch: pytest.MonkeyPatch, error: Exception) -> None:
    importing(monkeypatch, error)
    said = refusal()
    assert said.startswith("JPEG needs OpenCV, which is installed but cannot be loaded (")
    assert said.endswith("pip install -U opencv-python-headless")
    assert "\n" not in said


@pytest.mark.parametrize("version", ["3.4.18", "4.7.0", "2", "unknown", None])
def test_too_old(monkeypatch: pytest.MonkeyPatch, version: str | None) -> None:
    monkeypatch.setitem(sys.modules, "cv2", SimpleNamespace(**({} if version is None else {"__version__": version})))
    found = "some other cv2" if version is None else version
    assert refusal() == f"JPEG needs OpenCV 4.8 to 5, and {found} is installed: pip install opencv-python"


@pytest.mark.parametrize("version", ["4.8.0", "4.14.0.94", "5.0.0", "5.1.0-dev"])
def test_new_enough(monkeypatch: pytest.MonkeyPatch, version: str) -> None:
    monkeypatch.setitem(sys.modules, "cv2", SimpleNamespace(__version__=version))
    assert opencv("JPEG").__version__ == version


def test_a_programs_failed_import_names_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(ImportError) as caught:
        import cv2  # noqa: F401
    words = "test_opencv.py needs OpenCV, which is not installed: pip install opencv-python"
    assert str(lacking(caught.value)) == words
    assert str(lacking(ModuleNotFoundError("No module named 'cv2.aruco'", name="cv2.aruco"))) == words.replace(
        "test_opencv.py", "this program"
    )


def test_one_that_is_built_for_another_numpy_is_no_fault_of_the_program(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Such an OpenCV fails in its own file, by an error that does not name it."""
    (tmp_path / "cv2.py").write_text("raise ImportError('numpy.core.multiarray failed to import')\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "cv2")
    with pytest.raises(ImportError) as caught:
        import cv2  # noqa: F401
    said = str(lacking(caught.value))
    assert said.startswith(
        "test_opencv.py needs OpenCV, which is installed but cannot be loaded (numpy.core.multiarray"
    )


def test_other_failures_are_not_opencvs() -> None:
    for each in (ImportError("No module named 'six'", name="six"), ImportError(), KeyError("cv2")):
        assert lacking(each) is None
    assert lacking(ImportError("cannot import name 'Cascade'", name="cv2")) is None  # it can be imported


@pytest.mark.parametrize(("shape", "name"), [((5, 7), "mono"), ((5, 7, 3), "bgr"), ((5, 7, 4), "bgra")])
@pytest.mark.parametrize("kind", ["uint8", "uint16"])
def test_png_keeps_every_bit(shape: tuple[int, ...], name: str, kind: str) -> None:
    image = np.random.default_rng(2).integers(0, np.iinfo(kind).max, shape, kind)
    again, encoding = decoded(np.frombuffer(encoded(image, "png"), np.uint8))
    assert_array_equal(again, image)
    assert encoding == f"{name}{8 * image.itemsize}"


@pytest.mark.parametrize(
    "data", [b"", b"no picture", b"\x89PNG\r\n\x1a\n", encoded(np.zeros((9, 9, 3), np.uint8), "png")[:40]]
)
def test_broken_pictures_are_one_line(data: bytes) -> None:
    with pytest.raises(ImageError) as caught:
        decoded(np.frombuffer(data, np.uint8))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("shape", "form"), [((5, 7, 2), "jpg"), ((5, 7), "docx"), ((0, 0), "png"), ((5, 7), "")])
def test_what_no_file_can_hold_is_one_line(shape: tuple[int, ...], form: str) -> None:
    with pytest.raises(ImageError) as caught:
        encoded(np.zeros(shape, np.uint8), form)
    assert "\n" not in str(caught.value)
