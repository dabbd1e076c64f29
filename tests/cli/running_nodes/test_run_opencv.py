"""robolink run and OpenCV: programs that show images go on without a screen, and learn what to install."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.support.started import Write, outcome

SHOWS = """
import cv2, numpy, sys
loader = type(cv2.__loader__).__name__, type(cv2.__spec__.loader).__name__
cv2.imshow("a", numpy.zeros((3, 3, 3), numpy.uint8))
print(loader, cv2.waitKey(1), cv2.aruco.DICT_4X4_50, flush=True)
cv2.destroyAllWindows()
"""


@pytest.mark.processes
def test_a_program_that_shows_images_goes_on(write: Write) -> None:
    code, out, err = outcome("run", str(write("show.py", SHOWS)))
    assert (code, out) == (0, "('SourceFileLoader', 'SourceFileLoader') -1 0\n")
    assert err.count("\n") == 1
    assert "cv2.imshow: no windows (opencv-python-headless has none). The program goes on" in err


@pytest.mark.processes
def test_without_opencv_a_line_says_what_to_install(write: Write) -> None:
    text = """
import sys
class Hides:
    def find_spec(self, name, path=None, target=None):
        if name == "cv2":
            raise ModuleNotFoundError("No module named 'cv2'", name="cv2")
sys.meta_path.insert(0, Hides())
import cv2
"""
    code, _, err = outcome("run", str(write("lacks.py", text)))
    assert code == 1
    assert err.splitlines() == [
        "robolink: lacks.py needs OpenCV, which is not installed: pip install opencv-python",
    ]


@pytest.mark.processes
def test_python_itself_is_left_alone(write: Write) -> None:
    text = "import robolink.compat, rclpy, cv2\nprint(cv2.imshow.__module__, type(cv2.imshow).__name__)\n"
    done = subprocess.run([sys.executable, str(write("p.py", text))], capture_output=True, text=True, check=True)
    assert "builtin_function_or_method" in done.stdout
