"""Headless Chromium for tests of the page, driven over its DevTools protocol as a person would: click, type, drag."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

NAMES = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-extensions",
    "--disable-dev-shm-usage",
    "--force-device-scale-factor=1",
    "--lang=en-US",
    "--remote-debugging-port=0",
)
PATIENCE = 20.0
KEYS = {
    "Enter": ("Enter", 13, "\r"),
    "Escape": ("Escape", 27, ""),
    "Tab": ("Tab", 9, ""),
    "End": ("End", 35, ""),
    "Delete": ("Delete", 46, ""),
    " ": ("Space", 32, " "),
    "ArrowUp": ("ArrowUp", 38, ""),
    "ArrowDown": ("ArrowDown", 40, ""),
    "ArrowLeft": ("ArrowLeft", 37, ""),
    "ArrowRight": ("ArrowRight", 39, ""),
}
"""Code, number and text of keys that are no letters."""

DRAG = """(start, end) => {
  const [from, to] = [start, end].map((each) => document.querySelector(each)), dataTransfer = new DataTransfer();
  const fire = (at, name) => at.dispatchEvent(new DragEvent(name, {bubbles: true, cancelable: true, dataTransfer}));
  fire(from, "dragstart"); fire(to, "dragenter"); fire(to, "dragover"); fire(to, "drop"); fire(from, "dragend");
}"""
"""A drag with data: DevTools' own mouse cannot do it without a screen."""

CHOOSE = """(selector, value) => {
  const menu = document.querySelector(selector);
  menu.blur(); menu.value = value; menu.dispatchEvent(new Event("input")); menu.dispatchEvent(new Event("change"));
}"""
"""A choice in a menu, which Chromium draws outside of the page."""

chromium = next((found for name in NAMES if (found := shutil.which(name))), None)
needs_chromium = pytest.mark.skipif(chromium is None, reason="chromium is not installed: apt-get install chromium")


class PageError(AssertionError):
    """An exception in the page, or a condition that did not come true."""


