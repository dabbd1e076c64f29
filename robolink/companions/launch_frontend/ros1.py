"""Recognition of ROS 1's launch files: XML as that of ROS 2, with other words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robolink.companions.launch_frontend.entity import Entity
from robolink.exceptions import DocumentError

_TAGS = {"rosparam": "<rosparam> is <param from=...> in a node"}
_ATTRIBUTES = {
    ("node", "type"): "type= is exec=",
    ("node", "required"): 'required="true" is on_exit="shutdown"',
    ("node", "clear_params"): "clear_params= has no successor",
    ("include", "ns"): "<include ns=...> is <push_ros_namespace> in a <group>",
    ("include", "clear_params"): "clear_params= has no successor",
    ("include", "pass_all_args"): "pass_all_args= has no successor",
    ("group", "ns"): "<group ns=...> is <push_ros_namespace> in it",
}
_TEXTS = {
    "$(find ": "$(find x) is $(find-pkg-share x)",
    "$(arg ": "$(arg x) is $(var x)",
    "$(optenv ": "$(optenv x y) is $(env x y)",
}


def refuse_ros1(top: Entity) -> None:
    """Raise DocumentError, with the words that have changed, if the elements below `top` are a launch file of ROS 1."""
    mark = next((each for each in _all(top) if _is_ros1(each)), None)
    if mark is not None:
        words = "; ".join(dict.fromkeys(filter(None, _changed(top))))
        raise DocumentError(f"a launch file of ROS 1; in ROS 2 {words}", mark.place.file, mark.place.line)


def _is_ros1(entity: Entity) -> bool:
    """True if an element is one that only ROS 1 has."""
    is_node = entity.name == "node" and "type" in entity.attributes and "exec" not in entity.attributes
    return is_node or entity.name == "rosparam"


def _all(top: Entity) -> Iterator[Entity]:
    waiting = [top]
    while waiting:
        each = waiting.pop(0)
        yield each
        waiting[:0] = each.children


def _changed(top: Entity) -> Iterable[str]:
    """Yield what ROS 2 writes for each word of ROS 1 in a file."""
    for each in _all(top):
        yield _TAGS.get(each.name, "")
        yield from (_ATTRIBUTES.get((each.name, name), "") for name in each.attributes)
        for value in each.attributes.values():
            text = value if isinstance(value, str) else ""
            yield from (words for begin, words in _TEXTS.items() if begin in text)
    if any(each.name == "param" for each in top.children):
        yield "<param> stands in its <node>"
