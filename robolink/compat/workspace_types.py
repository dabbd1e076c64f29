"""Import of interface types: of the workspace of the file that imports them, of the user's, of an installed package."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import FrameType

from robolink.compat.maker import TOPS, room_fill
from robolink.interfaces import KINDS
from robolink.interfaces.standard import INTERFACES
from robolink.workspace import workspace_of
from robolink.workspace.interfaces import WORKSPACE_TYPES, interface_module, use_interfaces
from robolink.workspace.modules import FINDER, Fill

_OWN = str(Path(__file__).parents[1]) + os.sep
_IMPORTERS = ("<frozen importlib", "<frozen zipimport")


def workspace_types(fullname: str) -> Fill | None:
    """Return the function that fills the module `fullname`, `my_msgs` or `my_msgs.msg`; None if nobody has it.

    Workspaces and entry points are read for a name that is installed nowhere, so that imports stay fast.
    """
    top, dot, inner = fullname.partition(".")
    kind, _, private = inner.partition(".")
    if top in TOPS or top in sys.stdlib_module_names or (dot and kind not in KINDS):
        return None
    real = None if dot else FINDER.real(top)
    if real is not None and real.loader is not None:  # a folder that is not a package has none
        return None
    fill = None if private else _of_workspace(fullname)
    if fill is None and top in INTERFACES.added():  # last: reading entry points takes ten milliseconds
        return room_fill(fullname)
    return fill


def _of_workspace(fullname: str) -> Fill | None:
    file = _importing_file()
    home = None if file is None else workspace_of(file.parent)
    with WORKSPACE_TYPES.forgetting():
        if home is not None:
            WORKSPACE_TYPES.add(home)
        fill = interface_module(fullname)
    if fill is not None:
        use_interfaces(home)
    return fill


def _importing_file() -> Path | None:
    """Return the file whose code imports at this moment; None for code that is in no file."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename.startswith((_OWN, *_IMPORTERS)):
        frame = frame.f_back
    if frame is None or not Path(frame.f_code.co_filename).is_file():
        return None
    return Path(frame.f_code.co_filename)
