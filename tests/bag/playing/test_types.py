"""Types of the topics of a bag: built from the definitions that the bag carries."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.bag.playing.publishers import class_of, class_of_definition
from robolink.bag.topic import SEPARATOR, BagTopic, message_definition
from robolink.exceptions import RobolinkError
from robolink.interfaces import find
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.message import type_hash

LINES = st.sampled_from(
    [
        "int32 x",
        "string s",
        SEPARATOR,
        "MSG: a/B",
        "MSG: ",
        "B b",
        "a/B c",
        "a/B[] d",
        "Whole w",
        "# text",
        "",
        "x",
        "---",
    ]
)


@pytest.mark.parametrize("name", ["nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage", "visualization_msgs/msg/Marker"])
def test_a_definition_gives_the_class_that_it_is_of(name: str) -> None:
    installed = find(name)
    built = class_of_definition(message_definition(installed), name)
    assert built is not installed
    assert type_hash(built) == type_hash(installed)


@given(st.lists(LINES, max_size=12).map("\n".join) | st.text(max_size=200))
def test_any_text_is_a_type_or_one_clear_error(text: str) -> None:
    try:
        built = class_of_definition(text, "a/msg/Whole")
    except RobolinkError:  # and nothing else
        return
    assert built.__ros_type__ == "a/msg/Whole"


def test_the_installed_type_is_taken_unless_the_bag_has_another_one_of_its_name() -> None:
    name, other = "std_msgs/msg/String", "RIHS01_" + "ab" * 32
    assert class_of(BagTopic("/a", name)) is String
    assert class_of(BagTopic("/a", name, type_hash=type_hash(String))) is String
    assert class_of(BagTopic("/a", name, type_hash=other)) is None, "only its bytes are known"
    assert class_of(BagTopic("/a", name, type_hash=other, message_definition=message_definition(String))) is String
    changed = class_of(BagTopic("/a", name, type_hash=other, message_definition=message_definition(Int32)))
    assert changed is not None
    assert type_hash(changed) not in (type_hash(String), type_hash(Int32))
