"""The node patrol: how it reads waypoints, and its rounds with a server that fails, comes late and goes away."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node, Parameter
from robolink.action import ActionServer, GoalResponse
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.nav2_msgs.action import NavigateToPose
from robolink.testing import System
from tests.support.nodefiles import load_node_file
from tests.support.systems import PATIENCE, add_world, made_with, said

patrol, goto = map(load_node_file, ("patrol", "goto"))


class Server(Node):
    """Reaches each goal at once, or does with it what it is told; keeps the places."""

    def __init__(self, reaches: Any = lambda x, y: True, accepts: bool = True, **options: Any) -> None:
        super().__init__("server", **options)
        self.places, self.reaches, self.accepts = list[tuple[float, float, float]](), reaches, accepts
        self.server = ActionServer(
            self, NavigateToPose, "navigate_to_pose", self.execute, goal_callback=self.on_goal, cancel_callback=None
        )

    def on_goal(self, goal: NavigateToPose.Goal) -> GoalResponse:
        pose = goal.pose.pose
        theta = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        self.places.append((pose.position.x, pose.position.y, round(theta, 3)))
        return GoalResponse.ACCEPT if self.accepts else GoalResponse.REJECT

    def execute(self, handle: Any) -> NavigateToPose.Result:
        place = handle.request.pose.pose.position
        if self.reaches(place.x, place.y):
            handle.succeed()
            return NavigateToPose.Result()
        handle.abort()
        return NavigateToPose.Result(error_code=105, error_msg="a dog is in the way")


# Waypoints


def test_waypoints_are_words_or_threes_of_numbers() -> None:
    right, up = 0.0, math.pi / 2
    assert patrol.parse_waypoints("0,0 2,0 2,2,3.5") == [(0, 0, right), (2, 0, up), (2, 2, 3.5)]
    assert patrol.parse_waypoints([0, 0, 1, 2, 0.5, 2]) == [(0, 0, 1), (2, 0.5, 2)]
    assert patrol.parse_waypoints(" 1,2 ") == [(1, 2, 0)]


WRONG = {
    "": "there must be one waypoint at least",
    "1,2 3": "'3': expected x,y or x,y,theta",
    "1,2,3,4": "'1,2,3,4': expected x,y or x,y,theta",
    "1,b": "'1,b': expected x,y or x,y,theta",
    "1,nan": "waypoints are finite numbers",
}


@pytest.mark.parametrize(("text", "words"), WRONG.items())
def test_wrong_waypoints_are_named(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        patrol.parse_waypoints(text)


@pytest.mark.parametrize("given", [[1.0, 2.0], [], True, ["a", "b", "c"], [math.inf, 1.0, 0.0], None])
def test_wrong_lists_are_refused(given: Any) -> None:
    with pytest.raises(ValueError, match=r"waypoint|list"):
        patrol.parse_waypoints(given)


@given(st.text(alphabet="0123456789,.- enaif\t", max_size=30))
def test_any_text_is_waypoints_or_an_error_of_robolink(text: str) -> None:
    try:
        waypoints = patrol.parse_waypoints(text)
    except patrol.WaypointsError:
        return
    assert len(waypoints) == len(text.split())
    assert all(math.isfinite(number) for each in waypoints for number in each)


# Rounds


def rounds(system: System, parameters: dict[str, Any], seconds: float) -> Any:
    node = system.start(patrol.Patrol, parameters=parameters)
    system.run(seconds)
    return node


def test_it_goes_round_and_round_with_a_pause_at_each(system: System) -> None:
    server = system.start(Server)
    rounds(system, {"waypoints": "0,0 2,0", "pause": 2.0}, 15.0)
    assert server.places[:3] == [(0, 0, 0), (2, 0, 3.142), (0, 0, 0)]
    assert 6 <= len(server.places) <= 8
    assert said(system, "going to waypoint 2 of 2: (2.00, 0.00)") >= 3
    assert said(system, "2 of 2 waypoints reached") >= 3


def test_without_loop_it_ends_and_goes_on_where_a_waypoint_fails(system: System) -> None:
    server = system.start(made_with(Server, reaches=lambda x, _: x != 1.0))
    node = rounds(system, {"waypoints": [0, 0, 0, 1, 0, 0, 2, 0, 0], "loop": False}, 10.0)
    assert node.done.done()
    assert [x for x, _, _ in server.places] == [0.0, 1.0, 2.0]
    assert said(system, "(1.00, 0.00) was not reached (a dog is in the way): on to the next") == 1
    assert said(system, "2 of 3 waypoints reached") == 1


def test_a_server_that_refuses_all_is_not_flooded(system: System) -> None:
    server = system.start(made_with(Server, accepts=False))
    rounds(system, {"waypoints": "0,0 2,0", "pause": 0.0}, 10.0)
    assert 5 <= len(server.places) <= 11
    assert said(system, "(0.00, 0.00) was not reached (the server refused it)") >= 2


def test_waypoints_can_be_changed_on_the_way_but_not_to_nonsense(system: System) -> None:
    server = system.start(Server)
    node = rounds(system, {"waypoints": "0,0", "pause": 0.1}, 1.0)
    result, _ = node.set_parameters([Parameter("waypoints", value="1,2,3,4"), Parameter("pause", value=0.2)])
    assert not result.successful
    assert "expected x,y or x,y,theta" in result.reason
    assert node.set_parameters([Parameter("waypoints", value="5,5")])[0].successful
    system.run(1.0)
    assert {place[:2] for place in server.places} == {(0, 0), (5, 5)}
    with pytest.raises(InvalidParameterValueException, match="are not such threes"):
        system.start(patrol.Patrol, parameters={"waypoints": [1.0, 2.0]})


@pytest.mark.slow
def test_a_server_that_comes_late_and_goes_away_is_waited_for(system: System) -> None:
    add_world(system, "empty_room")
    node = system.start(patrol.Patrol, parameters={"waypoints": "4,3 4,4", "loop": False, "pause": 0.0})
    system.run(2.0)
    assert said(system, "waiting for a server of navigate_to_pose") == 1
    driver = system.start(goto.Goto)
    system.run(2.0)
    assert said(system, "driving to (4.00, 3.00)") == 1
    system.stop(driver)
    system.run(2.0)
    assert said(system, "the server was lost on the way") == 1
    system.start(goto.Goto)
    system.result(node.done, PATIENCE)
    assert said(system, "driving to (4.00, 3.00)") == 2
    assert said(system, "2 of 2 waypoints reached") == 1
    assert math.hypot(system.robot().pose.x - 4.0, system.robot().pose.y - 4.0) < 0.05


def test_who_ends_a_patrol_stops_the_robot(system: System) -> None:
    add_world(system, "empty_room")
    driver, node = system.start(goto.Goto), system.start(patrol.Patrol, parameters={"waypoints": "5,3"})
    system.run(3.0)
    assert system.robot().twist.v > 0.2
    system.stop(node)
    system.run(2.0)
    assert driver.trip is None
    assert abs(system.robot().twist.v) < 1e-6
