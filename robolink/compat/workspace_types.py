"""Import of the interface types of a workspace: the one in which the file that imports them lies, or the user's."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import FrameType

from robolink.compat.maker import TOPS
from robolink.interfaces import KINDS
from robolink.workspace import workspace_of
from robolink.workspace.interfaces import WORKSPACE_TYPES, interface_module, use_interfaces
from robolink.workspace.modules import FINDER, Fill

_OWN = str(Path(__file__).parents[1]) + os.sep
_IMPORTERS = ("<frozen importlib", "<frozen zipimport")


def workspace_types(fullname: str) -> Fill | None:
    """Return the function that fills the module `fullname`, `my_msgs` or `my_msgs.msg`; None if no workspace has it.

    Workspaces are read when a name is asked for that nobody else has, so that imports stay fast.
    """
    top, dot, kind = fullname.partition(".")
    if top in TOPS or top in sys.stdlib_module_names or (dot and kind not in KINDS):
        return None
    real = None if dot else FINDER.real(top)
    if real is not None and real.loader is not None:  # a folder that is not a package has none
        return None
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
