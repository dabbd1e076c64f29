"""robolink pkg: make packages, and see which there are, where they are and what they have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.noun import ListedOptions
from robolink.cli.shared.options import choice
from robolink.cli.shared.output import say, tell
from robolink.exceptions import nearest

if TYPE_CHECKING:
    from robolink.scaffold import NewPackage
    from robolink.workspace import NodeSource

app = typer.Typer(no_args_is_help=True, help="Create packages, list them and their executables.")

Package = Annotated[
    str, typer.Argument(metavar="PACKAGE", help="Name of the package.", autocompletion=complete.package_names)
]


@app.command("create", cls=ListedOptions)
def create(
    package_name: Annotated[str, typer.Argument(metavar="PACKAGE", help="Name of the package, such as my_robot.")],
    build_type: Annotated[str, choice("--build-type", ["ament_cmake", "ament_python"], "Build type")] = "ament_cmake",
    node_name: Annotated[
        str, typer.Option("--node-name", metavar="NAME", help="Name of a first executable, in Python.")
    ] = "",
    library_name: Annotated[str, typer.Option("--library-name", metavar="NAME", help="Name of a first library.")] = "",
    dependencies: Annotated[
        list[str] | None, typer.Option("--dependencies", metavar="PACKAGE...", help="Dependencies of the package.")
    ] = None,
    description: Annotated[
        str, typer.Option("--description", help="Description for package.xml.")
    ] = "TODO: Package description",
    license_: Annotated[
        str,
        typer.Option("--license", metavar="ID", help="License, such as MIT, with its file LICENSE; '?' lists them."),
    ] = "TODO: License declaration",
    maintainer_name: Annotated[
        str, typer.Option("--maintainer-name", help="Name of the maintainer, for package.xml.")
    ] = "",
    maintainer_email: Annotated[
        str, typer.Option("--maintainer-email", help="Email address of the maintainer, for package.xml.")
    ] = "",
    package_format: Annotated[str, choice("--package-format", ["2", "3"], "Format of package.xml")] = "3",
    destination: Annotated[
        Path, typer.Option("--destination-directory", metavar="FOLDER", help="Folder to create the package in.")
    ] = Path(),
) -> None:
    """Create a package, which runs here at once and which colcon builds."""
    from robolink.scaffold import NewPackage, known_licenses, new_package

    if license_ == "?":
        say("\n".join(["Supported licenses:", *known_licenses()]))
        return
    user = maintainer_name or _user()
    email = maintainer_email or f"{user}@todo.todo"
    requested = NewPackage(
        package_name, build_type, int(package_format), description, license_, user, email,
        tuple(dependencies or ()), node_name, library_name,
    )  # fmt: skip
    made = new_package(requested, destination.absolute())
    _tell_of(requested, destination, made.files)


def _tell_of(requested: NewPackage, destination: Path, files: list[str]) -> None:
    say("going to create a new package")
    facts = {
        "package name": requested.name,
        "destination directory": destination.absolute(),
        "package format": requested.package_format,
        "version": "0.0.0",
        "description": requested.description,
        "maintainer": [f"{requested.maintainer} <{requested.email}>"],
        "licenses": [requested.license],
        "build type": requested.build_type,
        "dependencies": list(requested.dependencies),
        **({"node_name": requested.node} if requested.node else {}),
        **({"library_name": requested.library} if requested.library else {}),
    }
    for name, value in facts.items():
        say(f"{name}: {value}")
    say(f"creating folder ./{requested.name}")
    for each in files:
        say(f"creating ./{requested.name}/{each}")
    if requested.license.startswith("TODO"):
        tell("say under which licence others may use it: <license> in package.xml, and a file LICENSE")
    elif "LICENSE" not in files:
        from robolink.scaffold import known_licenses

        known = known_licenses()
        hint = nearest(requested.license, known) or f": there is {', '.join(known)}"
        tell(f"no file LICENSE was made: robolink has no text of '{requested.license}'{hint}")
    if requested.node:
        say(f"\nnext:\n  robolink run {requested.name} {requested.node}")


def _user() -> str:
    import getpass

    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # a user without a name
        return "user"


@app.command("list")
def list_packages() -> None:
    """List the packages of the workspace, of robolink, and those that are installed."""
    from robolink.companions.ament_index import get_packages_with_prefixes

    say("\n".join(sorted(get_packages_with_prefixes())))


@app.command("prefix")
def prefix(
    package_name: Package,
    share: Annotated[bool, typer.Option("--share", help="Print its share directory instead.")] = False,
) -> None:
    """Print the prefix path of a package, which is its own folder if it was not built."""
    from robolink.companions.ament_index import get_package_prefix, get_package_share_directory

    say(get_package_share_directory(package_name) if share else get_package_prefix(package_name))


@app.command("executables")
def executables(
    package_name: Annotated[
        str,
        typer.Argument(
            metavar="PACKAGE", help="List only those of this package.", autocompletion=complete.package_names
        ),
    ] = "",
    full_path: Annotated[bool, typer.Option("--full-path", help="Print their full paths instead.")] = False,
) -> None:
    """List the executables of a package, or of all."""
    from robolink.companions.ament_index import get_package_prefix, get_packages_with_prefixes

    if package_name:
        get_package_prefix(package_name)  # raises for one that is not there
    for package in [package_name] if package_name else sorted(get_packages_with_prefixes()):
        for name, source in sorted(_executables_of(package).items()):
            if not full_path:
                say(f"{package} {name}")
            else:
                say(str(source.path))


def _executables_of(package: str) -> dict[str, NodeSource]:
    """Return the executables that a package names, those that have a counterpart, and those that were installed."""
    from robolink.workspace import find_package, named_executables, sources_of
    from robolink.workspace.installed import installed_executables

    folder = find_package(package)
    found = {each.name: each for each in (named_executables(folder) if folder is not None else ())}
    for each in (sources_of(package), installed_executables(package)):
        found = {**each, **found}
    return found


@app.command("xml")
def xml(
    package_name: Package,
    tag: Annotated[str, typer.Option("--tag", "-t", metavar="TAG", help="Tag to print, such as version.")] = "",
) -> None:
    """Print the package.xml of a package, or one of its tags."""
    from robolink.companions.ament_index import get_package_share_directory
    from robolink.documents import xmltext
    from robolink.exceptions import NotFoundError
    from robolink.system.files import read_plain

    file = Path(get_package_share_directory(package_name), "package.xml")
    if not file.is_file():
        raise NotFoundError("package.xml", package_name, (), f"{file.parent}, since the package comes with robolink")
    if not tag:
        say(read_plain(file, xmltext.LARGEST).decode("utf-8", errors="replace").rstrip())
        return
    root = xmltext.read(file)
    found = [each.text for each in root.all(tag)]
    if not found:
        raise NotFoundError("element", tag, [each.tag for each in root.children], str(file))
    say("\n".join(found))
