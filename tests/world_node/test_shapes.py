"""The markers of a simulated world: floor, what stands, what moves, and the robots in their own frames."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.message import encode
from robolink.sim import load_world
from robolink.sim.colours import hex_of
from robolink.sim.description import WorldDescription, signed_area
from robolink.sim.drawing import draw_world
from robolink.sim.scene import pictures
from robolink.sim.scene.mosaic import Mosaic, mosaic
from robolink.sim.scene.solids import Picture
from robolink.world_node import Shapes, Simulation, signs
from robolink.world_node.shapes import Scenery
from robolink.world_node.simulation import LATCHED
from tests.support.spins import spin_until

WORLDS = sorted((Path(__file__).parents[2] / "configs" / "worlds").glob("*.yaml"))

WORLD = """
world: {size: [4, 3], floor: {colour: '#112233'}}
walls: [{polyline: [[0, 0], [4, 0], [4, 3]], closed: true}, {polyline: [[1, 0], [1, 1]], colour: red, height: 0.4}]
obstacles:
  - {circle: 0.2, pose: [1, 2], colour: blue, height: 0.8}
  - {box: [0.4, 0.2], mass: 1.0, pose: [2, 2, 0.5]}
  - {polygon: [[0, 0], [0.2, 0], [0, 0.2]], path: [[3, 1], [3, 2]], speed: 1.0}
paint: [{line: [[0.5, 0.5], [3.5, 0.5]], dashes: [0.5, 0.5]}, {circle: 0.2, pose: [2, 1.5], colour: yellow}]
robots: [{name: bob, pose: [2, 1], height: 0.3}]
"""


@pytest.fixture
def heard(virtual: Context, executor: SingleThreadedExecutor, tmp_path: Path) -> dict[str, Any]:
    """A world's markers, as another node hears them."""
    file = tmp_path / "world.yaml"
    file.write_text(WORLD, encoding="utf-8")
    node, ear = Node("world", context=virtual), Node("viewer", context=virtual)
    simulation = Simulation(node, load_world(file), 0)
    steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=virtual.time)
    shapes = Shapes(node, simulation, steady)
    found: dict[str, Any] = {"simulation": simulation, "shapes": shapes, "count": 0}

    def take(name: str, message: MarkerArray) -> None:
        found[name], found["count"] = message.markers, found["count"] + 1

    for name in ("floor", "walls", "objects"):
        ear.create_subscription(MarkerArray, f"/world/{name}", lambda message, name=name: take(name, message), LATCHED)
    executor.add_node(node)
    executor.add_node(ear)
    spin_until(executor, lambda: {"floor", "walls", "objects"} <= set(found))
    found["executor"] = executor
    return found


def of(markers: Sequence[Marker], group: str) -> list[Marker]:
    """The markers of a namespace; the message begins with the deletion of all that was there."""
    assert markers[0].action == Marker.DELETEALL
    return [each for each in markers[1:] if each.ns == group]


def colour(marker: Marker) -> str:
    """The colour of a marker as '#rrggbb'."""
    red, green, blue = (round(255 * each) for each in (marker.color.r, marker.color.g, marker.color.b))
    assert marker.color.a == 1.0
    return hex_of((red, green, blue))


def test_the_floor_has_its_colour_and_its_paint_lies_in_layers_below_the_plane_of_grids(heard: dict[str, Any]) -> None:
    (ground,), (line, spot) = of(heard["floor"], "floor"), of(heard["floor"], "paint")
    assert (colour(ground), colour(line), colour(spot)) == ("#112233", "#ffffff", "#ffff00")
    assert box(ground) == (0, 0, 4, 3)
    heights = [each.pose.position.z for each in (ground, line, spot)]
    assert heights == sorted(set(heights))
    assert heights[-1] < 0.0, "a viewer's grid is at 0"


def box(marker: Marker) -> tuple[float, float, float, float]:
    """The area of a marker's points."""
    xs, ys = [each.x for each in marker.points], [each.y for each in marker.points]
    return min(xs), min(ys), max(xs), max(ys)


