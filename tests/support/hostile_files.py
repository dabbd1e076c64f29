"""Hostile input files: they try to fill the memory, to take for ever, or to cause endless error messages.

`python -m tests.support.hostile_files` prints what each of them costs.
"""

from __future__ import annotations

import json
import os
import random
import struct
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

MEASURE = """
import json, subprocess, sys, time
began = time.monotonic()
done = subprocess.run(sys.argv[1:], stdin=subprocess.DEVNULL, capture_output=True, timeout=120)
seconds = time.monotonic() - began
try:
    import resource
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    peak, cpu = used.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3), used.ru_utime + used.ru_stime
except ImportError:  # Windows
    peak = cpu = 0.0
print(json.dumps([seconds, cpu, peak, done.returncode, done.stdout.decode(), done.stderr.decode()]))
"""
"""Runs a command from a small process: what it has in its memory counts for the command, too, until that begins."""


class Hostile(NamedTuple):
    """A file, the command that reads it, and what the answer must hold; `fill` gets the folder."""

    fill: Callable[[Path], object]
    words: tuple[str, ...]
    answer: str
    lines: int = 1


class Answer(NamedTuple):
    """What a command said, in how many seconds, those of the CPU, and the most megabytes (0 where nobody knows)."""

    seconds: float
    cpu: float
    megabytes: float
    code: int
    text: str


def ask(hostile: Hostile, folder: Path) -> Answer:
    """Write the file and run the command on it."""
    hostile.fill(folder)
    command = [sys.executable, "-m", "robolink", "--network", "off", *hostile.words]
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", MEASURE, *command],
        cwd=folder,
        stdout=subprocess.PIPE,
        check=True,
        timeout=150,
    )
    seconds, cpu, megabytes, code, out, err = json.loads(done.stdout)
    return Answer(seconds, cpu, megabytes, code, err + out)


def text(name: str, content: str) -> Callable[[Path], object]:
    """Fill a folder with one file."""
    return lambda folder: (folder / name).write_text(content, encoding="utf-8")


def launch(content: str, answer: str, lines: int = 1, *, how: str = "--graph") -> Hostile:
    return Hostile(text("a.yaml", content), ("launch", "./a.yaml", how), answer, lines)


def _listed(item: str, count: int) -> str:
    return "nodes:\n" + "".join(f"- {item.replace('#', str(number))}\n" for number in range(count))


def _levels(last: str, way: Callable[[str], str]) -> str:
    levels = "".join(f"  a{n}: {way(f'{{a{n - 1}}}')}\n" for n in range(1, 10))
    return f"arguments:\n  a0: xxxxxxxxxx\n{levels}nodes: [{{node: world, {last}}}]\n"


def _fan(folder: Path) -> None:
    for level in range(9):
        includes = ", ".join(f"{{file: f{level + 1}.yaml, namespace: n{each}}}" for each in range(10))
        (folder / f"f{level}.yaml").write_text(f"include: [{includes}]")
    (folder / "f9.yaml").write_text("nodes: [{node: world}]")


def _empty_fan(folder: Path) -> None:
    _fan(folder)
    (folder / "f9.yaml").write_text("nodes: [{node: world, if: false}]")


def _chain(folder: Path) -> None:
    for number in range(1_000):
        (folder / f"f{number}.yaml").write_text(f"include: [{{file: f{number + 1}.yaml}}]")
    (folder / "f1000.yaml").write_text("nodes: [{node: world}]")


def _includes_fifo(folder: Path) -> None:
    if sys.platform != "win32":
        os.mkfifo(folder / "b.yaml")
    (folder / "a.yaml").write_text("include: [{file: b.yaml}]")


