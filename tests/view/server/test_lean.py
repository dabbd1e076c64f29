"""Scripts and style sheets lose what a browser does not need, and nothing else."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

import robolink.view
from robolink.view.server.lean import lean

FILES = [
    each for each in Path(str(robolink.view.__file__)).with_name("page").rglob("*") if each.suffix in {".js", ".css"}
]

READ = """
const texts = JSON.parse(require("fs").readFileSync(process.argv[1], "utf8"));
for (const [identifier, text] of Object.entries(texts)) new (require("vm").SourceTextModule)(text, { identifier });
console.log(`${Object.keys(texts).length} are modules`);
"""
"""Program for node that reads texts as modules and does not run them."""


@pytest.mark.parametrize(
    ("text", "sent"),
    [
        ("  const a = b + +c; // why", "const a = b + +c;"),
        ("\t\tf(`a // b ${c}`);", "f(`a // b ${c}`);"),
        ('f("a // b", c); // its "name"', 'f("a // b", c); // its "name"'),
        ("const address = /^http:\\/\\//;", "const address = /^http:\\/\\//;"),
        ("/** Say\n * more. */\nlet a = 1;\n  // so\n", "\n\nlet a = 1;\n\n"),
        ("a = b /* c */ + d;", "a = b /* c */ + d;"),
    ],
)
def test_comments_and_indentation_go_and_texts_stay(text: str, sent: str) -> None:
    assert lean(text.encode(), ".js").decode() == sent


def test_of_style_sheets_too() -> None:
    sheet = b"/* First. */\na { b: c }\n  .e { content: '/* ; */' }"
    assert lean(sheet, ".css") == b"\na { b: c }\n.e { content: '/* ; */' }"


def test_of_the_page_only_indentation_and_comments_go() -> None:
    assert len(FILES) > 30
    for each in FILES:
        text = each.read_text(encoding="utf-8")
        sent = lean(text.encode(), each.suffix).decode()
        for before, after in zip(text.split("\n"), sent.split("\n"), strict=True):
            gone = before.lstrip().removeprefix(after).lstrip()
            assert not gone or not after or gone.startswith("// "), before
        assert len(sent) < len(text)


def test_no_template_of_the_page_has_two_lines() -> None:
    """What is left out of a line is found out in this line alone."""
    for each in FILES:
        for line in each.read_text(encoding="utf-8").split("\n"):
            if not line.lstrip().startswith(("//", "*", "/*")):
                assert line.count("`") % 2 == 0, f"{each.name}: {line}"


@pytest.mark.processes
@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed, which reads scripts")
def test_scripts_are_read_as_before(tmp_path: Path) -> None:
    names = [each for each in FILES if each.suffix == ".js"]
    texts = {str(each): lean(each.read_bytes(), ".js").decode() for each in names}
    (tmp_path / "texts.json").write_text(json.dumps(texts), encoding="utf-8")
    command = ["node", "--experimental-vm-modules", "--no-warnings", "-e", READ, str(tmp_path / "texts.json")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, f"{len(texts)} are modules\n"), done.stderr


def test_other_files_stay_as_they_are() -> None:
    assert lean(b"<p> a , b </p>", ".html") == b"<p> a , b </p>"