class Browser:
    """One browser with one page. `problems` has what its console told as an error."""

    def __init__(self, width: int = 1280, height: int = 720) -> None:
        assert chromium is not None
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self._process = subprocess.Popen(
            [
                chromium,
                *FLAGS,
                f"--user-data-dir={self._folder.name}",
                f"--window-size={width},{height}",
                "about:blank",
            ],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        self._number = 0
        self.problems: list[str] = []
        self._socket = self._connect()
        self.call("Page.enable")
        self.call("Runtime.enable")
        self.call("Log.enable")
        self.resize(width, height)

    def _connect(self) -> ClientConnection:
        file = Path(self._folder.name) / "DevToolsActivePort"
        _until(lambda: file.exists() and len(file.read_text(encoding="utf-8").split()) > 1, "chromium opens its port")
        port = file.read_text(encoding="utf-8").split()[0]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=PATIENCE) as answer:
            pages = json.load(answer)
        address = next(each["webSocketDebuggerUrl"] for each in pages if each["type"] == "page")
        return connect(address, max_size=None, compression=None).__enter__()

    def __enter__(self) -> Browser:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the browser and all of its processes."""
        try:
            self.call("Browser.close")
        except (OSError, EOFError, TimeoutError, RuntimeError):
            self._process.kill()
        self._socket.close()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._folder.cleanup()

    @property
    def pid(self) -> int:
        return self._process.pid

    def call(self, method: str, **params: Any) -> Any:
        """Call a method of the protocol and return its result."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": params}))
        while True:
            message = json.loads(self._socket.recv(PATIENCE))
            if message.get("id") == self._number:
                if "error" in message:
                    raise PageError(f"{method}: {message['error']}")
                return message["result"]
            self._event(message)

    def _event(self, message: dict[str, Any]) -> None:
        params = message.get("params", {})
        if message.get("method") == "Runtime.exceptionThrown":
            told = params["exceptionDetails"]
            self.problems.append(told.get("exception", {}).get("description", told["text"]))
        elif message.get("method") == "Runtime.consoleAPICalled" and params["type"] == "error":
            self.problems.append(" ".join(str(each.get("description", each.get("value"))) for each in params["args"]))
        elif message.get("method") == "Log.entryAdded" and params["entry"]["level"] == "error":
            told = f"{params['entry']['text']} {params['entry'].get('url', '')}"
            if "favicon.ico" not in told:  # which Chromium asks for beside a file that is not a page
                self.problems.append(told)

    def open(self, address: str) -> None:
        """Go to an address."""
        self.call("Page.navigate", url=address)

    def resize(self, width: int, height: int, *, phone: bool = False) -> None:
        """Set the size of the page; with `phone`, a finger is the pointer."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)

    def js(self, text: str) -> Any:
        """Evaluate JavaScript in the page, and return its value."""
        answer = self.call("Runtime.evaluate", expression=text, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            told = answer["exceptionDetails"]
            raise PageError(f"{text}: {told.get('exception', {}).get('description', told['text'])}")
        return answer["result"].get("value")

    def wait(self, text: str, patience: float = PATIENCE) -> Any:
        """Wait until JavaScript is true, and return its value; True for any object.

        Raises PageError with the console's errors.
        """
        found: Any = None

        def true() -> bool:
            nonlocal found
            found = self.js(f"((value) => (value instanceof Object ? true : value))({text})")
            return bool(found)

        try:
            _until(true, text, patience)
        except PageError as error:
            raise PageError(f"{error}; console: {self.problems}") from None
        return found

    def place(self, selector: str) -> tuple[float, float]:
        """The middle of the first element that a CSS selector finds, once it is there."""
        quoted = json.dumps(selector)
        self.wait(f"!!document.querySelector({quoted})?.getClientRects().length")
        found = self.js(
            f"(() => {{ const e = document.querySelector({quoted}); e.scrollIntoView({{block: 'nearest'}});"
            " const r = e.getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 2]; })()"
        )
        return found[0], found[1]

    def click(self, at: str | tuple[float, float], count: int = 1) -> None:
        """Click an element, by its CSS selector, or a place."""
        x, y = self.place(at) if isinstance(at, str) else at
        self._mouse("mouseMoved", x, y)
        self._mouse("mousePressed", x, y, button="left", buttons=1, clickCount=count)
        self._mouse("mouseReleased", x, y, button="left", clickCount=count)

    def move(self, at: str | tuple[float, float]) -> None:
        """Move the mouse to an element or a place."""
        x, y = self.place(at) if isinstance(at, str) else at
        self._mouse("mouseMoved", x, y)

    def drag(self, start: str | tuple[float, float], end: str | tuple[float, float], steps: int = 5) -> None:
        """Press the mouse at one place, and release it at another."""
        first, last = (self.place(each) if isinstance(each, str) else each for each in (start, end))
        self.grab(first, last, steps)
        self.let_go(last)

    def grab(self, start: tuple[float, float], end: tuple[float, float], steps: int = 5) -> None:
        """Press the mouse at one place, and move it to another with the button held."""
        (x, y), (to_x, to_y) = start, end
        self._mouse("mouseMoved", x, y)
        self._mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        for step in range(1, steps + 1):
            share = step / steps
            self._mouse("mouseMoved", x + (to_x - x) * share, y + (to_y - y) * share, button="left", buttons=1)

    def let_go(self, at: tuple[float, float]) -> None:
        """Release the mouse's button."""
        self._mouse("mouseReleased", *at, button="left", clickCount=1)

    def drag_data(self, start: str, end: str) -> None:
        """Drag what is draggable, with its data, and drop it on another element."""
        self.place(start)
        self.place(end)
        self.js(f"({DRAG})({json.dumps(start)}, {json.dumps(end)})")

    def choose(self, selector: str, value: str) -> None:
        """Choose an option of a select, once it is offered."""
        self.place(selector)
        options = f"[...document.querySelector({json.dumps(selector)}).options]"
        self.wait(f"{options}.some((each) => each.value === {json.dumps(value)})")
        self.js(f"({CHOOSE})({json.dumps(selector)}, {json.dumps(value)})")

    def wheel(self, at: str | tuple[float, float], turn: float) -> None:
        """Turn the mouse's wheel over an element or a place."""
        x, y = self.place(at) if isinstance(at, str) else at
        self._mouse("mouseWheel", x, y, deltaX=0, deltaY=turn)

    def touch(self, *fingers: tuple[float, float]) -> None:
        """Put fingers on the page, move them there, or with none take them away."""
        kind = "touchEnd" if not fingers else "touchMove" if getattr(self, "_touched", False) else "touchStart"
        self._touched = bool(fingers)
        points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(fingers)]
        self.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)

    def press(self, key: str, *, hold: bool = False) -> None:
        """Press a key: a letter, or a name such as Enter. With `hold` it stays down until `release`."""
        self._key("keyDown", key)
        if not hold:
            self.release(key)

    def release(self, key: str) -> None:
        """Let go of a key."""
        self._key("keyUp", key)

    def type(self, text: str) -> None:
        """Type a text where the keyboard is."""
        for letter in text:
            self.press(letter)

    def screenshot(self, file: Path) -> Path:
        """Write a picture of the page (PNG)."""
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))
        return file

    def _mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, pointerType="mouse", **more)

    def _key(self, kind: str, key: str) -> None:
        code, number, text = KEYS.get(key, (f"Key{key.upper()}", ord(key.upper()[0]) if key.isalnum() else 0, key))
        more = {"text": text} if kind == "keyDown" and text else {}
        self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code, windowsVirtualKeyCode=number, **more)


def _until(true: Callable[[], bool], what: str, patience: float = PATIENCE) -> None:
    """Wait until something is true: it is asked again and again, as there is nothing to be woken by."""
    end = time.monotonic() + patience
    while not true():
        if time.monotonic() > end:
            raise PageError(f"not within {patience:g} s: {what}")
        time.sleep(0.02)