COUNTED = "{count: 100, namespace: 'n{i}', #}"
GROUPS = COUNTED.replace("#", f"groups: [{COUNTED.replace('#', f'groups: [{COUNTED}]')}]")
LAUNCH_FILES = {
    "text that grows": launch(_levels("name: '{a9}'", lambda name: f'"{name * 10}"'), "more than 1,000,000 characters"),
    "the same, looked at": launch(
        _levels("name: '{a9}'", lambda name: f'"{name * 10}"'), "more than 1,000,000", 2, how="--validate"
    ),
    "lists that grow": launch(
        _levels("parameters: {a: '{a9}'}", lambda name: "[" + f'"{name}",' * 10 + "]"), "more than 1,000,000 characters"
    ),
    "copies of a long text": launch(
        f"nodes: [{{node: world, count: 900, name: 'w{{i}}', parameters: {{a: {'y' * 1_000_000}}}}}]",
        "all texts together, with those of the copies, have more than 20,000,000 characters",
    ),
    "aliases of a long text": launch(
        f"nodes: [{{node: world, parameters: {{a: &a {'y' * 4_000_000}, b: [{'*a, ' * 90_000}]}}}}]",
        "all texts together",
    ),
    "300,000 lines": launch(_listed("node: world\n  name: a", 150_000), "a.yaml:40000:9: more than 100000 values"),
    "30,000 equal names": launch(_listed("node: world", 30_000), "more than 1,000 processes"),
    "1,000 equal names": launch(_listed("node: world", 1000), "and 979 more mistakes", 22, how="--validate"),
    "30,000 unknown nodes": launch(_listed("node: x#", 30_000), "and 80 more mistakes", 22, how="--validate"),
    "45,000 unknown keys": launch(
        "nodes:\n- node: world\n" + "".join(f"  k{n}: 1\n" for n in range(45_000)), "unknown key 'k0' in a node"
    ),
    "45,000 parameters": launch(
        "nodes:\n- node: world\n  parameters:\n" + "".join(f"    k{n}: 1\n" for n in range(45_000)),
        "more than 10,000 parameters for one node",
    ),
    "45,000 remappings": launch(
        "nodes:\n- node: world\n  remappings:\n" + "".join(f"    k{n}: k\n" for n in range(45_000)),
        "more than 1,000 remappings",
    ),
    "a million copies": launch(
        "groups: [" + GROUPS.replace("#", "nodes: [{node: world}]") + "]", "more than 1,000 processes"
    ),
    "a million copies of nothing": launch(
        "groups: [" + GROUPS.replace("#", "nodes: [{node: world, if: false}]") + "]",
        "more than 20,000 nodes, groups and includes",
    ),
    "a fan of includes": Hostile(_fan, ("launch", "./f0.yaml", "--graph"), "more than 1,000 processes"),
    "a fan of nothing": Hostile(_empty_fan, ("launch", "./f0.yaml", "--graph"), "more than 2,000 files are included"),
    "a chain of includes": Hostile(_chain, ("launch", "./f0.yaml", "--graph"), "files are included over 50 deep"),
    "an integer of 100,000 digits": launch(
        f"nodes: [{{node: world, parameters: {{a: 0x{'9' * 100_000}}}}}]", "a.yaml:1:39: '0x999"
    ),
    "100,000 levels": launch("[" * 100_000, "nested more than 64 levels deep"),
    "6 MB": launch("#" * 6_000_000, "it is longer than 5 MB"),
    "an include of a FIFO": Hostile(
        _includes_fifo, ("launch", "./a.yaml", "--graph"), "b.yaml: cannot be read: it is a FIFO, and no file"
    ),
}
"""What launch files may do."""

MAP = "image: {}\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n"


def mapped(fill: Callable[[Path], object], answer: str) -> Hostile:
    """Check a world with a map whose image, `image`, `fill` makes."""

    def whole(folder: Path) -> None:
        (folder / "m.yaml").write_text(MAP.format("image"))
        (folder / "a.yaml").write_text("map: {yaml: m.yaml}")
        fill(folder / "image")

    return Hostile(whole, ("world", "check", "./a.yaml"), answer)


def world(content: str, answer: str, lines: int = 1) -> Hostile:
    return Hostile(text("a.yaml", content), ("world", "check", "./a.yaml"), answer, lines)


def webots(content: str, answer: str) -> Hostile:
    return Hostile(
        text("a.wbt", f"#VRML_SIM R2023b utf8\nWorldInfo {{}}\n{content}"), ("world", "check", "./a.wbt"), answer
    )


