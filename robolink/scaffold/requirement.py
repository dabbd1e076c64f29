"""Requirement of a new project on robolink, by where this robolink was installed from (PEP 610)."""

from __future__ import annotations

import json
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import urlsplit
from urllib.request import url2pathname

WHEELS = "wheels"
"""Folder of a project that has robolink's wheel, where no index has it."""


class Requirement(NamedTuple):
    """Requirement on robolink that can be met on this machine, on others, and in CI."""

    line: str
    """Line of requirements.txt."""
    note: str = ""
    """Comment on it, and a sentence of the README."""
    step: str = ""
    """Command that has to be typed before; '' if there is none."""
    wheel: Path | None = None
    """Wheel that belongs into the project."""


def requirement() -> Requirement:
    """Return the requirement by which a project gets the robolink that made it."""
    found = metadata.distribution("robolink")
    return required(json.loads(found.read_text("direct_url.json") or "{}"), found.version)


def required(origin: dict[str, Any], version: str) -> Requirement:
    """Return the requirement by which a project gets a robolink.

    Args:
        origin: Content of its direct_url.json; empty if it came from a package index.
        version: Its version.
    """
    url = str(origin.get("url", ""))
    if not url:
        return Requirement("robolink[test]")
    if "vcs_info" in origin:
        vcs = origin["vcs_info"]
        return Requirement(f"robolink[test] @ {vcs['vcs']}+{url}@{vcs['commit_id']}")
    if urlsplit(url).scheme != "file":
        return Requirement(f"robolink[test] @ {url}")
    path = Path(url2pathname(urlsplit(url).path))
    if "dir_info" not in origin and path.suffix == ".whl":
        kept, step = path.name, "" if path.is_file() else f"cp PATH/OF/{path.name} {WHEELS}/"
    else:
        kept = f"robolink-{version}-py3-none-any.whl"
        step = f'pip wheel --no-deps --wheel-dir {WHEELS} "{path if path.exists() else "PATH/OF/THE/CLONE"}"'
    note = f"robolink is on no package index yet: its wheel, in {WHEELS}/, belongs into the repository, for CI too."
    return Requirement(f"./{WHEELS}/{kept}[test]", note, step, path if not step else None)
