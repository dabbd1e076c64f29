"""Check of a node that asks tf, with frames of the check's own."""

from __future__ import annotations

from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.learn.trial import Trial
from robolink.tf2 import StaticTransformBroadcaster, TransformBroadcaster


def check(trial: Trial) -> None:
    """Publish nothing, then where the frames are, then that the robot has moved."""
    trial.start()
    said = trial.system.messages("distance")
    trial.run(1.2)
    trial.tell("quiet", not said, said=said[0].data if said else 0.0)
    node = trial.system.node
    static, moving = StaticTransformBroadcaster(node), TransformBroadcaster(node)
    static.sendTransform(placed(trial, "goal", 6.0, 4.0))
    for x, y, name, distance in ((2.0, 1.0, "right", 5.0), (6.0, 0.0, "follows", 4.0)):
        for _ in range(15):
            moving.sendTransform(placed(trial, "base_link", x, y))
            trial.run(0.1)
        if name == "right":
            trial.tell("says", said)
            types = trial.system.topics["/distance"]
            trial.tell("type", types == "std_msgs/msg/Float32", types=types)
            trial.tell("pace", 2 <= len(said) <= 4, count=len(said))
        last = said[-1].data
        trial.tell(name, abs(last - distance) < 0.01, said=last)


def placed(trial: Trial, frame: str, x: float, y: float) -> TransformStamped:
    """Return a transform of a frame in odom."""
    made = TransformStamped()
    made.header.stamp = trial.system.node.get_clock().now().to_msg()
    made.header.frame_id, made.child_frame_id = "odom", frame
    made.transform.translation.x, made.transform.translation.y = x, y
    made.transform.rotation.w = 1.0
    return made
