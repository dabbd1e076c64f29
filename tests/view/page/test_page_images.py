"""The images panel: raw encodings pixel by pixel, compressed images, and the newest only."""

from __future__ import annotations

import base64
import struct
import zlib
from typing import Any

import pytest

from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.qos import DurabilityPolicy, QoSProfile
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
RAW: dict[str, tuple[bytes, list[int]]] = {
    "rgb8": (bytes((10, 20, 30, 40, 50, 60)), [10, 20, 30, 255, 40, 50, 60, 255]),
    "bgr8": (bytes((10, 20, 30, 40, 50, 60)), [30, 20, 10, 255, 60, 50, 40, 255]),
    "rgba8": (bytes((1, 2, 3, 255, 4, 5, 6, 255)), [1, 2, 3, 255, 4, 5, 6, 255]),
    "bgra8": (bytes((1, 2, 3, 255, 4, 5, 6, 255)), [3, 2, 1, 255, 6, 5, 4, 255]),
    "mono8": (bytes((7, 200)), [7, 7, 7, 255, 200, 200, 200, 255]),
    "16UC1": (struct.pack("<HH", 1000, 3000), [0, 0, 0, 255, 255, 255, 255, 255]),
    "32FC1": (struct.pack("<ff", 2.0, float("nan")), [0, 0, 0, 255, 0, 0, 60, 255]),
    "yuv422": (bytes((128, 16, 128, 235)), [0, 0, 0, 255, 255, 255, 255, 255]),
    "yuv422_yuy2": (bytes((16, 128, 235, 128)), [0, 0, 0, 255, 255, 255, 255, 255]),
}
"""Two pixels of each encoding, and what they are as RGBA."""

pytestmark = [pytest.mark.processes, needs_chromium]


def image(encoding: str, data: bytes, width: int = 2, height: int = 1) -> Image:
    return Image(encoding=encoding, width=width, height=height, step=len(data) // height, data=data)


def shown(page: Page, width: int, height: int = 1) -> Any:
    """The canvas's pixels."""
    context = "document.querySelector('canvas.image').getContext('2d')"
    return page.browser.js(f"Array.from({context}.getImageData(0, 0, {width}, {height}).data)")


def png(width: int, height: int, rgb: bytes) -> bytes:
    """A PNG of one colour."""
    rows = (b"\0" + rgb * width) * height
    parts = (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows)),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in parts
    )


def test_raw_images_are_shown_pixel_by_pixel(browser: Browser) -> None:
    with opened(browser, "images") as page:
        publisher = page.node.create_publisher(Image, "camera/image_raw", LATCHED)
        for encoding, (data, wanted) in RAW.items():
            publisher.publish(image(encoding, data))
            browser.wait(f"document.querySelector('.panel-images .state').textContent.startsWith('2x1  {encoding} ')")
            assert shown(page, 2) == wanted, encoding
        red = bytes(((255, 0) * 32 + (0, 0) * 32) * 32)  # rggb: red only
        publisher.publish(image("bayer_rggb8", red, 64, 64))
        browser.wait("document.querySelector('.panel-images .state').textContent.includes('bayer')")
        assert shown(page, 2, 2) == [255, 0, 0, 255] * 4
        gradient = bytes(v for y in range(120) for x in range(160) for v in (x, y, 128))
        publisher.publish(image("rgb8", gradient, 160, 120))
        browser.wait("document.querySelector('.panel-images .state').textContent.startsWith('160x120  rgb8')")
        page.picture("images")


def test_what_cannot_be_shown_is_told(browser: Browser) -> None:
    with opened(browser, "images") as page:
        publisher = page.node.create_publisher(Image, "camera/image_raw", LATCHED)
        state = "document.querySelector('.panel-images .state').textContent"
        for made, told in (
            (image("secret", b"12"), "encoding 'secret' is not known"),
            (Image(encoding="rgb8", width=100, height=100, step=300, data=b"123"), "100x100 rgb8 with step 300"),
        ):
            publisher.publish(made)
            browser.wait(f'{state}.includes("{told}")')
        publisher.publish(image(*("mono8", b"\1\2")))
        browser.wait(f"{state}.startsWith('2x1')")


def test_compressed_images_are_read_by_the_browser(browser: Browser) -> None:
    with opened(browser, "images") as page:
        publisher = page.node.create_publisher(CompressedImage, "camera/compressed", LATCHED)
        publisher.publish(CompressedImage(format="png", data=png(30, 20, b"\x10\x80\xf0")))
        browser.wait("document.querySelector('.panel-images .state').textContent.startsWith('30x20  png')")
        assert shown(page, 1) == [16, 128, 240, 255]
        page.picture("images_compressed")
        publisher.publish(CompressedImage(format="jpeg", data=base64.b64decode("AAAA")))
        browser.wait("document.querySelector('.panel-images .state').textContent.includes('cannot read')")
