"""Selections of topics: names, types, regular expressions, services, actions, and what is excluded."""

from __future__ import annotations

import pytest

from robolink.bag.selection import Selection, SelectionError

STRING, EVENT = "std_msgs/msg/String", "std_srvs/srv/SetBool_Event"


def test_names_types_and_expressions_select() -> None:
    some = Selection(topics=("/a",), topic_types=("sensor_msgs/msg/LaserScan",), regex="^/cam.*/image$")
    assert some.takes("/a", STRING)
    assert some.takes("/any", "sensor_msgs/msg/LaserScan")
    assert some.takes("/camera/image", STRING)
    assert not some.takes("/camera/image/more", STRING)
    assert not some.takes("/b", STRING)


def test_what_is_excluded_is_so_whatever_selects_it() -> None:
    everything = Selection(
        all_topics=True, exclude_topics=("/a",), exclude_regex="cam", exclude_topic_types=("x/msg/Y",)
    )
    assert everything.takes("/b", STRING)
    assert not everything.takes("/a", STRING)
    assert not everything.takes("/camera", STRING)
    assert not everything.takes("/b", "x/msg/Y")
    assert not Selection(topics=("/a",), exclude_topics=("/a",)).takes("/a", STRING)


def test_hidden_topics_are_recorded_on_request_or_by_name() -> None:
    assert not Selection(all_topics=True).takes("/_secret", STRING)
    assert Selection(all_topics=True, include_hidden=True).takes("/_secret", STRING)
    assert Selection(topics=("/_secret",)).takes("/_secret", STRING)
    assert not Selection(regex="secret").takes("/_secret", STRING)


def test_services_are_selected_by_the_service() -> None:
    topic = "/arm/set/_service_event"
    assert Selection(services=("/arm/set",)).takes(topic, EVENT)
    assert Selection(all_services=True).takes(topic, EVENT)
    assert Selection(regex="^/arm/set$").takes(topic, EVENT)
    assert not Selection(all_topics=True).takes(topic, EVENT)
    assert not Selection(all_services=True, exclude_services=("/arm/set",)).takes(topic, EVENT)
    assert not Selection(all_services=True).takes("/a", STRING)


def test_actions_are_selected_with_their_topics_and_events() -> None:
    parts = ["/go/_action/feedback", "/go/_action/status", "/go/_action/send_goal/_service_event"]
    for part in parts:
        assert Selection(actions=("/go",)).takes(part, STRING)
        assert Selection(all_actions=True).takes(part, STRING)
        assert not Selection(all_topics=True, all_services=True).takes(part, STRING)
        assert not Selection(all_actions=True, exclude_actions=("/go",)).takes(part, STRING)


def test_nothing_selected_and_a_wrong_expression_are_told() -> None:
    with pytest.raises(SelectionError, match="nothing is selected"):
        Selection(include_hidden=True).checked()
    with pytest.raises(SelectionError, match=r"exclude_regex: '\(' is not a regular expression"):
        Selection(all_topics=True, exclude_regex="(").checked()
