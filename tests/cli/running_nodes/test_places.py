"""The place in the line of an error is one of the user's code, never of Python's own source in C."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.running_nodes import runner
from robolink.exceptions import DocumentError
from robolink.launch.ros.launch_xml.parser import Parser


def test_the_place_of_an_error_in_xml_is_the_line_that_asked_for_it(tmp_path: Path) -> None:
    path = tmp_path / "a.launch.xml"
    path.write_text("<!DOCTYPE r [<!ENTITY a 'b'>]><launch/>")  # refused by a handler, which a parser in C calls
    with pytest.raises(DocumentError) as caught:
        Parser.load(path)
    assert runner._place(caught.value).rpartition(":")[0] == str(Path(__file__))
