"""The README's programs run as they stand there."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType

import pytest

from robolink import Context, VirtualTime
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.testing import System

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROGRAMS = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
(SYSTEM,) = re.findall(r"```yaml\n(.*?)```", README, re.DOTALL)


def module(word: str) -> ModuleType:
    """Run the only program in which a word stands."""
    (text,) = (each for each in PROGRAMS if word in each)
    made = ModuleType("readme")
    exec(compile(text, "README.md", "exec"), made.__dict__)
    return made


def test_the_node_stops_before_what_is_near(monkeypatch: pytest.MonkeyPatch) -> None:
    context = Context(transport="memory://readme", time=VirtualTime())
    context.init(args=[])
    monkeypatch.setattr("robolink.node.get_default_context", lambda: context)
    node = module("class Careful").Careful()
    sent: list[float] = []
    node.create_subscription(Twist, "cmd_vel", lambda twist: sent.append(twist.linear.x), 10)
    scans = node.create_publisher(LaserScan, "scan", 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    for nearest in (2.0, 0.2):
        scans.publish(LaserScan(ranges=[nearest, 3.0]))
    for _ in range(4):
        executor.spin_once(timeout_sec=1.0)
    assert sent == [0.3, 0.0]
    context.shutdown()


def test_a_type_of_ones_own_has_its_fields() -> None:
    basket = module("class Basket").Basket(label="red", weights=[0.5])
    assert (basket.label, list(basket.weights)) == ("red", [0.5])


def test_the_test_passes() -> None:
    with System(seed=1) as system:
        module("def test_").test_follows_the_wall_though_a_fifth_of_its_scans_is_lost(system)


def test_the_system_drives_as_fast_as_it_is_told(tmp_path: Path) -> None:
    (tmp_path / "lap.yaml").write_text(SYSTEM)
    with System(seed=1) as system:
        system.launch(tmp_path / "lap.yaml", {"speed": 0.5})
        system.expect("cmd_vel", lambda twist: twist.linear.x > 0.45, within=30.0)


def test_nothing_is_asked_of_a_package_index_where_robolink_is_not() -> None:
    """A clone and a repository's address are what there is; `pip install robolink` fails, or finds somebody else's."""
    texts = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "robolink").rglob("*.py")]
    found = [each for text in texts for each in re.findall(r"pip install [^`#\n]*", text.read_text(encoding="utf-8"))]
    assert len(found) > 5
    assert [each for each in found if re.search(r"(?<![/.\w])robolink\b(?! @ git\+)", each)] == []


def typed(text: str) -> list[str]:
    """What a page has its readers type: the lines of its shells, and commands between backquotes."""
    blocks = "".join(re.findall(r"```(?:sh|console)\n(.*?)```", text, re.DOTALL)).splitlines()
    prompted = [each.removeprefix("$ ") for each in blocks if each.startswith(("$ ", "robolink ", "ros2 ", "pip "))]
    return prompted + re.findall(r"`((?:robolink|topic|pytest|pip|ros2|service|param|plot|action) [^`]+)`", text)


def test_what_is_typed_means_the_same_in_zsh() -> None:
    """It takes brackets and stars for patterns of file names, and gives up where no file fits."""
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    commands = [each for page in pages for each in typed(page.read_text(encoding="utf-8"))]
    assert len(commands) > 50
    unquoted = {each: re.sub(r"'[^']*'|\"[^\"]*\"|#.*", "", each) for each in commands}
    assert [each for each, bare in unquoted.items() if re.search(r"[\[\]*?]", bare)] == []
