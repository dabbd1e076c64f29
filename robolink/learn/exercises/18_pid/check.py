"""Check of a controller, with a motor of the check's own: its speed falls by friction, and grows by effort."""

from __future__ import annotations

from robolink.interfaces.std_msgs.msg import Float64
from robolink.learn.trial import Trial

DT, FRICTION, STATIC = 0.05, 0.8, 0.3


def check(trial: Trial) -> None:
    """Close the loop for ten seconds."""
    trial.start()
    trial.run(0.5)
    speed = fastest = 0.0
    efforts = trial.system.messages("effort")
    for step in range(200):
        trial.system.publish("speed", Float64(data=speed))
        trial.run(DT)
        if step == 0:
            trial.tell("answers", efforts)
        effort = efforts[-1].data
        speed = max(-10.0, min(10.0, speed + DT * (effort - FRICTION * speed - STATIC)))
        fastest = max(fastest, speed)
    trial.tell("reaches", abs(speed - 1.0) < 0.05, speed=speed)
    trial.tell("calm", fastest < 1.3, fastest=fastest)
