"""Check of a publisher that keeps its last message for late subscriptions."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Subscribe two seconds late."""
    from robolink.interfaces.std_msgs.msg import String
    from robolink.qos import DurabilityPolicy, QoSProfile

    trial.start()
    trial.run(2.0)
    trial.tell("says", trial.system.publishers("map_name"))
    heard: list[String] = []
    qos = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    trial.system.node.create_subscription(String, "map_name", heard.append, qos)
    trial.run(2.0)
    trial.tell("late", heard)
    trial.tell("once", len(heard) == 1, count=len(heard))
