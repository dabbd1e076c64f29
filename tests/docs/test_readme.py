"""The README: its program runs as it stands there, its figures are those of the pages, both languages say the same."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType

import pytest

from robolink import Context, VirtualTime
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from tools.docs_site.markdown import LINK, blocks, headings
from tools.docs_site.pages import addresses

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PORTUGUESE = (ROOT / "README.pt-BR.md").read_text(encoding="utf-8")
BESIDE_ROS2 = (ROOT / "docs" / "reference" / "ros2.md").read_text(encoding="utf-8")


def module(page: str, word: str) -> ModuleType:
    """Run the only program of a page in which a word stands."""
    programs = [each.text for each in blocks(page) if each.language == "python"]
    (text,) = (each for each in programs if word in each)
    made = ModuleType("readme")
    exec(compile(text, "README.md", "exec"), made.__dict__)
    return made


def test_the_node_stops_before_what_is_near(monkeypatch: pytest.MonkeyPatch) -> None:
    context = Context(transport="memory://readme", time=VirtualTime())
    context.init(args=[])
    monkeypatch.setattr("robolink.node.get_default_context", lambda: context)
    node = module(README, "class Careful").Careful()
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
    basket = module(BESIDE_ROS2, "class Basket").Basket(label="red", weights=[0.5])
    assert (basket.label, list(basket.weights)) == ("red", [0.5])


def test_it_is_short_and_its_program_has_twelve_lines() -> None:
    assert len(README.splitlines()) < 150
    assert len(PORTUGUESE.splitlines()) < 150
    (program,) = (each.text for each in blocks(README) if each.language == "python")
    assert len([line for line in program.splitlines() if line.strip()]) == 12


def test_the_number_of_rclpys_tests_that_pass_is_that_of_the_page() -> None:
    page = (ROOT / "docs" / "reference" / "rclpy.md").read_text(encoding="utf-8")
    ((passed, failed, other),) = re.findall(r"^\| all \| (\d+) \| (\d+) \| (\d+) \|$", page, re.MULTILINE)
    assert f"{int(passed) + int(failed) + int(other)} test functions {passed} pass" in README
    assert f"{int(passed) + int(failed) + int(other)} funções de teste do próprio rclpy {passed} passam" in PORTUGUESE


def targets(text: str) -> list[str]:
    """Return where the links and pictures lead; a page is the same in both languages."""
    files = [each for _, _, each in LINK.findall(text)]
    return [each if "://" in each else addresses().get((ROOT / each).resolve(), each) for each in files]


def test_both_languages_have_the_same_code_parts_and_links() -> None:
    assert [each.text for each in blocks(PORTUGUESE)] == [each.text for each in blocks(README)]
    assert [level for level, _ in headings(PORTUGUESE)] == [level for level, _ in headings(README)]
    assert ["README.pt-BR.md" if each == "README.md" else each for each in targets(PORTUGUESE)] == targets(README)


def test_each_leads_to_the_other_in_its_first_lines() -> None:
    assert "(README.pt-BR.md)" in "".join(README.splitlines()[:6])
    assert "(README.md)" in "".join(PORTUGUESE.splitlines()[:6])


def test_nothing_is_asked_of_a_package_index_where_robolink_is_not() -> None:
    """A clone and a repository's address are what there is; `pip install robolink` fails, or finds somebody else's."""
    texts = [*ROOT.glob("README*.md"), *(ROOT / "docs").glob("*/*.md"), *(ROOT / "robolink").rglob("*.py")]
    found = [each for text in texts for each in re.findall(r"pip install [^`#\n]*", text.read_text(encoding="utf-8"))]
    assert len(found) > 5
    assert [
        each for each in found if "--no-index" not in each and re.search(r"(?<![/.\w])robolink\b(?! @ git\+)", each)
    ] == []


def typed(text: str) -> list[str]:
    """What a page has its readers type: the lines of its shells, and commands between backquotes."""
    blocks = "".join(re.findall(r"```(?:sh|console)\n(.*?)```", text, re.DOTALL)).splitlines()
    prompted = [each.removeprefix("$ ") for each in blocks if each.startswith(("$ ", "robolink ", "ros2 ", "pip "))]
    return prompted + re.findall(r"`((?:robolink|topic|pytest|pip|ros2|service|param|plot|action) [^`]+)`", text)


def test_what_is_typed_means_the_same_in_zsh() -> None:
    """It takes brackets and stars for patterns of file names, and gives up where no file fits."""
    pages = [*ROOT.glob("README*.md"), *(ROOT / "docs").glob("*/*.md")]
    commands = [each for page in pages for each in typed(page.read_text(encoding="utf-8"))]
    assert len(commands) > 50
    unquoted = {each: re.sub(r"'[^']*'|\"[^\"]*\"|#.*", "", each) for each in commands}
    assert [each for each, bare in unquoted.items() if re.search(r"[\[\]*?]", bare)] == []
