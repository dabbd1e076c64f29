"""robolink view: a page in the browser that shows a running system, and Foxglove's protocol on the same port."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared.options import Enclave
from robolink.cli.shared.output import tell
from robolink.cli.shared.page import announce, end_with_the_terminal
from robolink.extensions.optional import check_page

if TYPE_CHECKING:
    from robolink.view.server import Settings

SHORT = 16
"""Letters of a token from which on nobody guesses it."""

app = typer.Typer(help="Show a running system, or a bag, in the browser.")

PANELS = (
    "world", "topics", "plot", "log", "teleop", "services", "parameters", "images", "graph", "actions",
    "turtlesim", "learn",
)  # fmt: skip
"""Names of the page's panels, as `page/layouts.js` has them."""


def _checked_panels(names: str) -> str:
    from robolink.exceptions import nearest

    for each in names.split("+") if names else ():
        if each not in PANELS:
            raise typer.BadParameter(f"no panel '{each[:50]}'{nearest(each[:50], PANELS)}: {', '.join(PANELS)}")
    return names


@app.command("view")
def view(
    port: Annotated[
        int | None,
        typer.Option("--port", metavar="PORT", min=0, max=65535, help="Port; by default 8765 or the next free one."),
    ] = None,
    host: Annotated[
        str, typer.Option("--host", metavar="ADDRESS", help="Address to listen on; 0.0.0.0 opens it to the network.")
    ] = "127.0.0.1",
    browser: Annotated[bool, typer.Option(help="Open the page in the browser.")] = True,
    read_only: Annotated[
        bool, typer.Option("--read-only", help="Do not let anybody publish, call services or set parameters.")
    ] = False,
    bag: Annotated[
        Path | None, typer.Option("--bag", metavar="FILE", help="Show this bag instead of a running system.")
    ] = None,
    panels: Annotated[
        str, typer.Option("--panels", metavar="NAME+NAME", help="Panels to open.", callback=_checked_panels)
    ] = "",
    token: Annotated[
        str,
        typer.Option("--token", metavar="TEXT", help="Secret token in the address; a new one each time by default."),
    ] = "",
    enclave: Enclave = "",
) -> None:
    """Show a running system, or a bag, in the browser: the world from above, topics, plots, images, logs, parameters.

    Foxglove, Lichtblick and PlotJuggler connect to the same port, by ws://localhost:8765.
    """
    check_page()
    from robolink.view.server import Settings

    end_with_the_terminal()
    if token and len(token) < SHORT:
        tell(f"--token is {len(token)} letters: who guesses it may drive; {SHORT} or more are hard to guess")
    settings = Settings(host, port, token, read_only)
    if bag is not None:
        _show_bag(bag, settings, browser, panels)
    else:
        show_system(settings, browser, enclave, panels)


def show_system(settings: Settings, browser: bool, enclave: str = "", panels: str = "") -> None:
    """Serve the page of the running system until Ctrl-C.

    Args:
        settings: Where and for whom.
        browser: True opens the page.
        enclave: Enclave whose keys it has.
        panels: Names of panels to begin with, parted by ``+``; '' leaves it to the browser's memory.
    """
    from robolink.cli.shared.session import node_of, opened
    from robolink.view.server import View
    from robolink.view.sources.live import LiveSource

    with opened(enclave) as context, View(LiveSource(node_of(context)), settings) as server:
        announce(server, browser, panels)
        context.graph.wait_for(lambda: not context.ok(), None)


def _show_bag(path: Path, settings: Settings, browser: bool, panels: str) -> None:
    from robolink.bag.reader import open_bag
    from robolink.cli.shared.session import opened
    from robolink.view.server import View
    from robolink.view.sources.bag import BagSource

    with open_bag(path) as bag, opened() as context, View(BagSource(bag), settings) as server:
        announce(server, browser, panels)
        context.graph.wait_for(lambda: not context.ok(), None)
