"""Languages of the exercises, English and Portuguese: which one is spoken here, and what the commands say in each."""

from __future__ import annotations

import locale
import os
from collections.abc import Mapping
from typing import Literal, get_args

Language = Literal["en", "pt"]

LANGUAGES: tuple[Language, ...] = get_args(Language)


def language_of(name: str) -> Language | None:
    """Return the language of a locale's name, None for one that is not spoken here.

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
    asked = os.environ if environ is None else environ
    for name in ("LC_ALL", "LC_MESSAGES", "LANG"):
        if asked.get(name):
            return language_of(asked[name]) or "en"
    return language_of(locale.getlocale()[0] or "") or "en" if environ is None else "en"


_HOW_EN = """\
  read it:   robolink learn show
  run it:    robolink {verb} {file}
  try it:    robolink learn check
  a hint:    robolink learn hint
  or check at each save: robolink learn watch
  all of it in the browser: robolink learn view"""
_HOW_PT = """\
  leia:      robolink learn show
  execute:   robolink {verb} {file}
  teste:     robolink learn check
  uma dica:  robolink learn hint
  ou teste a cada vez que salvar: robolink learn watch
  tudo isso no navegador: robolink learn view"""

_WORDS: dict[str, tuple[str, str]] = {
    "heading": ("{done} of {all} exercises done", "{done} de {all} exercícios feitos"),
    "next": ("next: {file}: {title}", "próximo: {file}: {title}"),
    "how": (_HOW_EN, _HOW_PT),
    "all done": ("All exercises are done. Well driven!", "Todos os exercícios estão feitos. Muito bem!"),
    "no folder": (
        "robolink learn start    writes the exercises into a folder, to begin with",
        "robolink learn start    grava os exercícios em uma pasta, para começar",
    ),
    "no exercises": (
        "no exercises in this folder or above it: `robolink learn start` writes them into {folder}, then cd there",
        "não há exercícios nesta pasta nem acima dela: `robolink learn start` os grava em {folder}; depois, cd para lá",
    ),
    "go below": ("the exercises are in {folder}: cd {folder}", "os exercícios estão em {folder}: cd {folder}"),
    "no file": (
        "there is no {file} here: `robolink learn reset {name}` writes it again",
        "não há {file} aqui: `robolink learn reset {name}` o grava de novo",
    ),
    "no exercise": (
        "no exercise named '{name}'{nearest}",
        "não há exercício chamado '{name}'{nearest}",
    ),
    "nearest": (" (did you mean '{name}'?)", " (você quis dizer '{name}'?)"),
    "written": ("exercises in {folder}: {count}", "exercícios em {folder}: {count}"),
    "all there": ("all exercises are in {folder} already", "todos os exercícios já estão em {folder}"),
    "all here": ("all exercises are here already", "todos os exercícios já estão aqui"),
    "go": ("cd {folder}, then: robolink learn", "cd {folder}, e depois: robolink learn"),
    "reset": (
        "{file} is as it was at the beginning; yours is {kept}",
        "{file} está como no início; o seu está em {kept}",
    ),
    "reset new": ("{file} is there again", "{file} está lá de novo"),
    "hint": ("hint {number} of {all}: {text}", "dica {number} de {all}: {text}"),
    "no hints": ("this exercise has no hints", "este exercício não tem dicas"),
    "last hint": ("that was the last hint", "essa foi a última dica"),
    "done": ("{file} is done ({seconds:.1f} s)", "{file} está feito ({seconds:.1f} s)"),
    "not yet": (
        "{file} is not there yet; a hint: robolink learn hint {name}",
        "{file} ainda não está pronto; uma dica: robolink learn hint {name}",
    ),
    "printed": ("it printed:", "ele imprimiu:"),
    "more": ("... and {count} more lines", "... e mais linhas: {count}"),
    "watching": (
        "Save a file and it is checked. Ctrl-C ends.",
        "Salve um arquivo e ele é testado. Ctrl-C termina.",
    ),
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
    "is over": (
        "it has come to its end: is there an rclpy.spin?",
        "ele chegou ao fim: há um rclpy.spin?",
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
    "no program": (
        "no {text} here, nor one other Python file alone",
        "aqui não há {text}, nem um único outro arquivo Python",
    ),
    "race": ("{name}, seed {seed}: {rule}", "{name}, semente {seed}: {rule}"),
    "rule line": (
        "the time of one lap along the line, and 5 s for each contact",
        "o tempo de uma volta pela linha, e mais 5 s por contato",
    ),
    "rule maze": (
        "the time to the middle of the far corner, ({end}, {end}), and 5 s for each contact",
        "o tempo até o meio do canto oposto, ({end}, {end}), e mais 5 s por contato",
    ),
    "rule follow": (
        "metres along the wall in 120 s, 0.3 to 0.8 m away from it, less 5 m for each contact",
        "metros ao longo da parede em 120 s, de 0.3 a 0.8 m dela, menos 5 m por contato",
    ),
    "contact": ("{count} contact", "{count} contato"),
    "contacts": ("{count} contacts", "{count} contatos"),
    "progress": ("{share:.0%} of the way", "{share:.0%} do caminho"),
    "raced": ("{program} is done", "{program} terminou"),
    "made": ("made {path}", "feito: {path}"),
    "next prove": (
        "\nnext:\n  robolink learn prove {folder}    # as given it fails, and the solution passes",
        "\na seguir:\n  robolink learn prove {folder}    # o dado falha, e a solução passa",
    ),
    "next start": (
        "  robolink learn start FOLDER --from {folder}    # what a student types",
        "  robolink learn start PASTA --from {folder}    # o que um aluno digita",
    ),
    "broken check": ("the check is broken: {text}", "o teste está com defeito: {text}"),
    "passes already": (
        "{file} passes already: there is nothing to do",
        "{file} já passa: não há nada a fazer",
    ),
    "fails": ("{file} fails: {text}", "{file} falha: {text}"),
    "passes": ("{file} passes in {seconds:.1f} s", "{file} passa em {seconds:.1f} s"),
    "at line": ("{text} (line {line})", "{text} (linha {line})"),
    "told nothing": ("its check told nothing", "o teste não disse nada"),
    "check": (
        "the check of this exercise is broken, not your program: {text}",
        "o teste deste exercício está com defeito, não o seu programa: {text}",
    ),
}


def words(language: Language, key: str, **values: object) -> str:
    """Return a text of the commands.

    Args:
        language: Language of the text.
        key: Name of the text.
        values: Values for its placeholders.
    """
    return _WORDS[key][LANGUAGES.index(language)].format(**values)
