"""Programs of rviz2 and rqt by their own names: each opens the page of `robolink view` with the right panels."""

from __future__ import annotations

import contextlib
import sys

import robolink
from robolink.cli.shared.output import tell
from robolink.exceptions import ExternalShutdownException
from robolink.extensions.optional import check_page
from robolink.running.timebase import VirtualTime
from robolink.utilities import get_default_context, remove_ros_args


def rviz2() -> None:
    """Show robots, maps, scans and images; a configuration of rviz (`-d FILE`) is not read."""
    _show("rviz2", "world+topics")


def rqt() -> None:
    """Show topics, plots, logs, services and parameters."""
    _show("rqt", "topics+plot+log+services+parameters")


def rqt_graph() -> None:
    """Show which node publishes what for whom."""
    _show("rqt_graph", "graph")


def rqt_plot() -> None:
    """Plot values over time: a click on a number of a topic adds it."""
    _show("rqt_plot", "plot+topics")


def rqt_console() -> None:
    """Show what nodes log."""
    _show("rqt_console", "log")


def rqt_image_view() -> None:
    """Show what cameras publish."""
    _show("rqt_image_view", "images")


def rqt_topic() -> None:
    """Show the topics and their messages, and publish some."""
    _show("rqt_topic", "topics")


def rqt_service_caller() -> None:
    """Call services."""
    _show("rqt_service_caller", "services")


def rqt_reconfigure() -> None:
    """Show and set parameters."""
    _show("rqt_reconfigure", "parameters")


def rqt_robot_steering() -> None:
    """Drive a robot."""
    _show("rqt_robot_steering", "teleop")


def _show(program: str, panels: str) -> None:
    """Serve the page until Ctrl-C, and open it; in virtual time nobody looks, and it only waits for its end."""
    check_page()
    from robolink.cli.view import show_system
    from robolink.view.server import Settings

    if isinstance(get_default_context().time, VirtualTime):
        with robolink.init(), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
            robolink.get_global_executor().spin()
        return
    words = remove_ros_args(sys.argv)[1:]
    if words:
        tell(f"{program}: its own arguments are not read here: {' '.join(words)}")
    show_system(Settings("127.0.0.1", None, "", False), browser=True, panels=panels)
