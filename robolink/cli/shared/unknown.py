"""Answers to a word that is not a command: what was probably meant, among commands, verbs and programs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from robolink.exceptions import nearest

MOST = 3
"""Upper bound of the nouns that are named for a verb."""
OPTIONS = {"help": "--help", "version": "--version"}
OTHERS = {
    "ros2": "robolink takes the words after it, as in 'robolink topic list'; 'robolink shim ros2' writes it",
    "colcon": "nothing has to be built; 'robolink shim colcon' writes a command that says so",
    "roscore": "none is needed: nodes find each other",
}
"""Other systems' commands, each with what stands for it."""


def meant(word: str, commands: Sequence[str], verbs: Callable[[str], Iterable[str]]) -> str:
    """Return the end of an error that names the commands near a `word`; '' if none is near.

    Args:
        word: The word.
        commands: Names of the commands that help lists.
        verbs: Function that returns the verbs of a command; it is called for a verb that lacks its noun only.
    """
    if word in OTHERS:
        return f": {OTHERS[word]}"
    if word in OPTIONS:
        return f" (did you mean '{OPTIONS[word]}'?)"
    begun = [each for each in commands if len(word) > 2 and each.startswith(word)]
    if len(begun) == 1:
        return f" (did you mean '{begun[0]}'?)"
    nouns = [each for each in commands if word in verbs(each)]
    if nouns:
        shown = ", ".join(f"'{each} {word}'" for each in nouns[:MOST])
        return f" (did you mean {shown}{' ...' if len(nouns) > MOST else ''}?)"
    return _program(word) or nearest(word, commands)


def _program(word: str) -> str:
    """Return the command for the node, launch file or program of this name, or what serves instead; else ''."""
    from robolink.workspace import instead_of, list_launches, list_nodes, program_names

    if word in program_names() or word in [each.name for each in list_nodes()]:
        return f" (did you mean 'run {word}'?)"
    if word in [each.stem for each in list_launches()]:
        return f" (did you mean 'launch {word}'?)"
    advice = instead_of(word)
    return "" if advice is None else f": {advice}"
