"""Reading of launch files for tests: with arguments, and with parameters that the test sets."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.documents.yamlfile import spell
from robolink.logging import get_logger
from robolink.simulate.settings import with_settings
from robolink.workspace import find_launch, find_node, two_words

if TYPE_CHECKING:
    from robolink.launch import Entry
    from robolink.launch.entry import System as LaunchSystem
    from robolink.testing.stage import NodeRequest


def read(file: str | PathLike[str], arguments: Mapping[str, Any], values: Mapping[str, Any]) -> LaunchSystem:
    """Read a launch file; `values` are parameters as ``{"wall_follower.speed": 0.2}``.

    Raises NotFoundError for a file, node or argument that does not exist, and DocumentError for a mistake in the file.
    """
    from robolink.launch.system import read_system

    given = {name: value if isinstance(value, str) else spell(value) for name, value in arguments.items()}
    path = _found(fspath(file))
    system = read_system(path, given)
    for note in system.notes:
        get_logger("robolink.testing").warning(note)
    return with_settings(system, values, lambda: read_system(path, given, foresee=True).entries)


def _found(file: str) -> Path:
    """Find a launch file by its path or name, or by a package and a name in it, as in ``my_robot bot.launch.py``."""
    from robolink.launch.lookup import find

    words = file.split()
    return find(words) if len(words) == 2 and not Path(file).exists() else find_launch(file)


def entry_of(spec: str, request: NodeRequest) -> list[Entry]:
    """Return the launch entry of one node, as if a launch file had it. Raises NotFoundError, with the nearest name."""
    from robolink.launch import read_launch_file

    source = find_node(spec)
    words = {key: value for key, value in request._asdict().items() if key != "what" and value}
    node = (
        spec if two_words(spec)[1] and not source.spec.endswith(spec) else source.spec
    )  # it has its executable's name
    text = json.dumps({"nodes": [{"node": node, **words}]})
    return read_launch_file(Path("test"), {}, text=text)
