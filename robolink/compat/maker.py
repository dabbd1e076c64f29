"""Factory of a module for each of ROS 2's names: robolink's own, put in its place; never a second copy of one."""

from __future__ import annotations

import functools
import importlib
import importlib.util
import re
import sys
from collections.abc import Callable, Iterable
from types import FunctionType, ModuleType
from typing import Any

from robolink.compat.names import ROOMS, instead_of, snake_case
from robolink.exceptions import closest
from robolink.interfaces import ACTION_PARTS, KINDS
from robolink.interfaces.standard import packages, set_home, types_of
from robolink.text.suggestions import LackingModuleError, lacking, names_in
from robolink.workspace.modules import FINDER, Fill, Filling

TYPES = "robolink.interfaces"
TOPS = frozenset({*packages(), *(name for name in ROOMS if "." not in name)})
"""The top-level names that are robolink's."""
ALIKE = 0.85
"""Similarity from 0 to 1, as `closest` computes it, above which an unknown name is a misspelt one of ROS 2's."""
LIBRARIES = frozenset(["java", "org", "typing_extensions"])
"""Names that libraries look for in vain, and that are nobody's: Jython's, and what msgspec takes if it is there."""
PARTS = ("Request", "Response", "Goal", "Result", "Feedback")
NEVER_A_CHECKOUT = frozenset(
    {
        *("cv_bridge", "launch", "launch_pytest", "launch_ros", "launch_testing", "launch_testing_ros", "launch_xml"),
        *("launch_yaml", "rclpy", "rosbag2_py", "rosidl_runtime_py", "tf2_py", "webots_ros2_driver"),
    }
)
"""Names that a folder of the user's own does not take: a clone of their repositories in a workspace cannot run here (it
needs compiled modules, classes of the others, or Webots), and many a package has a folder `launch/`."""


def hidden(fullname: str) -> bool:
    """True if a name is robolink's, whatever else is installed by it."""
    top, dot, _ = fullname.partition(".")
    if top not in TOPS:
        return False
    if dot:
        return _is_ours(sys.modules.get(top))
    return top in NEVER_A_CHECKOUT or not _is_the_users_own(top)


def maker(fullname: str) -> Fill | None:
    """Return the function that fills the module of a ROS 2 name. Raises LackingModuleError if robolink lacks it."""
    top = fullname.partition(".")[0]
    if top not in TOPS:
        return _instead(fullname, top)
    if not hidden(fullname):
        return None
    if fullname in ROOMS and not ROOMS[fullname]:
        return _fill_package
    return room_fill(fullname)


def room_fill(fullname: str) -> Fill:
    """Return the function that puts robolink's module in the place of a name. Raises LackingModuleError."""
    room = room_of(fullname)
    parent, _, last = fullname.rpartition(".")
    if last.startswith("_") and room_of(parent).startswith(f"{TYPES}."):
        return functools.partial(fill_private, fullname, _defined_in(fullname))
    if not room or not _is_there(room):
        raise LackingModuleError(fullname, functools.partial(_modules_beside, fullname), instead_of(fullname))
    return functools.partial(_put, fullname, room)


MAKER = maker


def _instead(fullname: str, top: str) -> Fill | None:
    """Refuse a name of ROS's that nobody has, with what to do instead (LackingModuleError); None where somebody has it.

    A folder without `__init__.py`, such as the `launch/` of most packages, holds what is in it and no more.
    """
    hint = instead_of(top)
    if not hint:
        _refuse_misspelt(fullname)
        return None
    if fullname == top:
        real = FINDER.real(top)
        if real is None:
            alike = _alike(top)
            raise LackingModuleError(top, list, f"did you mean '{alike}'? Else {hint}" if alike else hint)
        return functools.partial(_fill_folder, hint) if real.loader is None else None
    parent = sys.modules.get(fullname.rpartition(".")[0])
    if _is_ours(parent) and FINDER.real(fullname, list(getattr(parent, "__path__", []))) is None:
        raise LackingModuleError(fullname, list, hint)
    return None


def _refuse_misspelt(name: str) -> None:
    """Raise LackingModuleError for `std_msg` and the like, which nobody has."""
    if name[:1] == "_" or "." in name or not ("_" in name or name[:2] == "rc"):  # most imports are not ours: no look
        return
    alike = "" if name in LIBRARIES else _alike(name)
    if alike and FINDER.real(name) is None:
        raise LackingModuleError(name, lambda: [alike])