def test_walls_and_what_stands_are_told_once(heard: dict[str, Any]) -> None:
    low, high = of(heard["walls"], "walls")
    assert [(each.type, len(each.points)) for each in (low, high)] == [(Marker.LINE_LIST, 6), (Marker.LINE_LIST, 2)]
    assert (colour(low), colour(high), high.points[0].z) == ("#647084", "#ff0000", 0.4)
    faces = of(heard["walls"], "wall_faces")
    assert [max(point.z for point in each.points) for each in faces] == [1.0, 0.4]
    (stone,) = of(heard["walls"], "obstacles")
    assert (stone.type, stone.scale.x, stone.pose.position.x, colour(stone)) == (Marker.CYLINDER, 0.4, 1.0, "#0000ff")
    assert (stone.scale.z, stone.pose.position.z) == (0.8, 0.4), "it stands on the floor"
    assert all(each.header.frame_id == "map" for each in heard["walls"][1:])


def test_what_moves_is_told_where_it_is(heard: dict[str, Any]) -> None:
    pushed, mover = of(heard["objects"], "obstacles")
    assert (pushed.type, pushed.scale.x, mover.type) == (Marker.CUBE, 0.4, Marker.TRIANGLE_LIST)
    for _ in range(50):
        heard["simulation"].step()
    before = heard["count"]
    spin_until(heard["executor"], lambda: heard["count"] > before)
    assert of(heard["objects"], "obstacles")[1].pose.position.y == pytest.approx(1.5, abs=0.05)


def test_a_robot_is_drawn_in_its_own_frame(heard: dict[str, Any]) -> None:
    (robot,) = of(heard["objects"], "robots")
    assert (robot.header.frame_id, robot.frame_locked, robot.scale.z) == ("base_link", True, 0.3)
    heard["simulation"].delete("bob")
    spin_until(heard["executor"], lambda: not of(heard["objects"], "robots"))


def test_a_reset_shows_everything_where_it_was(heard: dict[str, Any]) -> None:
    begin = heard["objects"]
    for _ in range(50):
        heard["simulation"].step()
    spin_until(heard["executor"], lambda: heard["objects"] != begin)
    heard["simulation"].reset()
    spin_until(heard["executor"], lambda: heard["objects"] == begin)


def test_nothing_is_told_again_while_nothing_moves(heard: dict[str, Any]) -> None:
    before = heard["count"]
    heard["shapes"].publish()
    spin_until(heard["executor"], lambda: heard["executor"].context.time.steady() > 1_000_000_000)
    assert heard["count"] == before


@pytest.mark.slow
@pytest.mark.parametrize("path", WORLDS, ids=lambda path: path.stem)
def test_colours_are_those_of_world_draw(path: Path) -> None:
    description = load_world(path)
    scenery = Scenery(description)
    drawn = drawn_colours(description)
    for markers, groups in ((scenery.floor(), ("floor", "paint")), (scenery.walls(), ("walls", "obstacles"))):
        for each in markers.markers:
            if each.ns in groups:
                assert colour(each) in drawn, (each.ns, colour(each))


def drawn_colours(description: WorldDescription) -> set[str]:
    """The colours in which matplotlib draws a world."""
    pytest.importorskip("matplotlib")
    import numpy as np
    from matplotlib.colors import to_hex
    from matplotlib.figure import Figure

    axes: Any = Figure().add_subplot()
    draw_world(axes, description)
    found = {to_hex(axes.get_facecolor()), *(to_hex(each.get_facecolor()) for each in axes.patches)}
    found |= {to_hex(each) for lines in axes.collections for each in lines.get_colors()}
    for image in axes.images:
        red, green, blue = np.moveaxis(np.asarray(image.get_array()).astype(int), 2, 0)
        found |= {f"#{each:06x}" for each in np.unique(red << 16 | green << 8 | blue).tolist()}
    return found


