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
    trial.run(1.0)
    found = [each for message in heard for each in message.transforms]
    frames = {"base_link", "laser"}
    ours = [each for each in found if {each.header.frame_id, each.child_frame_id} == frames]
    trial.tell("there", ours)
    parent = ours[0].header.frame_id
    where = ours[0].transform.translation
    trial.tell("child", parent == "base_link", parent=parent)
    trial.tell("ahead", abs(where.x - 0.2) < 1e-6 and abs(where.y) < 1e-6, x=where.x)
    trial.tell("above", abs(where.z - 0.3) < 1e-6, z=where.z)