def _alike(name: str) -> str:
    """Return the name of ROS 2's that this one hardly differs from, '' if there is none."""
    return closest(name, sorted(TOPS), ALIKE)


def _fill_folder(hint: str, module: ModuleType) -> None:
    def refuse(name: str) -> Any:
        raise lacking(module.__name__, name, list, sys._getframe(1), hint)

    module.__getattr__ = refuse  # type: ignore[method-assign]


def room_of(fullname: str) -> str:
    """Return the robolink module of a name, which need not exist; '' for none.

    >>> room_of("rclpy.node"), room_of("geometry_msgs.msg")
    ('robolink.node', 'robolink.interfaces.geometry_msgs.msg')
    """
    name, rest = fullname, ""
    while name and name not in ROOMS:
        name, _, last = name.rpartition(".")
        rest = f".{last}{rest}"
    if not name:
        return f"{TYPES}.{fullname}"
    return ROOMS[name] + rest if ROOMS[name] else ""


def _is_there(room: str) -> bool:
    try:
        return importlib.util.find_spec(room) is not None
    except ModuleNotFoundError:  # what it would be in is not there either
        return False


def _is_ours(module: ModuleType | None) -> bool:
    loader = getattr(getattr(module, "__spec__", None), "loader", None)
    return isinstance(loader, Filling) or getattr(module, "__name__", "").partition(".")[0] == "robolink"


def has_rclpy() -> bool:
    """Return whether a real rclpy can be imported, installed or built, and not just a checkout of its repository."""
    spec = FINDER.real("rclpy")
    if spec is None or spec.loader is None:  # none, or a folder without __init__.py
        return False
    from pathlib import Path  # late: a real rclpy is rare

    return not _is_the_users_own("rclpy") or any(Path(spec.origin or "").parent.glob("_rclpy_pybind11*"))


def _is_the_users_own(top: str) -> bool:
    """True if a module of this name is a file of the user's: not installed, neither by pip nor with ROS 1 or 2."""
    spec = FINDER.real(top)
    if spec is None or spec.loader is None or not spec.origin:
        return False
    return not {"site-packages", "dist-packages"} & set(re.split(r"[/\\]", spec.origin))


def _put(fullname: str, room: str, _new: ModuleType) -> None:
    """Put robolink's module in the place of the new one; a name that it lacks is answered with advice."""
    module: Any = importlib.import_module(room)
    sys.modules[fullname] = module
    _put_inner(fullname, module)
    package, _, kind = fullname.partition(".")
    holds_types = room.startswith(f"{TYPES}.") and kind in KINDS
    inner = [name for name in ROOMS if name.startswith(f"{fullname}.")]
    if holds_types or inner:
        vars(module).setdefault("__path__", [])  # else Python asks no finder for geometry_msgs.msg._twist
    for name in inner:
        if isinstance(vars(module).get(name.rpartition(".")[2]), FunctionType):
            # ROS 2's launch_testing.parametrize is a module and, after the import of its package, the function.
            # An import of the module that finds it here does not set the package's attribute once more.
            sys.modules.setdefault(name, importlib.import_module(ROOMS[name]))
    if holds_types:
        set_home(package, kind, functools.partial(_home, fullname))
    own = vars(module).get("__getattr__")
    known_as = own.args[0] if isinstance(own, functools.partial) else ""
    if module is not sys.modules["robolink"] and (not known_as or fullname.count(".") < known_as.count(".")):
        # Of several names that of the package: what it lacks is looked for in launch_ros.actions, not in a part of it.
        own = own.args[2] if isinstance(own, functools.partial) else own
        module.__getattr__ = functools.partial(_lacked, fullname, module, own)


def _put_inner(fullname: str, module: ModuleType) -> None:
    """Put the modules that `module` holds in the place of their names: programs write `launch.actions.log_info`.

    They were imported by the name that they have at robolink, so that no finder was asked for the name of ROS 2's.
    """
    start = f"{fullname}."
    for last in {name.removeprefix(start).partition(".")[0]: None for name in ROOMS if name.startswith(start)}:
        held = vars(module).get(last)
        if isinstance(held, ModuleType) and start + last not in sys.modules and held.__name__ == room_of(start + last):
            _put(start + last, held.__name__, held)


