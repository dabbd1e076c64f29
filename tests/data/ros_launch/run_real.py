"""Runs one launch file with ROS 2's own launch, `python run_real.py FILE NAME:=VALUE...`; JSON goes to $RESULT."""

import json
import logging
import os
import sys
from pathlib import Path
from unittest.mock import MagicMock

try:
    import composition_interfaces.srv  # noqa: F401
except ModuleNotFoundError:  # no wheel has it; launch_ros imports it, and no description needs it
    sys.modules["composition_interfaces"] = sys.modules["composition_interfaces.srv"] = MagicMock()
    sys.modules["composition_interfaces"].srv = sys.modules["composition_interfaces.srv"]

import launch
import launch.logging
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource


class Heard(logging.Handler):
    """Keeps what a launch file logs, and errors."""

    def __init__(self):
        super().__init__()
        self.said, self.errors = [], []

    def emit(self, record):
        if record.name == "launch.user":
            self.said.append(record.getMessage())
        elif record.levelno >= logging.ERROR and record.name == "launch":
            self.errors.append(record.getMessage())


def main():
    heard = Heard()
    for name in ("launch.user", "launch"):
        launch.logging.get_logger(name).addHandler(heard)
    path, given = sys.argv[1], [tuple(each.split(":=", 1)) for each in sys.argv[2:]]
    service = launch.LaunchService(argv=sys.argv[2:], noninteractive=True)
    include = IncludeLaunchDescription(AnyLaunchDescriptionSource(path), launch_arguments=given)
    service.include_launch_description(launch.LaunchDescription([include]))
    code = service.run()
    with Path(os.environ["RESULT"]).open("w") as file:
        json.dump({"exit": code, "said": heard.said, "error": (heard.errors or [""])[-1]}, file)


main()
