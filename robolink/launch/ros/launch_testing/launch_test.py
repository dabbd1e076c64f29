"""Command launch_test: runs the tests of a file with `generate_test_description` (`launch_testing.launch_test`)."""

from __future__ import annotations

import argparse
import importlib.util
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from robolink.launch.ros.launch_testing.arguments import print_arguments_of_launch_description
from robolink.launch.ros.launch_testing.junitxml import unittestResultsToXml
from robolink.launch.ros.launch_testing.loader import LoadTestsFromPythonModule
from robolink.launch.ros.launch_testing.test_runner import LaunchTestRunner

__all__ = ["add_arguments", "main", "parse_arguments", "run"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments to `parser`."""
    parser.add_argument("launch_test_file", help="path of the launch test")
    parser.add_argument("launch_arguments", nargs="*", help="launch arguments NAME:=VALUE; the last one counts")
    parser.add_argument("--package-name", help="package that the test is of, for reports; else the file's name")
    parser.add_argument("-v", "--verbose", action="store_true", help="show what the launch does")
    parser.add_argument(
        "-s", "--show-args", "--show-arguments", action="store_true", help="show the launch arguments, run nothing"
    )
    parser.add_argument("--junit-xml", dest="xmlpath", metavar="FILE", help="write a report in JUnit's XML")


def parse_arguments(args: Sequence[str] | None = None) -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    """Return the parser of the command line, and what it has found.

    Args:
        args: The words of the command line; None takes those of the process.
    """
    parser = argparse.ArgumentParser(prog="launch_test", description="Run launch tests.")
    add_arguments(parser)
    return parser, parser.parse_intermixed_args(args)


def run(
    parser: argparse.ArgumentParser,
    args: argparse.Namespace,
    test_runner_cls: type[LaunchTestRunner] = LaunchTestRunner,
) -> int:
    """Run the tests, or show the arguments; return the exit code: 1 if a test has failed.

    Args:
        parser: Parser of the command line, for errors.
        args: What it has found.
        test_runner_cls: Class of the runner.
    """
    path = Path(args.launch_test_file).absolute()
    if not path.is_file():
        parser.error(f"there is no file {path}")
    package = args.package_name or path.stem
    whole = f"{package}.{path.stem}"
    runs = LoadTestsFromPythonModule(_loaded(path, package), name=f"{whole}.launch_tests")
    runner = test_runner_cls(test_runs=runs, launch_file_arguments=args.launch_arguments, debug=args.verbose)
    runner.validate()
    if args.show_args:
        print_arguments_of_launch_description(launch_description=runs[0].get_launch_description())
        return 0
    results: dict[Any, Any] = runner.run()
    if args.xmlpath:
        report = unittestResultsToXml(name=whole, test_results=results)
        report.write(args.xmlpath, encoding="utf-8", xml_declaration=True)
    return 0 if all(each.wasSuccessful() for each in results.values()) else 1


def _loaded(path: Path, name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def main(args: Sequence[str] | None = None) -> None:
    """Run the command and end with its exit code.

    Args:
        args: The words of the command line; None takes those of the process.
    """
    sys.exit(run(*parse_arguments(args)))


if __name__ == "__main__":
    main()
