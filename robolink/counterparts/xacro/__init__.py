"""Counterpart of xacro's command: macros of XML, expanded by the package `xacro` of PyPI.

Each mistake is one line with its file, and its line where found.
"""

from __future__ import annotations

import contextlib
import importlib
import re
import sys
import warnings
from pathlib import Path
from typing import Any
from xml.parsers.expat import ErrorString, ExpatError

from robolink.counterparts.program import own_words
from robolink.documents import xmltext
from robolink.exceptions import DocumentError, RobolinkError
from robolink.system.files import read_plain
from robolink.system.terminal import shown

QUOTED = re.compile(r"'([^'\n]+)'|\"([^\"\n]+)\"|[:]\s*(\S+)")
"""Pattern of parts of a reason that are quoted from the file."""

INSTALL = "xacro is a package of its own: pip install xacro"


class XacroError(DocumentError):
    """A xacro file cannot be expanded; the text begins with its place."""


class XacroMissingError(RobolinkError, ImportError):
    """The package xacro is not installed."""


def expanded(words: list[str]) -> str:
    """Return the XML that the command `xacro` prints.

        expanded(["robot.urdf.xacro", "use_sim:=true"])

    ``$(find PACKAGE)`` is looked up as by `robolink run PACKAGE EXECUTABLE`. The package has one state for a process,
    so only one thread may expand at a time.

    Args:
        words: Arguments of the command: a file, values of arguments, and the command's options.

    Raises:
        XacroMissingError: (an ImportError) if the package xacro is not installed.
        XacroError: (a ValueError) if the file, or one that it includes, has a mistake.
        SystemExit: for words that are not arguments of xacro; the usage has been printed.
    """
    xacro = _package()
    options, file = xacro.cli.process_args(list(words))
    text = _expand(xacro, file, options)
    if options.output:
        Path(options.output).write_text(text, encoding="utf-8")
        return ""
    return text


def _package() -> Any:
    """Import xacro, and the names of ROS by which it finds packages."""
    from robolink import compat  # late: its import takes names already

    compat.activate()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # Python 3.10 warns of a part of the package
            xacro = importlib.import_module("xacro")
            importlib.import_module("xacro.cli")
    except ImportError as error:
        if (error.name or "").partition(".")[0] == "xacro":
            raise XacroMissingError(INSTALL) from None
        raise
    return xacro


def _expand(xacro: Any, file: str, options: Any) -> str:
    xmltext.read(Path(file))  # for its mistakes, which this one finds with their lines, and refuses entities
    settings = {"mappings": options.mappings, "verbosity": options.verbosity}
    try:
        document = xacro.process_file(file, **settings)
        if options.just_deps:
            return " ".join(xacro.all_includes) + "\n"
        return str(document.toprettyxml(indent="  "))
    except Exception as error:  # noqa: BLE001 - expressions in the file are Python, and raise whatever they want
        files = [each for each in xacro.filestack or () if each]
        raise _mistake(error, files[-1] if files else file) from None
    finally:
        xacro.substitution_args_context["arg"] = {}


def _mistake(error: Exception, file: str) -> XacroError:
    """Return the error of a file."""
    cause = getattr(error, "exc", None)
    if isinstance(error, RecursionError) or isinstance(cause, RecursionError):
        return XacroError("a macro or a file contains itself without end", file)
    for missing in (error, cause):
        if isinstance(missing, OSError) and missing.filename:
            name = str(missing.filename)
            return XacroError(f"{name}: {missing.strerror}", file, _line(file, f"'{Path(name).name}'"))
    for each in (error, cause):
        if isinstance(each, ExpatError):
            return XacroError(f"no XML: {ErrorString(each.code)}", file, each.lineno, each.offset + 1)
    text = str(cause if isinstance(cause, RobolinkError) else error) or type(error).__name__
    return XacroError(shown(" ".join(text.split()), 300), file, _line(file, text))


def _line(file: str, reason: str) -> int:
    """Return the first line of a file that has what a reason quotes, the longest quotation first; 0 for none."""
    with contextlib.suppress(OSError, ValueError):
        lines = read_plain(file, xmltext.LARGEST).decode(errors="replace").splitlines()
        quoted = [each.strip() for found in QUOTED.findall(reason) for each in found if each.strip()]
        for words in sorted(quoted, key=len, reverse=True) or reason.split()[-1:]:
            for number, line in enumerate(lines, 1):
                if words in line:
                    return number
    return 0


def main(args: list[str] | None = None) -> None:
    """Print the expanded file of the command line; `args` begin with the program's name."""
    sys.stdout.write(expanded(own_words(args)))
