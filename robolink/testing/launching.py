"""Reads a launch file for a test: with arguments, and with parameters that the test sets."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.simulating.settings import with_parameters
from robolink.workspace import find_launch, find_node
from robolink.yamlfile import spell

if TYPE_CHECKING:
    from robolink.launch import Entry
    from robolink.testing.stage import Wanted


def read(file: str | PathLike[str], arguments: Mapping[str, Any], values: Mapping[str, Any]) -> list[Entry]:
    """Give what a launch file says; `values` are parameters as ``{"wall_follower.speed": 0.2}``.

    Raises NotFoundError for a file, node or argument that is not there, and DocumentError.
    """
    from robolink.launch import read_launch_file

    given = {name: value if isinstance(value, str) else spell(value) for name, value in arguments.items()}
    return with_parameters(read_launch_file(find_launch(fspath(file)), given), values)


def entry_of(spec: str, wanted: Wanted) -> list[Entry]:
    """Give the entry for one node, as if a launch file said this of it. Raises NotFoundError, with the nearest name."""
    from robolink.launch import read_launch_file

    source = find_node(spec)
    words = {key: value for key, value in wanted._asdict().items() if key != "what" and value}
    text = json.dumps({"nodes": [{"node": source.spec, **words}]})
    return read_launch_file(Path("test"), {}, text=text)
