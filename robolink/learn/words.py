"""Words of `robolink learn`, in English and Portuguese."""

from __future__ import annotations

from functools import partial

from robolink.grading.languages import MISTAKES, Words, text_of

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

WORDS: Words = {
    **MISTAKES,
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
        "{file} is as it was at the beginning; yours is {saved}",
        "{file} está como no início; o seu está em {saved}",
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
    "is over": (
        "it has come to its end: is there an rclpy.spin?",
        "ele chegou ao fim: há um rclpy.spin?",
    ),
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

words = partial(text_of, WORDS)
"""Returns a text: `words(language, key, **values)`."""
