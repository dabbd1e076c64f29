"""The browser of the person at the screen, where there is one."""

from __future__ import annotations

import os
import sys
import webbrowser


def open_in_browser(address: str) -> bool:
    """Open an address in the browser; False where there is no screen, or no browser."""
    is_remote = sys.platform not in ("win32", "darwin") and not (
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )
    return not is_remote and webbrowser.open(address)
