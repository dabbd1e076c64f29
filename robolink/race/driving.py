"""Run of one program in a race, in this process and in virtual time."""

from __future__ import annotations

import contextlib
import hashlib
import struct
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.exceptions import NotFoundError
from robolink.grading.mistakes import Mistake, mistake_in, mistake_of
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.race.races import Race
from robolink.race.result import Result
from robolink.workspace import find_node

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.race.races import Judge
    from robolink.testing import System
    from robolink.testing.robots import SimulatedRobot

STEP = 0.05
"""Virtual seconds from one look of the judge to the next."""

CONTROLS = ("reset", "pause", "resume", "step", "teleport", "spawn", "delete", "set_rate")
"""Services of the world that a race does not have."""

_STATE = struct.Struct("<3dI")


class Drive:
    """One run of a program in a race.

    Args:
        race: The race.
        program: A file, or the name of a node as `robolink run` finds it.
        seed: Seed of the world and of all chance.
    """

    def __init__(self, race: Race, program: str, seed: int) -> None:
        self.file = _file_of(program)
        self._race, self._program, self._seed = race, program, seed
        self._system: System | None = None
        self._judge: Judge = race.judge(seed)
        self._digest = hashlib.sha256()
        self._contacts = 0

    def moment(self) -> tuple[float, int]:
        """Return how far the run is, for a watchdog."""
        return (0.0 if self._system is None else self._system.time), 0

    def result(self, mistake: Mistake | None = None) -> Result:
        """Return the result so far, with the mistake that ended the program, if one did."""
        score = None if mistake is not None else self._judge.score()
        return Result(
            self._program,
            None if score is None else round(score, 3),
            round(self._judge.progress, 3),
            self._contacts,
            self._digest.hexdigest(),
            mistake,
        )

    def run(self) -> Result:
        """Run it to its end; nothing that the program does raises."""
        mistake = mistake_in(self.file) if self.file.is_file() else None
        if mistake is None:
            mistake = self._ran()
        return self.result(mistake)

    def _ran(self) -> Mistake | None:
        from robolink.testing import System

        try:
            with tempfile.TemporaryDirectory(prefix="robolink-race-", ignore_cleanup_errors=True) as scratch:
                world = Path(scratch, "world.yaml")
                world.write_text(self._race.world(self._seed), encoding="utf-8")
                self._system = System(seed=self._seed)
                try:
                    _leave_to_the_judge(self._system.start("world", parameters={"world": str(world)}))
                    robot = self._system.robot()
                    self._system.start(Path(self._program) if Path(self._program).is_file() else self._program)
                    self._drive(self._system, robot)
                finally:
                    self._system.close()
        except BaseException as error:  # noqa: BLE001 - whatever a program raises is told
            return mistake_of(error, self.file) or Mistake("elsewhere", f"{type(error).__name__}: {error}"[:500])
        return None

    def _drive(self, system: System, robot: SimulatedRobot) -> None:
        steps = round(self._race.seconds / STEP)
        for number in range(1, steps + 1):
            system.run(STEP)
            pose, self._contacts = robot.pose, robot.contacts
            self._digest.update(_STATE.pack(pose.x, pose.y, pose.theta, self._contacts))
            self._judge.see(number * STEP, pose.x, pose.y, self._contacts)
            if self._judge.is_over:
                return


def _leave_to_the_judge(world: Node) -> None:
    """Take from everybody what moves robots, and time, other than by driving: the world's services and parameters."""
    for each in list(world.services):
        if each.service_name.rpartition("/")[2] in CONTROLS:
            world.destroy_service(each)
    world.add_on_set_parameters_callback(
        lambda _: SetParametersResult(successful=False, reason="this is a race: its world is the judge's")
    )


def _file_of(program: str) -> Path:
    """Return the file of a program, for the lines of its mistakes."""
    with contextlib.suppress(NotFoundError):  # it is told when the program is started
        if not Path(program).is_file():
            return find_node(program).path or Path(program)
    return Path(program)
