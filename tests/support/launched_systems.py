"""A small system of a talker and a listener, for tests of robolink launch."""

from __future__ import annotations

import pytest

from robolink.cli.main import main

TALKER = """
from robolink import Node
from robolink.interfaces.std_msgs.msg import String

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        word = self.declare_parameter("word", "hi").value
        print("up", word, flush=True)
        self.create_publisher(String, "chatter", 10)
"""

LISTENER = """
from robolink import Node
from robolink.interfaces.std_msgs.msg import String

class Listener(Node):
    def __init__(self):
        super().__init__("hears")
        print("listening", flush=True)
        self.create_subscription(String, "chatter", print, 10)
        self.create_service
"""

SYSTEM = """
arguments:
  word: {default: hello, description: What it says., choices: [hello, bye]}
  loud:
nodes:
- node: talker
  parameters: {word: "{word}"}
"""


def said(capsys: pytest.CaptureFixture[str], *args: str) -> tuple[int, str, str]:
    code = main(["launch", *args])
    out, err = capsys.readouterr()
    return code, out, err
