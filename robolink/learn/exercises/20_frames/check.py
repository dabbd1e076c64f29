"""Check of a static transform."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Look at what is said about the frames."""
    from robolink.interfaces.tf2_msgs.msg import TFMessage
    from robolink.qos import DurabilityPolicy, QoSProfile

    trial.start()
    heard: list[TFMessage] = []
    qos = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    trial.system.node.create_subscription(TFMessage, "/tf_static", heard.append, qos)
    moving: list[TFMessage] = []
    trial.system.node.create_subscription(TFMessage, "/tf", moving.append, 10)
    trial.run(1.0)
    trial.tell("static", not moving and not trial.system.publishers("/tf"))
    found = [each for message in heard for each in message.transforms]
    frames = {"base_link", "laser"}
    ours = [each for each in found if {each.header.frame_id, each.child_frame_id} == frames]
    trial.tell("there", ours)
    parent = ours[0].header.frame_id
    where, turn = ours[0].transform.translation, ours[0].transform.rotation
    trial.tell("child", parent == "base_link", parent=parent)
    trial.tell("ahead", abs(where.x - 0.2) < 1e-6, x=where.x)
    trial.tell("middle", abs(where.y) < 1e-6, y=where.y)
    trial.tell("above", abs(where.z - 0.3) < 1e-6, z=where.z)
    trial.tell("straight", abs(turn.w) > 0.999, x=turn.x, y=turn.y, z=turn.z, w=turn.w)
