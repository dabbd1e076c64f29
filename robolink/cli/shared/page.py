"""Announcement of the page of `robolink view`: its address, who else can open it, the browser; and its end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.cli.shared.output import say, tell

if TYPE_CHECKING:
    from robolink.extensions.optional import Page

PORT = 8765
"""Default port of the page; its own module is not imported for a line."""


def announce(server: Page, browser: bool, panels: str) -> None:
    """Print the address of the page, with who else can open it, and open it.

    Args:
        server: Its server.
        browser: True opens it in the browser.
        panels: Names of panels to begin with, parted by ``+``; '' leaves it to the browser's memory.
    """
    # Before it is printed: a Ctrl-C that comes in an import may leave a lock of Python's behind, for which the server's
    # threads, which import as well, would wait for ever.
    from robolink.system.terminal import open_in_browser, ssh_tunnel

    address = f"{server.address}#{panels}" if panels else server.address
    say(f"robolink view: {address}")
    if server.exposed:
        import socket

        others = f"http://{socket.gethostname()}:{server.port}/?{address.partition('?')[2]}"
        tell(f"others on the network open {others}: whoever has the token can drive the robots")
        tell("the connection is not encrypted: who listens on the network can read the token (docs/reference/view.md)")
    if browser and not open_in_browser(address) and (tunnel := ssh_tunnel(server.port)):
        tell(f"no browser here: `{tunnel}` on your own computer, and the address above opens there")


def where_to_look() -> str:
    """Return a line about where a system is seen from a terminal without a browser; '' if there is one, or no page."""
    from robolink.extensions import optional
    from robolink.system.terminal import has_screen, ssh_tunnel

    if has_screen() or not optional.is_here(optional.PAGE):
        return ""
    tunnel = ssh_tunnel(PORT)
    there = f", and on your own computer `{tunnel}`" if tunnel else ""
    return f"no browser here: to see the system, `robolink view` in another shell{there}"


def end_with_the_terminal() -> None:
    """Take the terminal's end for Ctrl-C's sibling SIGTERM: a server that is just gone stops no robot."""
    import signal
    import sys

    if sys.platform != "win32" and signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        signal.signal(signal.SIGHUP, lambda number, frame: signal.raise_signal(signal.SIGTERM))
