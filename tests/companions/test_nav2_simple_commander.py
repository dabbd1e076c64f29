"""BasicNavigator: a plain script drives a robot by Nav2's actions and services, against a small Nav2 and `goto`."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from robolink.companions.nav2_simple_commander import euler_to_quaternion
from robolink.companions.nav2_simple_commander.goals import ACTIONS
from robolink.interfaces.nav2_msgs import action, srv
from robolink.testing import System
from tests.support.small_nav2 import Nav2

PROGRAM = """
import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator, RunningTask, TaskResult

def at(x, y=0.0, frame="map"):
    pose = PoseStamped()
    pose.header.frame_id = frame
    pose.pose.position.x, pose.pose.position.y = x, y
    pose.pose.orientation.w = 1.0
    return pose

def wait(nav):
    while not nav.isTaskComplete():
        pass
    return nav.getResult().name

def main():
    rclpy.init()
    nav = BasicNavigator()
    say = lambda *words: nav.info("said: " + " ".join(map(str, words)))
{body}
    say("the end")
    rclpy.shutdown()

if __name__ == "__main__":
    main()
"""
Begin = Callable[[str], None]
Run = Callable[[str], list[str]]


@pytest.fixture
def begin(system: System, tmp_path: Path) -> Callable[[str], None]:
    """Start the body of a script."""

    def begin(body: str) -> None:
        file = tmp_path / "script.py"
        file.write_text(PROGRAM.replace("{body}", textwrap.indent(textwrap.dedent(body), "    ")))
        system.start(file)

    return begin


@pytest.fixture
def run(system: System, begin: Begin) -> Run:
    """Run the body of a script to its end; what it said."""

    def run(body: str) -> list[str]:
        begin(body)
        system.expect_log("said: the end", within=120.0)
        said = [each.message.removeprefix("said: ") for each in system.logs if each.message.startswith("said: ")]
        return said[:-1]

    return run


@pytest.fixture
def nav2(system: System) -> Nav2:
    made: Nav2 = system.start(Nav2)
    return made


def test_a_goal_is_reached_with_feedback_on_the_way(nav2: Nav2, run: Run) -> None:
    said = run("""
        say(nav.getResult().name, nav.isTaskComplete())
        say(nav.goToPose(at(2.0), behavior_tree="tree.xml"), nav.isTaskComplete(), nav.getFeedback())
        left = set()
        while not nav.isTaskComplete(task=RunningTask.NAVIGATE_TO_POSE):
            if feedback := nav.getFeedback():
                left.add(feedback.distance_remaining)
        say(sorted(left), nav.getResult() == TaskResult.SUCCEEDED, nav.getTaskError())
    """)
    assert said == [
        "UNKNOWN True",
        "RunningTask.NAVIGATE_TO_POSE False None",
        "[0.5, 1.0, 1.5] True (0, '')",
    ]
    assert (nav2.got[0].behavior_tree, nav2.got[0].pose.header.frame_id) == ("tree.xml", "map")


def test_a_goal_is_cancelled_fails_or_is_refused(nav2: Nav2, run: Run) -> None:
    said = run("""
        nav.goToPose(at(50.0))
        nav.cancelTask()
        say(wait(nav))
        nav.goToPose(at(-1.0))
        say(wait(nav), nav.getTaskError())
        say(nav.goToPose(at(101.0)), nav.isTaskComplete(), nav.getResult().name, nav.getTaskError())
        nav.cancelTask()
        nav.goToPose(at(0.5))
        say(wait(nav))
    """)
    assert said == [
        "CANCELED",
        "FAILED (208, 'a wall')",
        "None True UNKNOWN (0, 'Navigating to goal: 101.0 0.0: the request was rejected!')",
        "SUCCEEDED",
    ]
    assert len(nav2.got) == 4


@pytest.mark.usefixtures("nav2")
def test_a_server_that_goes_away_fails_the_task(begin: Begin, system: System) -> None:
    begin("""
        nav.goToPose(at(50.0))
        say(wait(nav), nav.getTaskError())
    """)
    system.expect_log("Navigating to goal")
    system.run(2.0)
    system.crash("nav2")
    assert "went away" in system.expect_log("said: FAILED", within=20.0).message


def test_it_waits_for_a_server(begin: Begin, system: System) -> None:
    begin("nav.goToPose(at(0.5)); say(wait(nav))")
    system.run(5.5)
    notes = [each.message for each in system.logs if "not available" in each.message]
    assert notes == ["'NavigateToPose' action server not available, waiting..."] * 5
    system.start(Nav2)
    assert system.expect_log("said: SUCCEEDED", within=5.0)


def test_each_task_goes_to_its_own_server(nav2: Nav2, run: Run, system: System) -> None:
    said = run("""
        from geographic_msgs.msg import GeoPose
        from nav_msgs.msg import Goals, Path
        path = Path(poses=[at(1.0)])
        tasks = [
            nav.goThroughPoses([at(0.1), at(0.2)]),
            nav.goThroughPoses(Goals(goals=[at(0.1)])),
            nav.followWaypoints([at(0.1), at(0.3)], number_of_loops=2, goal_index=1),
            nav.followGpsWaypoints([GeoPose()]),
            nav.followPath(path, "RPP", "precise", "slow", path_handler_id="any"),
            nav.spin(spin_dist=2, time_allowance=3, disable_collision_checks=True),
            nav.backup(0.25, 0.125, 4),
            nav.driveOnHeading(dist=1.5, speed=0.5, time_allowance=2.5),
            nav.assistedTeleop(60),
            nav.dockRobotByPose(at(0.5), "plug", nav_to_dock=False),
            nav.dockRobotByID("home"),
            nav.undockRobot("plug"),
            nav.followObjectByTopic("/person", max_duration=30),
            nav.followObjectByFrame("person"),
        ]
        say([task.value for task in tasks])
    """)
    assert said == ["[2, 2, 4, 5, 3, 6, 7, 8, 9, 10, 10, 11, 13, 13]"]
    through, goals, points, gps, path, spin, back, ahead, teleop, by_pose, by_id, undock, topic, frame = nav2.got
    assert [len(each.poses) for each in (through, goals, points)] == [2, 1, 2]
    assert (points.number_of_loops, points.goal_index) == (2, 1)
    assert len(gps.gps_poses) == 1
    assert path.progress_checker_id == "slow"
    assert (len(path.path.poses), path.controller_id, path.goal_checker_id) == (1, "RPP", "precise")
    assert (spin.target_yaw, spin.time_allowance.sec) == (2.0, 3)
    assert (back.target.x, back.speed, back.time_allowance.sec) == (0.25, 0.125, 4)
    assert (ahead.target.x, ahead.speed, ahead.time_allowance.nanosec) == (1.5, 0.5, 500_000_000)
    assert teleop.time_allowance.sec == 60
    assert (by_pose.use_dock_id, by_pose.dock_type, by_pose.navigate_to_staging_pose) == (False, "plug", False)
    assert (by_id.use_dock_id, by_id.dock_id, by_id.navigate_to_staging_pose) == (True, "home", True)
    assert undock.dock_type == "plug"
    assert (topic.pose_topic, topic.max_duration.sec) == ("/person", 30)
    assert (frame.tracked_frame, frame.max_duration.sec) == ("person", 0)
    assert "Jazzy's servers have no path_handler_id: they follow the path as it is" in [
        each.message for each in system.logs
    ]


def test_paths_are_planned_and_smoothed(nav2: Nav2, run: Run) -> None:
    said = run("""
        path = nav.getPath(at(0.0), at(1.0), planner_id="A", use_start=True)
        say(len(path.poses), nav.getResult().name)
        say(nav.getPath(at(0.0), at(-1.0)), nav.getTaskError())
        say(nav.getPath(at(0.0), at(101.0)))
        say(len(nav.getPathThroughPoses(at(0.0), [at(0.5), at(1.0)]).poses))
        say(len(nav.smoothPath(path, "S", max_duration=0.5, check_for_collision=True).poses))
        path, route = nav.getRoute(at(0.5), at(1.0))
        say(len(path.poses), type(route).__name__, type(nav.getRoute(3, 4)).__name__)
        try:
            nav.getRoute(3, at(1.0))
        except TypeError as error:
            say(error)
    """)
    assert said[:5] == ["2 SUCCEEDED", "None (208, 'a wall')", "None", "2", "2"]
    assert said[5:] == ["2 Route list", "expected two poses or two numbers of nodes for start and goal of the route"]
    plan, _, _, _, smooth, by_pose, by_number = nav2.got
    assert (plan.planner_id, plan.use_start) == ("A", True)
    assert (smooth.smoother_id, smooth.max_smoothing_duration.nanosec) == ("S", 500_000_000)
    assert smooth.check_for_collisions
    assert (by_pose.use_poses, by_number.use_poses) == (True, False)
    assert (by_number.start_id, by_number.goal_id) == (3, 4)


def test_a_route_is_tracked_beside_another_task(nav2: Nav2, run: Run) -> None:
    said = run("""
        from nav_msgs.msg import Path
        route = nav.getAndTrackRoute(at(4.0), at(5.0))
        say(route.name, nav.isTaskComplete(route), nav.getFeedback(route))
        nav.followPath(Path())
        say(wait(nav), nav.isTaskComplete(task=route))
        while not nav.isTaskComplete(task=route):
            pass
        say(nav.getResult().name, len([*iter(lambda: nav.getFeedback(route), None)]))
        nav.getAndTrackRoute(at(0.0), at(50.0))
        nav.cancelTask()
        while not nav.isTaskComplete(task=route):
            pass
        say(nav.getResult().name)
        say(nav.getAndTrackRoute(at(0.0), at(101.0)), nav.getTaskError()[0], nav.isTaskComplete(route))
    """)
    assert said == [
        "COMPUTE_AND_TRACK_ROUTE False None",
        "SUCCEEDED False",
        "SUCCEEDED 10",
        "CANCELED",
        "None 400 True",
    ]
    assert all(each.use_poses for each in nav2.got if isinstance(each, action.ComputeAndTrackRoute.Goal))


def test_a_rotation_by_its_angles() -> None:
    turned = euler_to_quaternion(yaw=math.pi / 2)
    assert (turned.z, turned.w) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))


def test_it_waits_until_nav2_is_active(nav2: Nav2, run: Run) -> None:
    nav2.active_from = nav2.seconds() + 5.0
    said = run("""
        nav.setInitialPose(at(3.0))
        begun = nav.get_clock().now()
        nav.waitUntilNav2Active()
        say(round((nav.get_clock().now() - begun).nanoseconds / 1e9))
        nav.waitUntilNav2Active(localizer="robot_localization")
    """)
    assert said == ["7"]  # it looks each 2 s, then the pose is sent again, and answered
    assert nav2.poses == [3.0, 3.0]


def test_costmaps_and_maps(nav2: Nav2, run: Run) -> None:
    said = run("""
        nav.clearAllCostmaps()
        nav.clearCostmapExceptRegion(3)
        nav.clearCostmapAroundRobot(1.5)
        nav.clearCostmapAroundPose(at(2.0), 0.5)
        nav.clearLocalCostmapAroundPose(at(2.0), 1.0)
        nav.clearGlobalCostmapAroundPose(at(2.0), 2.0)
        say(nav.getGlobalCostmap().metadata.layer, nav.getLocalCostmap().metadata.layer)
        say(nav.changeMap("lab.yaml"), nav.changeMap("none.yaml"))
    """)
    assert said == ["global_costmap local_costmap", "True False"]
    assert [getattr(each, "reset_distance", None) for each in nav2.got] == [None, None, 3.0, 1.5, 0.5, 1.0, 2.0]


def test_the_collision_monitor_is_switched(nav2: Nav2, run: Run, system: System) -> None:
    run("nav.toggleCollisionMonitor(True)\nnav.toggleCollisionMonitor(False)")
    assert nav2.got == [True, False]
    assert any(each.message == "Toggle collision monitor request failed! it stays on" for each in system.logs)


@pytest.mark.usefixtures("nav2")
def test_the_state_of_the_last_task_is_cleared(run: Run) -> None:
    said = run("""
        nav.goToPose(at(-1.0))
        wait(nav)
        say(nav.getTaskError())
        nav.clearPreviousState()
        say(nav.getTaskError(), nav.getFeedback())
        nav.goToPose(at(50.0))
        while nav.getFeedback() is None:
            nav.isTaskComplete()
        nav.cancelTask()
        say(nav.getFeedback(), wait(nav))
    """)
    assert said == ["(208, 'a wall')", "(0, '') None", "None CANCELED"]


def test_a_map_that_is_not_there_is_named(nav2: Nav2, run: Run, system: System) -> None:
    run('nav.changeMap("none.yaml")')
    assert any("RESULT_MAP_DOES_NOT_EXIST" in each.message for each in system.logs)


def test_lifecycle_managers_start_and_stop_their_nodes(nav2: Nav2, run: Run, system: System) -> None:
    run("""
        nav.lifecycleStartup()
        nav.lifecycleShutdown()
        nav.destroyNode()
        nav = BasicNavigator("other")
    """)
    assert nav2.got == [srv.ManageLifecycleNodes.Request.STARTUP, srv.ManageLifecycleNodes.Request.SHUTDOWN]
    assert any(
        each.message == "Shutting down /lifecycle_manager_navigation/manage_nodes failed" for each in system.logs
    )


@pytest.mark.slow
def test_it_drives_the_simulated_robot(run: Run, system: System) -> None:
    system.launch("goto")
    assert run("""
        nav.goToPose(at(2.0, 1.0, frame="odom"))
        say(wait(nav))
    """) == ["SUCCEEDED"]
    pose = system.robot().pose
    assert (pose.x, pose.y) == pytest.approx((2.0, 1.0), abs=0.3)


def test_every_action_of_nav2_that_a_navigator_uses_is_in_the_table() -> None:
    others = {"DummyBehavior", "Wait"}
    assert {each.__name__ for each in ACTIONS} == set(action.__all__) - others
