"""ROS 2's tutorials on URDF with robot_state_publisher, and on bags that Python programs write and read."""

from __future__ import annotations

from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.testing import System
from tests.support.tutorial_workspace import TutorialWorkspace


def test_a_robot_model_moves(ros2_ws: TutorialWorkspace, system: System) -> None:
    package = ros2_ws.create(
        "urdf_tutorial_r2d2", "state_publisher = urdf_tutorial_r2d2.state_publisher:main", data="launch urdf"
    )
    setup = package / "setup.py"
    setup.write_text(
        setup.read_text().replace("os.path.join('share', package_name, 'urdf')", "os.path.join('share', package_name)")
    )
    system.launch("urdf_tutorial_r2d2 demo_launch.py")
    static, moving = system.messages("/tf_static", TFMessage), system.messages("/tf", TFMessage)
    system.run(3.0)
    system.expect_log("state_publisher started")
    assert {(each.header.frame_id, each.child_frame_id) for each in static[-1].transforms} == {("rod", "box")}
    frames = {(each.header.frame_id, each.child_frame_id) for message in moving for each in message.transforms}
    assert frames == {("odom", "axis"), ("axis", "body"), ("body", "head"), ("head", "rod")}
    joints = system.expect("/joint_states")
    assert joints.name == ["swivel", "tilt", "periscope"]
    assert 1.2 < joints.position[0] < 1.7  # 30 degrees a second


def test_bags_of_programs(ros2_ws: TutorialWorkspace, system: System) -> None:
    modules = ("simple_bag_recorder", "data_generator_executable", "simple_bag_reader")
    ros2_ws.create("bag_recorder_nodes_py", *(f"{each} = bag_recorder_nodes_py.{each}:main" for each in modules))
    system.start("demo_nodes_py talker")
    system.start("bag_recorder_nodes_py simple_bag_recorder")
    system.run(5.5)
    system.stop("simple_bag_recorder")
    told = ros2_ws.ros2("ros2 bag info my_bag")
    assert "Topic: chatter | Type: std_msgs/msg/String | Count: 5 | Serialization Format: cdr" in told
    system.start("bag_recorder_nodes_py simple_bag_reader", args=["my_bag"])
    heard = system.messages("heard")
    system.run(2.0)
    assert [each.data for each in heard] == [f"Hello World: {n}" for n in range(5)]


def test_a_bag_of_invented_data(ros2_ws: TutorialWorkspace) -> None:
    ros2_ws.create(
        "bag_recorder_nodes_py", "data_generator_executable = bag_recorder_nodes_py.data_generator_executable:main"
    )
    ros2_ws.ros2("ros2 run bag_recorder_nodes_py data_generator_executable")
    told = ros2_ws.ros2("ros2 bag info big_synthetic_bag")
    assert "Topic: synthetic | Type: example_interfaces/msg/Int32 | Count: 100 | Serialization Format: cdr" in told
    assert "Duration:          99.0" in told
