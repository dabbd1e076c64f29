"""The header on a phone: whatever it has to tell, STOP stays in reach."""

from __future__ import annotations

import pytest

from tests.support.browser import Browser, needs_chromium
from tests.support.pages import opened

pytestmark = [pytest.mark.processes, needs_chromium]

TOLD = '{state: "on", path: "x", seconds: 86_399, bytes: 999e9, messages: 1e9, dropped: 123_456_789}'


@pytest.mark.parametrize("language", ["en", "pt"])
@pytest.mark.parametrize("width", [320, 390])
def test_stop_stays_in_reach_whatever_the_header_tells(browser: Browser, language: str, width: int) -> None:
    browser.resize(width, 700, phone=True)
    try:
        with opened(browser, "world", settings={"language": language, "theme": "light"}) as page:
            inside = f"document.getElementById('stop').getBoundingClientRect().right <= {width}"
            browser.js(f"robolink.connection.emit('recording', {TOLD})")
            page.picture(f"phone_recording_{language}_{width}")
            assert browser.js(inside)
            browser.js("robolink.connection.open = () => {}; robolink.connection._socket.close()")
            browser.wait("document.getElementById('state').className === 'bad'")
            page.picture(f"phone_lost_{language}_{width}")
            assert browser.js(inside)
            assert browser.js("document.documentElement.scrollWidth") <= width
    finally:
        browser.resize(1280, 720)
