"""Trial of a student's file: what a check uses to start it, to look at it, and to tell what it saw."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from robolink.exceptions import nearest
from robolink.grading.languages import Language
from robolink.learn.exercise import Exercise, ExerciseError
from robolink.learn.report import Line, Track

if TYPE_CHECKING:
    from robolink.learn.report import Tracker
    from robolink.testing import System
    from robolink.testing.robots import SimulatedRobot

SEED = 1
"""Seed of every check, so that each has the same outcome each time."""


class Reported(Exception):  # noqa: N818 - a check ends with it, and nothing is wrong
    """The first thing that is not as it should be was told: the check ends here."""


class Trial:
    """One check of a student's file. A check.py has a function `check(trial)` that uses it."""

    def __init__(self, exercise: Exercise, file: Path, language: Language) -> None:
        self.exercise, self.file, self.language = exercise, file, language
        self.lines: list[Line] = []
        """Sentences so far."""
        self._system: System | None = None
        self._tracker: Tracker | None = None
        self._started: list[Any] = []
        self.has_imported = False
        """True once the check has imported the file as a module."""

    @property
    def folder(self) -> Path:
        """Folder of the exercise, for worlds and other files of its own."""
        return self.exercise.folder

    @property
    def system(self) -> System:
        """System under test, made when it is first used: all that docs/reference/testing.md has, in virtual time."""
        if self._system is None:
            from robolink.testing import System

            self._system = System(seed=SEED)
            self._tracker = _tracker_of(self._system)
        return self._system

    def world(self, name: str = "empty_room", **parameters: Any) -> SimulatedRobot | None:
        """Start the simulated world, and return its robot; None if it has none or several.

        Args:
            name: Name of a world, or of a file in the exercise's folder.
            parameters: More parameters of the node `world`.
        """
        from robolink.exceptions import NotFoundError, RobolinkError

        own = self.folder / name
        try:
            self.system.start("world", parameters={"world": str(own) if own.is_file() else name, **parameters})
        except RobolinkError as error:  # no mistake of the student's
            raise ExerciseError(str(error)) from error
        try:
            return self.system.robot()
        except NotFoundError:
            return None

    def start(self, **options: Any) -> Any:
        """Start the student's program, and return its node (or the program, if it makes no node at once).

        Args:
            options: Those of `System.start`: name, namespace, parameters, remappings, args.
        """
        started = self.system.start(self.file, **options)
        self._started.append(started)
        return started

    def run(self, seconds: float) -> None:
        """Let virtual time pass.

        Args:
            seconds: Seconds of it.
        """
        self.system.run(seconds)

    def module(self) -> ModuleType:
        """Import the student's file, and return the module: for exercises about functions and classes."""
        import robolink.compat  # noqa: F401 - the file may import rclpy

        module = ModuleType("student")
        module.__file__ = str(self.file)
        code = compile(self.file.read_bytes(), str(self.file), "exec")  # not by its .pyc, which may be a second older
        sys.modules["student"] = module
        self.has_imported = True
        try:
            exec(code, module.__dict__)  # noqa: S102 - it is what a student wrote and wants to run
        finally:
            del sys.modules["student"]
        return module

    def tell(self, name: str, good: object, /, **values: Any) -> None:
        """Add a sentence to the report; the check ends with the first that is bad.

        Args:
            name: Name of the sentence, under `results` in exercise.yaml.
            good: True (or anything that counts as true) for its good form.
            values: Values for placeholders in the sentence.
        """
        results = self.exercise.settings.results
        if name not in results:
            raise ExerciseError(f"no result '{name}' in exercise.yaml{nearest(name, results)}")
        outcome = results[name].good if good else results[name].bad
        self.lines.append(Line(bool(good), outcome[self.language].format(**values)))
        if not good:
            raise Reported

    def heard(self, topic: str, condition: Callable[[Any], object] | None = None, within: float = 5.0) -> Any:
        """Wait for a message, and return it; None if none came that meets the condition.

        Args:
            topic: Name of the topic.
            condition: Called with each message; None takes any.
            within: Timeout in virtual seconds.
        """
        from robolink.testing.expectations import ExpectationError, NodeFailure

        try:
            return self.system.expect(topic, condition, within)
        except NodeFailure:
            raise
        except ExpectationError:
            return None

    def answers(self, within: float = 1.0) -> bool:
        """Ask the student's nodes for their parameters; return whether all answer, as nodes do that are spun.

        Args:
            within: Timeout in virtual seconds.
        """
        from robolink.testing.expectations import ExpectationError, NodeFailure

        try:
            for each in self.system.nodes:
                if each != "/world":
                    self.system.call("rcl_interfaces/srv/ListParameters", f"{each}/list_parameters", within=within)
        except NodeFailure:
            raise
        except ExpectationError:
            return False
        return True

    @property
    def published(self) -> str:
        """Names of the topics that the student's nodes publish, for a sentence; '-' for none."""
        system = self.system
        names = [each for each in system.topics if any(node != "/world" for node in system.publishers(each))]
        return ", ".join(each.lstrip("/") for each in names) or "-"

    def moment(self) -> tuple[float, int]:
        """Return how far the check is, for a watchdog: its virtual time and its number of sentences."""
        return (0.0 if self._system is None else self._system.time), len(self.lines)

    @property
    def is_over(self) -> bool:
        """True if a program of the student's has come to its end."""
        return any(_is_over(each) for each in self._started)

    def track(self) -> Track | None:
        """Return the path of the robots so far, and follow them no longer; None if there were none."""
        return None if self._tracker is None else self._tracker.track()

    def close(self) -> None:
        """End all programs."""
        if self._system is not None:
            self._system.close()


def _tracker_of(system: System) -> Tracker | None:
    from robolink.host.pace import HostTime
    from robolink.learn.report import Tracker

    time = system.node.context.time
    return Tracker(time, system.simulations) if isinstance(time, HostTime) else None


def _is_over(started: Any) -> bool:
    from robolink.node import Node

    if isinstance(started, Node):  # a student's class may have an `is_over` of its own
        return not started.context.ok()
    return bool(started.is_over)