SOLID = "Solid { translation 0 0 .05 physics Physics { mass 1 } boundingObject Box { size .1 .1 .1 } }\n"


def png(width: int, height: int, colour: int, depth: int, bytes_a_pixel: int, filtering: int = 0) -> bytes:
    """Make a PNG whose pixels are all alike, as they are stored."""
    packer = zlib.compressobj(1)
    line = bytes([filtering]) + b"\x55" * (width * bytes_a_pixel)
    packed = b"".join(packer.compress(line) for _ in range(height)) + packer.flush()
    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", packed), (b"IEND", b""))
    parts = (
        (struct.pack(">I", len(body)), kind, body, struct.pack(">I", zlib.crc32(kind + body))) for kind, body in chunks
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(b"".join(each) for each in parts)


EMPTY_CHUNK = b"\0\0\0\0IDAT" + struct.pack(">I", zlib.crc32(b"IDAT"))


def _mkfifo(path: Path) -> None:
    if sys.platform != "win32":
        os.mkfifo(path)


def _noise(path: Path) -> None:
    path.write_bytes(b"P5 5000 5000 255\n" + random.Random(1).randbytes(100_000) * 250)


def _obstacles(count: int, *, apart: float) -> str:
    places = (f"[{apart * (n % 70)}, {apart * (n // 70)}]" for n in range(count))
    return "obstacles:\n" + "".join(f"- {{circle: 0.1, pose: {each}}}\n" for each in places)


WORLDS = {
    "a map's image is a FIFO": mapped(_mkfifo, "'image' cannot be read: it is a FIFO, and no file"),
    "a map's image is a device": mapped(
        lambda path: path.symlink_to("/dev/zero"), "'image' cannot be read: it is a device, and no file"
    ),
    "100 million pixels of 8 bytes": mapped(
        lambda path: path.write_bytes(png(10_000, 10_000, 6, 16, 8)), "10000 x 10000 pixels: expected 1 to 25 million"
    ),
    "7 million pixels of 8 bytes": mapped(
        lambda path: path.write_bytes(png(2_600, 2_600, 6, 16, 8)), "2600 x 2600 pixels of 64 bits: at most 50 MB"
    ),
    "an image that is a secret": mapped(
        lambda path: path.write_text("root:secret"), "neither PGM (P2, P5) nor PNG: save it as one of these"
    ),
    "25 million pixels of noise": mapped(_noise, "is the map all noise?"),
    "a PNG of 3 million chunks": mapped(
        lambda path: path.write_bytes(png(100, 100, 0, 8, 1)[:33] + EMPTY_CHUNK * 3_000_000), "more than 100,000 chunks"
    ),
    "a PGM of 2 million comments": mapped(
        lambda path: path.write_bytes(b"P5\n" + b"#\n" * 2_000_000 + b"1 1 255\n "),
        "after P5 a PGM has its width, height and largest value",
    ),
    "200,000 obstacles": world(_obstacles(200_000, apart=0.5), "cannot be read: it is longer than 5 MB"),
    "14,000 obstacles": world(_obstacles(14_000, apart=0.5), "obstacles: expected list of length <= 5000"),
    "5,000 in one place": world(_obstacles(5_000, apart=0.0), "over 30,000 shapes meet others", 7),
    "12,000 walls": world(
        "walls:\n" + "".join(f"- polyline: [[{n}, 0], [{n}, 5]]\n" for n in range(10_100)),
        "walls: expected list of length <= 10000",
    ),
    "9,000 wrong walls": world(
        "walls:\n" + "".join(f"- [[{n}, 0], [{n}, 5]]\n" for n in range(9_000)), "and many more mistakes", 21
    ),
    "Webots: 5,000 in one place": webots(SOLID * 5_000, "this starts inside of Solid: move it out of there"),
    "Webots: 15,000 solids": webots(SOLID * 15_000, "more than 5,000 solids"),
    "Webots: 30,000 solids": webots(SOLID * 30_000, "more than 500,000 words"),
    "Webots: 90,000 levels": webots("Group { children [ " * 90_000, "more than 60 nodes are inside of each other"),
    "Webots: groups that grow": webots(
        "".join(f"DEF A{n} Group {{ children [ {f'USE A{n - 1} ' * 10 if n else ''}] }}\n" for n in range(12)),
        "more than 100000 nodes",
    ),
    "Webots: 2.9 million numbers": webots("Solid { translation " + "1 " * 2_900_000, "more than 500,000 words"),
    "Webots: 7 MB": webots("#" * 7_000_000, "cannot be read: it is longer than 6 MB"),
}
"""What worlds and their maps may do."""


def package(file: str, content: str, name: str = "p", answer: str = "no node named") -> Hostile:
    """Look for a program in a package, one of whose files is this one."""

    def fill(folder: Path) -> None:
        (folder / "src" / "p").mkdir(parents=True)
        (folder / "src/p/package.xml").write_text("<package><name>p</name></package>")
        (folder / "src/p" / file).write_text(content)

    return Hostile(fill, ("run", name, "program"), answer)


def node(fill: Callable[[Path], object], words: str, answer: str, lines: int = 1) -> Hostile:
    """Meet a node's file in a workspace, `nodes/x.py`."""

    def whole(folder: Path) -> None:
        for part in ("nodes", "configs"):
            (folder / part).mkdir()
        fill(folder / "nodes/x.py")

    return Hostile(whole, tuple(words.split()), answer, lines)


def _names_of_lists(of: str) -> str:
    levels = "".join(f"a{n} = {of.replace('#', f'a{n - 1}')}\n" for n in range(1, 15))
    return f"a0 = 'xxxxxxxxxx'\n{levels}setup(entry_points={{'console_scripts': a14}})\n"


SCRIPTS = "setup(entry_points={'console_scripts': [#]})\n"
PROGRAMS = {
    "CMake: install without an end": package("CMakeLists.txt", "install(PROGRAMS " * 11_000),
    "setup.py: a program and spaces": package("setup.py", SCRIPTS.replace("#", f"'a=b{' ' * 190_000}x'")),
    "setup.cfg: a program and spaces": package(
        "setup.cfg", f"[options.entry_points]\nconsole_scripts =\n  a=b{' ' * 190_000}x\n"
    ),
    "pyproject.toml: empty lines": package("pyproject.toml", "[project.scripts]\nx" + "\n" * 190_000 + "x"),
    "setup.py: names of lists": package("setup.py", _names_of_lists("[" + "#," * 10 + "]")),
    "setup.py: names of texts": package("setup.py", _names_of_lists("f'" + "{#}" * 10 + "'")),
    "setup.py: 8,000 calls": package(
        "setup.py",
        "e = {'console_scripts': [" + "'a'," * 1000 + "]}\n" + "setup(entry_points=e)\n" * 8_000,
    ),
    "setup.py: 49,000 statements": package("setup.py", "a=1\n" * 49_000),
    "setup.py: 1 MB": package("setup.py", "a=1;" * 260_000),
    "setup.cfg: 13,000 programs": package(
        "setup.cfg",
        "[options.entry_points]\nconsole_scripts =\n" + "".join(f"  a{n}=b:c\n" for n in range(13_000)),
        answer="no executable named 'program' in package p",
    ),
    "a node's file is a FIFO": node(_mkfifo, "run x", "cannot be read: it is a FIFO, and no file"),
    "a node's file nests": node(lambda path: path.write_text("-" * 3_000_000 + "1"), "run x", "x.py: cannot be read: "),
}
"""What packages and nodes may do, whose files are looked into before anything runs."""

ALL = {**LAUNCH_FILES, **WORLDS, **PROGRAMS}


def main() -> None:
    """Print a table of what each file costs."""
    for name, hostile in ALL.items():
        with tempfile.TemporaryDirectory() as folder:
            seconds, cpu, megabytes, code, said = ask(hostile, Path(folder))
        lines = said.count("\n")
        print(f"{name:30} {seconds:5.2f} s, CPU {cpu:5.2f} s {megabytes:4.0f} MB {lines:3} lines, exit code {code}")  # noqa: T201


if __name__ == "__main__":
    main()
