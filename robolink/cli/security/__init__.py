"""robolink security: keystores, enclaves and policies, with the verbs and flags of `ros2 security`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared.noun import ListedOptions
from robolink.cli.shared.output import say, tell

if TYPE_CHECKING:
    from robolink.security.keystore import Keystore

app = typer.Typer(no_args_is_help=True, help="Create keys, certificates and permissions for nodes (SROS 2).")

Root = Annotated[Path, typer.Argument(metavar="ROOT", help="Root path of the keystore.")]
Name = Annotated[str, typer.Argument(metavar="NAME", help="Name of the enclave, such as /robot/driver.")]
PolicyFile = Annotated[Path, typer.Argument(metavar="POLICY_FILE_PATH", help="Path of the policy's XML file.")]
Days = Annotated[float, typer.Option("--days", metavar="DAYS", help="Days for which the certificate is valid.")]


@app.callback()
def _noun() -> None:
    """Create keys, certificates and permissions for nodes (SROS 2)."""


@app.command("create_keystore")
def create_keystore(root: Root) -> None:
    """Create a keystore."""
    _keystore(root).create()


@app.command("create_enclave")
def create_enclave(
    root: Root,
    name: Name,
    days: Days = 3650,
    renew: Annotated[
        bool, typer.Option("--renew", help="Renew the key and certificate of an existing enclave.")
    ] = False,
) -> None:
    """Create an enclave: a key, a certificate, and permissions for everything."""
    _keystore(root).create_enclave(name, days=days, renew=renew)


@app.command("create_permission")
def create_permission(root: Root, name: Name, policy: PolicyFile) -> None:
    """Create the permissions of an enclave from a policy file."""
    from robolink.security.keystore import profiles_of

    _keystore(root).permit_profiles(name, profiles_of(policy, name))


@app.command("list_enclaves")
def list_enclaves(root: Root) -> None:
    """List the enclaves in a keystore."""
    names = _keystore(root).names()
    if names:
        say("\n".join(names))


@app.command("withdraw")
def withdraw(root: Root, name: Name) -> None:
    """Revoke all permissions of an enclave."""
    _keystore(root).withdraw(name)


@app.command("class", cls=ListedOptions)
def make_class(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of the class.")] = Path("class"),
    students: Annotated[
        int, typer.Option("--students", metavar="N", help="Number of students to create keys for.")
    ] = 0,
    turn: Annotated[
        str, typer.Option("--turn", metavar="STUDENT", help="Number of the student who may drive, or 'none'.")
    ] = "",
    see: Annotated[
        list[str] | None, typer.Option("--see", help="Topics of the robot that students may subscribe to.")
    ] = None,
    drive: Annotated[
        list[str] | None, typer.Option("--drive", help="Topics of the commands that drive the robot.")
    ] = None,
) -> None:
    """Create keys for each student of a class, or let one of them drive the robot."""
    import os

    from robolink.networks.request import domain_id
    from robolink.security import classroom

    if not students and not turn:
        raise typer.BadParameter("name --students N, or --turn STUDENT")
    topics = classroom.topics_of(see or classroom.SEEN, drive or classroom.DRIVEN)
    requested = domain_id(os.environ)
    if (domain := classroom.domain_of(folder, requested)) != requested and os.environ.get("ROS_DOMAIN_ID"):
        tell(
            f"{folder} keeps its domain, {domain}; ROS_DOMAIN_ID is {requested}."
            " Another domain needs a class of its own"
        )
    if students:
        made = classroom.make(folder, students, topics, domain)
        say(f"{folder}: folders for the robot, the teacher, a router and {students} students: {made[3]} ...")
    if turn:
        classroom.give_turn(folder, "" if turn == "none" else turn, topics)
        say(
            "nobody may drive"
            if turn == "none"
            else f"student {turn} may drive: hand out the folders of the robot, of that student and of a router again"
        )


@app.command("generate_artifacts", cls=ListedOptions)
def generate_artifacts(
    root: Annotated[
        Path | None,
        typer.Option("--keystore-root-path", "-k", help="Root path of the keystore; ROS_SECURITY_KEYSTORE by default."),
    ] = None,
    enclaves: Annotated[list[str] | None, typer.Option("--enclaves", "-e", help="Names of enclaves.")] = None,
    policies: Annotated[list[Path] | None, typer.Option("--policy-files", "-p", help="Policy files.")] = None,
) -> None:
    """Create keys and permissions from enclaves and policy files."""
    import os

    from robolink.exceptions import SecurityError
    from robolink.security.keystore import generate

    path = root or (Path(named) if (named := os.environ.get("ROS_SECURITY_KEYSTORE")) else None)
    if path is None:
        raise SecurityError("'ROS_SECURITY_KEYSTORE' isn't pointing at a valid keystore, and there is no -k")
    store = _keystore(path)
    if not store.is_valid:
        say(f"{path} is not a valid keystore, creating new keystore")
    generate(store, enclaves or (), policies or ())


@app.command("generate_policy")
def generate_policy(policy: PolicyFile) -> None:
    """Write a policy that allows what the running nodes use now."""
    from robolink.cli.security.observed import profiles_of_graph
    from robolink.cli.shared.session import looking
    from robolink.security.generating import merged, write_policy

    with looking() as context:
        found = profiles_of_graph(context)
    if not found:
        tell("No nodes detected in the ROS graph. No policy file was generated.")
        raise typer.Exit(1)
    write_policy(policy, merged(policy, found))


def _keystore(root: Path) -> Keystore:
    import os

    from robolink.networks.request import domain_id
    from robolink.security.keystore import Keystore

    return Keystore(root, domain_id(os.environ))