def _home(module: str, short: str) -> str:
    """Return where rosidl defines a type of a module."""
    return f"{module}._{snake_case(short)}"


def _lacked(fullname: str, module: ModuleType, own: Callable[[str], Any] | None, name: str) -> Any:
    """Return a name that a module lacks: its `own` answer to that, if it has any."""
    try:
        if own is not None:
            return own(name)
    except AttributeError:
        pass
    inner = _inner(module, name)
    if inner:
        return importlib.import_module(inner)
    known = functools.partial(names_in, module)
    raise lacking(fullname, name, known, sys._getframe(1), _home_of(fullname, name)) from None


def _inner(module: ModuleType, name: str) -> str:
    """Return ROS 2's name of a module within a module, as ``from cv_bridge import core`` needs it; '' for none.

    Python itself looks below the name that the module has at robolink. One module may have several of ROS 2's names.
    """
    if name.startswith("__"):
        return ""
    names = [f"{each}.{name}" for each, found in sys.modules.copy().items() if found is module]
    return next((each for each in names if each in ROOMS or _types_in(each) or _is_there(room_of(each))), "")


def _home_of(fullname: str, name: str) -> str:
    """Return which other message package has a type of this name, or how ROS 2 spells a part of a service."""
    package, _, kind = fullname.partition(".")
    if kind not in KINDS or not types_of(package, kind):
        return ""
    service, part = next(((name.removesuffix(each), each) for each in PARTS if name.endswith(each)), ("", ""))
    if service in types_of(package, kind):
        return f"that is ROS 1: {service}.{part} is what ROS 2 has"
    homes = [f"{each}.{kind}" for each in packages() if name in types_of(each, kind)]
    return f"it is in {' and in '.join(homes)}" if homes else ""


def _fill_package(module: ModuleType) -> None:
    module.__getattr__ = functools.partial(_lacked, module.__name__, module, None)  # type: ignore[method-assign]


def _defined_in(fullname: str) -> list[str]:
    found = _types_in(fullname)
    if not found:
        package, kind, _ = [*fullname.split("."), "", ""][:3]
        raise LackingModuleError(fullname, lambda: [f"_{snake_case(each)}" for each in types_of(package, kind)])
    return found


def _types_in(fullname: str) -> list[str]:
    """Return the types that rosidl defines in ``geometry_msgs.msg._twist``: those so spelled, usually one."""
    package, kind, last = [*fullname.split("."), "", ""][:3]
    is_private = fullname.count(".") == 2 and last.startswith("_")
    return defined_in(last, types_of(package, kind)) if is_private else []


def defined_in(private: str, types: Iterable[str]) -> list[str]:
    """Return those of the `types` that rosidl defines in the module `private` of their package.

    >>> defined_in("_twist", ["Twist", "TwistStamped"])
    ['Twist']
    """
    return [each for each in types if f"_{snake_case(each)}" == private]


def fill_private(fullname: str, types: Iterable[str], module: ModuleType) -> None:
    """Fill the module `fullname`, in which rosidl defines `types`, with them and their parts."""
    public = importlib.import_module(fullname.rpartition(".")[0])
    for short in types:
        cls = getattr(public, short)
        vars(module)[short] = cls
        for part in (*PARTS, "Event"):
            if hasattr(cls, part):
                vars(module)[f"{short}_{part}"] = getattr(cls, part)
        if hasattr(cls, "Impl"):
            vars(module).update({f"{short}_{end}": getattr(cls.Impl, name) for end, name in ACTION_PARTS.items()})
    module.__getattr__ = functools.partial(_lacked, fullname, module, None)  # type: ignore[method-assign]


def _modules_beside(fullname: str) -> list[str]:
    """Return the names that an import of the same package could have had."""
    from pathlib import Path

    parent = fullname.rpartition(".")[0]
    listed = [name.rpartition(".")[2] for name in ROOMS if name.rpartition(".")[0] == parent]
    folders = getattr(sys.modules.get(room_of(parent)), "__path__", [])
    return [*listed, *(each.stem for folder in folders for each in Path(folder).iterdir() if each.stem.isidentifier())]
