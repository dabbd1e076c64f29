"""Files of static topics, and the recorder that listens to them at once."""

from __future__ import annotations

import pytest

from robolink.bag.topic import read_static_topics
from robolink.exceptions import DocumentError
from robolink.interfaces.std_msgs.msg import String


def test_topics_have_their_classes() -> None:
    text = "static_topics_and_types_list:\n  - [/a, std_msgs/msg/String]\n  - [/b/c, std_msgs/String]\n"
    assert read_static_topics("s.yaml", text=text) == {"/a": String, "/b/c": String}
    assert read_static_topics("s.yaml", text="static_topics_and_types_list: []") == {}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("static_topics_and_types_list: [[a, std_msgs/msg/String]]", "expected a topic's full name, such as /scan"),
        ("static_topics_and_types_list: [[/a, std_msgs/msg/Sting]]", "did you mean 'String'"),
        ("static_topics_and_types_list: [[/a, {b: c}]]", "1:37"),
        ("static_topics_and_types_list: [[/a]]", "1:32"),
        ("static_topics: []", "static_topics_and_types_list"),
        ("[]", "1:1"),
    ],
)
def test_mistakes_have_their_places(text: str, said: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read_static_topics("s.yaml", text=text)
    assert str(caught.value).startswith("s.yaml:1:")
    assert said in str(caught.value)
