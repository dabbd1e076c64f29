"""Check of a publisher whose speed rises and begins again."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Compare ten seconds of speeds."""
    trial.start()
    sent = trial.system.messages("cmd_vel")
    trial.run(10.2)
    speeds = [each.linear.x for each in sent]
    trial.tell("begins", speeds and abs(speeds[0]) < 1e-6, speed=f"{speeds[0]:.1f}" if speeds else "-")
    rising = all(abs(speed - 0.1 * number) < 1e-6 for number, speed in enumerate(speeds[:11]))
    trial.tell("rises", rising and len(speeds) > 11, speeds=", ".join(f"{each:.1f}" for each in speeds[:4]))
    name = "again" if speeds[10] == 1.0 or abs(speeds[11]) < 1e-6 else "rounded"
    trial.tell(name, abs(speeds[11]) < 1e-6, speed=speeds[11], last=repr(speeds[10]))
    trial.tell("pace", 19 <= len(sent) <= 21, count=len(sent))
