"""Workflows and the Dockerfile: they parse, actions are pinned, permissions are small, and what they run is there.

None of them can be run here; what can be read is checked.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[2]
FILES = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
PYPROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
DOCKERFILE = (ROOT / "Dockerfile").read_text(encoding="utf-8")
SUPPORTED = re.findall(r"Python :: (3\.\d+)", PYPROJECT)


def workflow(path: Path) -> dict[Any, Any]:
    read: dict[Any, Any] = yaml.safe_load(path.read_text(encoding="utf-8"))
    return read


RELEASE = workflow(ROOT / ".github" / "workflows" / "release.yml")


def steps(job: dict[str, Any], key: str) -> list[str]:
    return [each[key] for each in job["steps"] if key in each]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_actions_are_pinned_by_hash_and_say_their_version(path: Path) -> None:
    lines = [each for each in path.read_text(encoding="utf-8").splitlines() if "uses:" in each]
    assert len(lines) == sum(len(steps(job, "uses")) for job in workflow(path)["jobs"].values()) > 0
    pinned = re.compile(r"^ +(?:- )?uses: [\w-]+/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+$")
    assert [each for each in lines if not pinned.match(each)] == []
    versions = {(each.split("@")[0].split()[-1], each.partition("@")[2]) for each in lines}
    assert len({name for name, _ in versions}) == len(versions)  # one version of each action


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_jobs_may_read_and_end_in_time(path: Path) -> None:
    read = workflow(path)
    assert read["permissions"] == {"contents": "read"}
    assert [name for name, job in read["jobs"].items() if "timeout-minutes" not in job] == []
    assert [name for name, job in read["jobs"].items() if "permissions" in job] in ([], ["publish"])
    for job in read["jobs"].values():
        checkouts = [each for each in job["steps"] if "checkout@" in each.get("uses", "")]
        assert [each for each in checkouts if each["with"]["persist-credentials"] is not False] == []
    assert "secrets." not in path.read_text(encoding="utf-8")


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_what_jobs_run_is_there(path: Path) -> None:
    commands = "\n".join(line for job in workflow(path)["jobs"].values() for line in steps(job, "run"))
    named = re.findall(r"(?:tools/\w+\.py|\.ci/run)", commands)
    assert named
    assert [each for each in named if not (ROOT / each).is_file()] == []
    assert "${{" not in commands  # what others write does not get into a shell


def test_the_wheel_is_tried_on_every_system_and_python() -> None:
    matrix = RELEASE["jobs"]["wheel"]["strategy"]["matrix"]
    assert matrix["python"] == SUPPORTED == ["3.10", "3.11", "3.12", "3.13", "3.14"]
    systems = [re.split(r"-\d", each)[0] + ("-arm" if each.endswith("-arm") else "") for each in matrix["os"]]
    assert systems == ["ubuntu", "ubuntu-arm", "windows", "macos", "macos"]


def test_a_tag_alone_publishes_by_trusted_publishing_after_all_else() -> None:
    jobs = RELEASE["jobs"]
    publish = jobs["publish"]
    assert RELEASE[True] == {"push": {"tags": ["v*"]}, "workflow_dispatch": None}  # `on` is a boolean in YAML 1.1
    assert publish["if"] == "github.ref_type == 'tag'"
    assert publish["permissions"] == {"id-token": "write"}
    assert publish["environment"] == "pypi"
    assert sorted(publish["needs"]) == sorted(set(jobs) - {"publish"})
    assert [each.partition("@")[0] for each in steps(publish, "uses")] == [
        "actions/download-artifact",
        "pypa/gh-action-pypi-publish",
    ]
    assert "password" not in str(publish)
    build = steps(jobs["build"], "run")
    assert build.index("python -m twine check --strict dist/*") == len(build) - 1
    assert build[0].startswith("python tools/release.py ")


def test_the_image_is_slim_has_no_root_and_says_that_nobody_built_it() -> None:
    stages = re.findall(r"^FROM (\S+)", DOCKERFILE, re.MULTILINE)
    assert stages == ["python:3.13-slim"] * 2
    _, _, last = DOCKERFILE.rpartition("FROM ")
    users = re.findall(r"^USER (\S+)$", last, re.MULTILINE)
    assert users == ["1000"]
    assert f"--uid {users[0]}" in last
    assert last.index("USER ") < last.index("CMD ")
    assert len(re.findall(r"--no-cache-dir", DOCKERFILE)) == len(re.findall(r"pip install", DOCKERFILE))
    assert "COPY . ." not in last  # neither sources nor a .git folder are in the image
    ignored = (ROOT / ".dockerignore").read_text(encoding="utf-8").split()
    assert {".git", ".venv"} <= set(ignored)
    assert "Nobody has built this image yet" in DOCKERFILE
    wanted = re.search(r"\[([\w,]+)\]\"", last)
    assert wanted is not None
    assert set(wanted[1].split(",")) <= set(re.findall(r"^(\w+) = \[", PYPROJECT, re.MULTILINE))
