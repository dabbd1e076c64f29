"""tf2_ros's buffer_server: look-ups by an action."""

from __future__ import annotations

from robolink.action import ActionClient
from robolink.counterparts.tf2_ros import TfBuffer
from robolink.interfaces.tf2_msgs.action import LookupTransform
from robolink.interfaces.tf2_msgs.srv import FrameGraph
from robolink.testing import System


def test_transforms_are_looked_up_by_an_action(system: System) -> None:
    system.start("static_transform_publisher", args=["--frame-id", "map", "--child-frame-id", "base", "--x", "2"])
    system.start(TfBuffer, parameters={"publish_frame_service": True, "buffer_size": 5.0})
    system.run(1.0)
    client = ActionClient(system.node, LookupTransform, "tf2_buffer_server")
    goal = system.result(client.send_goal_async(LookupTransform.Goal(target_frame="map", source_frame="base")))
    found = system.result(goal.get_result_async()).result
    assert found.transform.transform.translation.x == 2
    assert "base:" in system.call(FrameGraph, "/tf2_frames").frame_yaml
