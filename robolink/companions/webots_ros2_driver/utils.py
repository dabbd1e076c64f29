"""Functions about where Webots runs (`webots_ros2_driver.utils`), which launch files ask: here, and without Webots."""

from __future__ import annotations


def controller_protocol() -> str:
    """Return the protocol between a driver and Webots on the same machine."""
    return "ipc"


def controller_ip_address() -> str:
    """Return no address: the world is found by discovery."""
    return ""


def controller_url_prefix(port: str = "1234") -> str:
    """Return the beginning of WEBOTS_CONTROLLER_URL, which the robot's name follows; `port` is the one of Webots."""
    return f"{controller_protocol()}://{port}/"


def get_webots_home(show_warning: bool = False) -> None:
    """Return None: there is no folder of Webots; `show_warning` is of no effect."""


def is_wsl() -> bool:
    """Return False: nothing depends on it here."""
    return False


def is_docker() -> bool:
    """Return False: nothing depends on it here."""
    return False


def has_shared_folder() -> bool:
    """Return False: worlds are read where they are."""
    return False