def test_the_left_of_a_sign_is_at_the_left_of_who_looks_at_its_face(tmp_path: Path) -> None:
    left_red, top_green = [(255, 0, 0), (255, 255, 255)], [(0, 128, 0), (0, 128, 0)]
    write_picture(tmp_path / "sign.png", [top_green, left_red, left_red])
    file = tmp_path / "world.yaml"
    file.write_text(
        "signs: [{image: sign.png, pose: [1, 2, 1.5708], size: 0.4, z: 0.5}]\n"
        "walls: [{polyline: [[0, 0], [4, 0]]}]\nrobots: [{name: bob, pose: [2, 1]}]"
    )
    walls = Scenery(load_world(file)).walls().markers
    (sign,), (pole,) = of(walls, "signs"), of(walls, "poles")
    assert (sign.pose.position.x, sign.pose.position.y, sign.pose.position.z, sign.text) == (1, 2, 0.5, "sign")
    assert (sign.pose.orientation.z, sign.pose.orientation.w) == pytest.approx((0.7071, 0.7071), abs=1e-4)
    # it looks to +y: who looks at it looks to -y, and has -x at the right
    assert seen_at(sign, 0.15, -0.1) == "#ffffff"
    assert seen_at(sign, -0.15, -0.1) == "#ff0000", "y grows to the right of who looks"
    assert seen_at(sign, 0.0, 0.25) == "#008000", "it is 0.6 m high"
    assert all(point.x > 0.0 for point in sign.points), "in front of the wall"
    assert (pole.type, pole.pose.position.x) == (Marker.CYLINDER, 1.0)
    assert pole.scale.z == pytest.approx(0.2)


def write_picture(path: Path, rows: list[list[tuple[int, int, int]]]) -> None:
    """Write a picture of a few pixels, each of them 20 times as large."""
    import numpy as np

    cv2 = pytest.importorskip("cv2")
    pixels = np.repeat(np.repeat(np.array(rows, np.uint8), 20, 0), 20, 1)
    assert cv2.imwrite(str(path), pixels[:, :, ::-1])


def seen_at(sign: Marker, y: float, z: float) -> str:
    """The colour of a sign at a place of it: that of the last triangle there, as viewers from above paint it."""
    found = ""
    for index in range(0, len(sign.points), 3):
        corners = [(each.y, each.z) for each in sign.points[index : index + 3]]
        sides = zip(corners, corners[1:] + corners[:1], strict=True)
        turns = [(q[0] - p[0]) * (z - p[1]) - (q[1] - p[1]) * (y - p[0]) for p, q in sides]
        if min(turns) >= 0 or max(turns) <= 0:
            at = sign.colors[index]
            found = hex_of((round(255 * at.r), round(255 * at.g), round(255 * at.b)))
    return found


def test_signs_stand_on_things_and_drive_along(virtual: Context, tmp_path: Path) -> None:
    file = tmp_path / "world.yaml"
    file.write_text("""
obstacles:
  - {box: [0.2, 0.2], pose: [1, 1, 1.5708], signs: [{tag: 36h11/1, pose: [0.1, 0, 0]}]}
  - {box: [0.2, 0.2], pose: [2, 1, 1.5708], mass: 1, signs: [{tag: 36h11/2, pose: [0.1, 0, 0]}]}
robots: [{name: bob, pose: [3, 1], signs: [{tag: 36h11/3, pose: [-0.1, 0, 3.1416], z: 0.2, size: 0.08}]}]
""")
    description = load_world(file)
    simulation, scenery = Simulation(Node("world", context=virtual), description, 0), Scenery(description)
    (still,) = of(scenery.walls().markers, "signs")
    pushed, driven = of(scenery.objects(simulation).markers, "signs")
    assert (still.text, pushed.text, driven.text) == ("36h11/1", "36h11/2", "36h11/3")
    assert (still.header.frame_id, pushed.header.frame_id, driven.header.frame_id) == ("map", "map", "base_link")
    assert (still.pose.position.x, still.pose.position.y) == pytest.approx((1.0, 1.1), abs=1e-4)
    assert (pushed.pose.position.x, pushed.pose.position.y) == pytest.approx((2.0, 1.1), abs=1e-4)
    assert (driven.pose.position.x, driven.frame_locked) == (-0.1, True)
    assert not of(scenery.walls().markers, "poles")


