"""Languages of exercises and races, English and Portuguese: which one is used here, and the words for mistakes."""

from __future__ import annotations

import json
import locale
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Literal, get_args

from robolink.system.files import is_file

Language = Literal["en", "pt"]

LANGUAGES: tuple[Language, ...] = get_args(Language)

Words = Mapping[str, tuple[str, str]]
"""Texts by key, in the order of `LANGUAGES`."""

STUDENT_FILE = ".robolink_learn.json"
"""Name of the file by which a student's folder is known; it has the student's language."""

MISTAKES: Words = {
    "syntax": ("{file} is not valid Python at line {line}:", "{file} não é Python válido na linha {line}:"),
    "empty": (
        "{file} is empty, or has only comments",
        "{file} está vazio, ou só tem comentários",
    ),
    "exception": (
        "your program stopped with an error at line {line}:",
        "seu programa parou com um erro na linha {line}:",
    ),
    "elsewhere": ("your program stopped with an error:", "seu programa parou com um erro:"),
    "input": (
        "your program waits for the keyboard at line {line}, where a check has none: take the input() out",
        "seu programa espera o teclado na linha {line}, e um teste não tem teclado: tire o input()",
    ),
    "stuck": (
        "your program is stuck at line {line}: is there a loop that never ends or never waits?",
        "seu programa está preso na linha {line}: há um laço que nunca termina ou nunca espera?",
    ),
    "stuck somewhere": (
        "your program is stuck: is there a loop that never ends or never waits?",
        "seu programa está preso: há um laço que nunca termina ou nunca espera?",
    ),
    "too large": (
        "your program needs more than {text} of memory: is there a list that grows without end?",
        "seu programa precisa de mais de {text} de memória: há uma lista que cresce sem fim?",
    ),
    "asleep": (
        "your program sleeps at line {line} (time.sleep): while it sleeps, no callback runs",
        "seu programa dorme na linha {line} (time.sleep): enquanto dorme, nenhum callback roda",
    ),
    "ended": ("your program ended too early: {text}", "seu programa terminou cedo demais: {text}"),
    "ended all": (
        "your program ended the whole process at once: is there an os._exit?",
        "seu programa terminou o processo inteiro de uma vez: há um os._exit?",
    ),
    "file": ("{text}", "{text}"),
    "lacks": (
        "{text} is missing in {file}: the exercise asks for something by this name",
        "falta {text} em {file}: o exercício pede algo com este nome",
    ),
    "types": (
        "one topic has two types, and nothing gets from one to the other: {text}",
        "um topic tem dois tipos, e nada passa de um para o outro: {text}",
    ),
    "use": (
        "your program has something in another form than the exercise asks for: {text}",
        "seu programa tem algo de outra forma que a pedida pelo exercício: {text}",
    ),
}
"""Words for each kind of mistake."""


def text_of(table: Words, language: Language, key: str, **values: object) -> str:
    """Return a text of a table.

    Args:
        table: The table.
        language: Language of the text.
        key: Name of the text.
        values: Values for its placeholders.
    """
    return table[key][LANGUAGES.index(language)].format(**values)


def language_of(name: str) -> Language | None:
    """Return the language of a locale's name; None for any other language.

    >>> language_of("pt_BR.UTF-8"), language_of("Portuguese_Brazil"), language_of("en_GB"), language_of("C")
    ('pt', 'pt', 'en', None)
    """
    short = name.lower()[:2]
    return "pt" if short in ("pt", "po") else "en" if short == "en" else None


def default_language(environ: Mapping[str, str] | None = None) -> Language:
    """Return the language of this user's locale; English if that is none of them.

    Args:
        environ: Environment variables; None takes those of the process, and what the system says if they say nothing.
    """
    variables = os.environ if environ is None else environ
    for name in ("LC_ALL", "LC_MESSAGES", "LANG"):
        if variables.get(name):
            return language_of(variables[name]) or "en"
    return language_of(locale.getlocale()[0] or "") or "en" if environ is None else "en"


def student_file() -> Path | None:
    """Return the file of the student's folder at or above the working directory; None if there is none."""
    here = Path.cwd()
    return next((each / STUDENT_FILE for each in (here, *here.parents) if is_file(each / STUDENT_FILE)), None)


def language_here() -> Language:
    """Return the language of the student's folder at or above the working directory, else the locale's."""
    file = student_file()
    try:
        found = None if file is None else json.loads(file.read_bytes()).get("language")
    except (OSError, ValueError, AttributeError, RecursionError):
        found = None  # whoever reads the whole file says what is wrong with it
    return next((each for each in LANGUAGES if each == found), None) or default_language()
