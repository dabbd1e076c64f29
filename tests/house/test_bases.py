"""Bases: no class is there only to be the one base of one other class, which should own it as a part instead."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[2]

ROS_NAMES = {
    "CachedComparisonHandler": "message_filters",
    "ComparisonFilter": "message_filters",
    "CompositeDiagnosticTask": "diagnostic_updater",
    "DeltaFilter": "message_filters",
    "DiagnosticTaskVector": "diagnostic_updater",
    "HeaderlessTopicDiagnostic": "diagnostic_updater",
    "IoHandler": "launch_testing",
    "LaunchConfigurationEquals": "launch.conditions",
    "ProcInfoHandler": "launch_testing",
    "SequentialReader": "rosbag2_py",
    "SequentialWriter": "rosbag2_py",
    "TimeSynchronizer": "message_filters",
    "TopicDiagnostic": "diagnostic_updater",
}
"""Classes that programs of ROS 2 use, which have the bases that they have there, and the packages that they are of."""

TEXTS = re.compile(r'"""[\s\S]*?"""|#.*|"[^"\n]*"')
IMPORTS = re.compile(r"^ *(?:from \S+ )?import (?:\([^)]*\)|.*)", re.MULTILINE)
CLASSES = re.compile(r"^ *class (\w+)(?:\(([^)]*)\))?:", re.MULTILINE)
WORDS = re.compile(r"[A-Za-z_]\w*")


def single_use(texts: Iterable[str]) -> set[str]:
    """Return the classes that one other class has as a base, and that no code uses: to make, check or annotate one.

    They are found by their names, without parsing, which would take some ten seconds: of two classes of one name
    none is found.
    """
    words, classes, bases = Counter[str](), Counter[str](), Counter[str]()
    for text in texts:
        code = IMPORTS.sub("", TEXTS.sub("", text))
        words.update(WORDS.findall(code))
        for name, its_bases in CLASSES.findall(code):
            classes[name] += 1
            bases.update({*WORDS.findall(its_bases.partition("metaclass=")[0])})
    return {name for name, count in classes.items() if (count, bases[name], words[name]) == (1, 1, 2)}


def test_a_class_that_is_only_the_base_of_one_class_is_found() -> None:
    text = "class A: ...\nclass B(A):\n    '''Not A.'''\nclass C: ...\nclass D(C): ...\nclass E(C): ...\nclass F: ...\n"
    other = "from a import B, F\nclass G(\n    B\n): ...\nclass H(F): ...  # of F\ndef f(a: F) -> None: ...\n"
    assert single_use([text.replace("'''", '"""'), other]) == {"A", "B"}


def test_no_class_is_only_the_base_of_one_class() -> None:
    paths = [path for room in ("robolink", "nodes") for path in (ROOT / room).rglob("*.py")]
    assert single_use(path.read_text("utf-8") for path in paths) - {*ROS_NAMES} == set()