@pytest.mark.parametrize("path", WORLDS, ids=lambda path: path.stem)
def test_messages_are_small(path: Path) -> None:
    scenery = Scenery(load_world(path))
    assert len(encode(scenery.floor())) < 50_000
    assert len(encode(scenery.walls())) < (300_000 if path.stem == "signs" else 60_000)


def test_a_picture_on_many_signs_is_made_into_rectangles_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Picture] = []

    def counted(picture: Picture, *options: int) -> Mosaic:
        made.append(picture)
        return mosaic(picture, *options)

    monkeypatch.setattr(signs, "mosaic", counted)
    write_picture(tmp_path / "one.png", [[(255, 0, 0)]])
    write_picture(tmp_path / "two.png", [[(0, 0, 255), (255, 0, 0)]])
    file = tmp_path / "world.yaml"
    names = ["one", "two", "one", "two", "one"]
    file.write_text(
        "signs:\n" + "".join(f"  - {{image: {each}.png, pose: [{x}, 1]}}\n" for x, each in enumerate(names))
    )
    shown = of(Scenery(load_world(file)).walls().markers, "signs")
    assert [each.text for each in shown] == names
    assert len(made) == 2


def test_a_picture_that_has_gone_leaves_a_plain_plate(tmp_path: Path) -> None:
    write_picture(tmp_path / "gone.png", [[(255, 0, 0)]])
    file = tmp_path / "world.yaml"
    file.write_text("signs: [{image: gone.png, pose: [1, 2]}]\nworld: {floor: {image: gone.png, resolution: 0.01}}")
    description = load_world(file)
    scenery = Scenery(description)
    (tmp_path / "gone.png").unlink()
    pictures._known.clear()
    (sign,) = of(scenery.walls().markers, "signs")
    assert len(sign.points) == 6
    assert not of(scenery.floor().markers, "floor")


def test_the_floors_picture_lies_where_the_world_file_has_it(tmp_path: Path) -> None:
    write_picture(tmp_path / "mat.png", [[(255, 0, 0), (255, 255, 255), (255, 255, 255)]])
    file = tmp_path / "world.yaml"
    file.write_text(
        "world: {floor: {colour: '#102030', image: mat.png, resolution: 0.01, origin: [1, 2]}}\n"
        "walls: [{polyline: [[0, 0], [1.2, 0]]}]"
    )
    ground, mat = of(Scenery(load_world(file)).floor().markers, "floor")
    assert colour(ground) == "#102030"
    assert box(ground) == pytest.approx((0.0, -0.5, 1.6, 2.2))
    assert (mat.pose.position.x, mat.pose.position.y) == (1, 2)
    assert box(mat) == pytest.approx((0.0, 0.0, 0.6, 0.2))
    assert ground.pose.position.z < mat.pose.position.z < 0
    red = {round(each.x, 6) for each, tint in zip(mat.points, mat.colors, strict=True) if not tint.g}
    assert red == {0.0, 0.2}


def test_the_floor_of_a_room_ends_at_its_walls(tmp_path: Path) -> None:
    room = "[[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]"
    crossed = "[[0, 0], [4, 4], [4, 0], [0, 4]]"
    for walls, area in ((room, 12.0), (crossed, 16.0)):
        text = f"world: {{floor: {{colour: red}}}}\nwalls: [{{polyline: {walls}, closed: true}}]"
        (ground,) = of(Scenery(load_world(tmp_path / "w.yaml", text=text)).floor().markers, "floor")
        corners = [(each.x, each.y) for each in ground.points]
        assert sum(signed_area(corners[at : at + 3]) for at in range(0, len(corners), 3)) == pytest.approx(area)
