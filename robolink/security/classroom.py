"""A class: one robot, many students, and a folder of keys for each: all see the robot, and drive it in turn."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from robolink.exceptions import SecurityError
from robolink.security import files, patterns
from robolink.security.keystore import CERTIFICATE, EVERYTHING, KEY, PERMISSIONS, ROUTER, Keystore
from robolink.security.permissions import SERVICES, expanded
from robolink.security.policy import Profile, Rule

ROBOT, TEACHER = "/robot", "/teacher"
"""Enclaves of the robot and of the teacher, who may do everything."""

MOST = 200
"""Most students of a class."""

DRIVEN = ("/cmd_vel",)
"""Topics by which the robot is driven: a student has them when it is its turn."""

STOP = "/e_stop"
"""Topic of STOP: everybody hears it, and who drives may press and release it."""

SEEN = ("/tf", "/tf_static", "/scan", "/odom", "/map", "/clock", "/robot/*", "/robot_description", "/joint_states")
"""Topics of the robot that everybody sees, if no others are named."""

_FILES = (KEY, CERTIFICATE, PERMISSIONS, "permissions.p7s", "identity_ca.cert.pem", "permissions_ca.cert.pem")


class Class(NamedTuple):
    """Topics of a class."""

    seen: tuple[str, ...] = SEEN
    driven: tuple[str, ...] = DRIVEN


def topics_of(seen: Iterable[str], driven: Iterable[str]) -> Class:
    """Return the topics of a class; raises SecurityError for names that are none."""
    found = Class(tuple(seen), tuple(driven))
    for name in (*found.seen, *found.driven):
        if wrong := patterns.problem(name):
            raise SecurityError(f"'{name}': {wrong}")
    return found


def student(number: int) -> str:
    """Return the enclave, which is also the namespace, of a student."""
    return f"/student{number}"


def domain_of(folder: Path, domain: int) -> int:
    """Return the domain of a class, which it keeps from its beginning on; `domain` for one that is not there yet."""
    store = Keystore(folder / "keys", domain)
    return store.written_domain() if store.is_valid else domain


def make(folder: Path, students: int, topics: Class, domain: int) -> list[Path]:
    """Make the keystore of a class in `folder/keys`, and a folder beside it for the robot and for each student.

    What is there stays: a second time it adds students, and changes the topics of all.

    Args:
        folder: Folder of the class.
        students: Number of students, 1 to MOST.
        topics: Topics that they see and drive.
        domain: ROS domain of a new class.

    Returns:
        The folders to hand out, that of the robot first.
    """
    if not 1 <= students <= MOST:
        raise SecurityError(f"a class has 1 to {MOST} students, got {students}")
    store = Keystore(folder / "keys", domain_of(folder, domain))
    if not store.is_valid:
        store.create()
    for name in (ROBOT, TEACHER, ROUTER):
        store.create_enclave(name)
        store.permit(name, EVERYTHING)
    names = [student(number + 1) for number in range(students)]
    for name in names:
        store.create_enclave(name)
        if not store.is_withdrawn(name):
            store.permit(name, rules(name, topics, may_drive=False))
    return hand_out(folder, store, [ROBOT, TEACHER, ROUTER, *names])


def rules(name: str, topics: Class, *, may_drive: bool) -> list[Rule]:
    """Return the rules of a student: all in its own namespace, and of the robot what it may see, or drive too."""
    own = [Rule(kind, True, f"{name}/*") for kind in ("publish", "subscribe", "reply", "request")]
    sees = [Rule("subscribe", True, each) for each in (*topics.seen, STOP)]
    drives = [Rule("publish", True, each) for each in (*topics.driven, STOP)] if may_drive else []
    asks = [Rule("request", True, f"{ROBOT}/{each}") for each in SERVICES if not each.startswith("set_")]
    return expanded([Profile(name, "node", [*own, *sees, *drives, *asks])])


def give_turn(folder: Path, name: str, topics: Class) -> list[Path]:
    """Let one student drive, and no other; an empty `name` is for none. Returns the folders to hand out again.

    Who has been withdrawn stays so, and enclaves that belong to no student keep their permissions.

    Args:
        folder: Folder of the class.
        name: Enclave of the student, or its number.
        topics: Topics of the class.
    """
    store = Keystore(folder / "keys", domain_of(folder, 0))
    there = [each for each in store.names() if re.fullmatch(r"/student[0-9]+", each)]
    requested = student(int(name)) if name.isdigit() else name
    if requested and requested not in there:
        raise SecurityError(f"there is no student '{name}' in {store.path}: they are {', '.join(there[:5])} ...")
    if requested and store.is_withdrawn(requested):
        raise SecurityError(f"'{requested}' has been withdrawn: 'robolink security create_permission' lets it in again")
    for each in there:
        if store.is_withdrawn(each):
            continue
        store.permit(each, rules(each, topics, may_drive=each == requested))
    return hand_out(folder, store, store.names())


def hand_out(folder: Path, store: Keystore, names: Iterable[str]) -> list[Path]:
    """Write a keystore for each enclave, with its key alone and the permissions of all; return their folders."""
    known, found = store.names(), []
    for name in names:
        target = folder / name.strip("/").replace("/", "_")
        for other in known:
            copied = _FILES if other == name else (PERMISSIONS,)
            _copy(store.folder(other), target / "enclaves" / other.strip("/"), copied)
        _copy(
            store.path / "public", target / "public", ("ca.cert.pem", "identity_ca.cert.pem", "permissions_ca.cert.pem")
        )
        files.write(target / "security.env", _environment(name, store.domain).encode())
        found.append(target)
    return found


def _copy(source: Path, target: Path, names: Iterable[str]) -> None:
    files.make_folder(target, 0o755)
    for name in names:
        mode = files.PRIVATE if name == KEY else files.PUBLIC
        files.write(target / name, files.read(source / name), mode)


def _environment(name: str, domain: int) -> str:
    """Return the variables of a shell, for who is in the folder: `set -a; . ./security.env; set +a`."""
    return "\n".join(
        (
            f"ROS_DOMAIN_ID={domain}",
            "ROS_SECURITY_ENABLE=true",
            "ROS_SECURITY_STRATEGY=Enforce",
            "ROS_SECURITY_KEYSTORE=$PWD",
            f"ROS_SECURITY_ENCLAVE_OVERRIDE={name}",
            "",
        )
    )
