"""robolink lifecycle: see in which states managed nodes are, and move them on."""

from __future__ import annotations

from typing import Annotated

import typer

from robolink.cli.shared import complete
from robolink.system.terminal import fit

app = typer.Typer(no_args_is_help=True, help="Show the states of lifecycle nodes, and trigger transitions.")

TRANSITIONS = ["configure", "activate", "deactivate", "cleanup", "shutdown"]
_NODE = {"metavar": "NODE", "autocompletion": complete.node_names}

Node = Annotated[str, typer.Argument(help="Name of the node, such as /camera.", **_NODE)]
Hidden = Annotated[bool, typer.Option("--include-hidden-nodes", help="Include hidden nodes, whose names begin with _.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.callback()
def _noun() -> None:
    """Show the states of lifecycle nodes, and trigger transitions."""


@app.command("nodes")
def list_nodes(
    show_all: Annotated[bool, typer.Option("--all", "-a", help="Include hidden names, which begin with _.")] = False,
    count: Annotated[bool, typer.Option("--count-nodes", "-c", help="Print only the number.")] = False,
    as_json: AsJson = False,
) -> None:
    """List the lifecycle nodes."""
    from robolink.cli.lifecycle import ask
    from robolink.cli.shared.output import say, say_json
    from robolink.cli.shared.session import looking

    with looking() as context:
        names = ask.managed(context, hidden=show_all)
    if as_json:
        say_json(names)
    elif count:
        say(str(len(names)))
    elif names:
        say("\n".join(names))


@app.command("get")
def get(
    node: Annotated[str, typer.Argument(help="Name of the node; all nodes by default.", **_NODE)] = "",
    hidden: Hidden = False,
    as_json: AsJson = False,
) -> None:
    """Print the state of a lifecycle node, or of all of them."""
    from robolink.cli.lifecycle import ask
    from robolink.cli.shared.output import say, say_json, tell
    from robolink.cli.shared.session import looking

    with looking() as context:
        names = [ask.known(context, node)] if node else ask.managed(context, hidden=hidden)
        states, failed = ask.states(context, names)
    if node and failed:
        raise failed[0]
    for error in failed:
        tell(f"robolink: {error}")
    if as_json:
        say_json({name: {"id": state.id, "label": state.label} for name, state in states.items()})
    else:
        for name, state in states.items():
            say(fit(f"{'' if node else name + ': '}{state.label} [{state.id}]", lines=False))
    if failed:
        raise typer.Exit(1)


@app.command("list")
def list_transitions(
    node: Node,
    show_all: Annotated[
        bool, typer.Option("--all", "-a", help="List all transitions, not only those of the current state.")
    ] = False,
    hidden: Hidden = False,
    as_json: AsJson = False,
) -> None:
    """List the transitions that a lifecycle node has in its current state."""
    from robolink.cli.lifecycle import ask
    from robolink.cli.shared.output import say, say_json
    from robolink.cli.shared.session import looking

    with looking() as context:
        found = ask.transitions(context, ask.known(context, node), every=show_all)
    if as_json:
        say_json([ask.as_data(each) for each in found])
        return
    for each in found:
        labels = (each.transition.label, each.start_state.label, each.goal_state.label)
        label, start, goal = [fit(label, lines=False) for label in labels]
        say(f"- {label} [{each.transition.id}]\n\tStart: {start}\n\tGoal: {goal}")


@app.command("set")
def set_state(
    node: Node,
    transition: Annotated[
        str,
        typer.Argument(
            help="Transition, such as configure or its number.",
            metavar="TRANSITION",
            autocompletion=lambda incomplete: [each for each in TRANSITIONS if each.startswith(incomplete)],
        ),
    ],
    hidden: Hidden = False,
) -> None:
    """Trigger a transition of a lifecycle node, by name or number."""
    from robolink.cli.lifecycle import ask
    from robolink.cli.shared.output import say
    from robolink.cli.shared.session import looking

    with looking() as context:
        ask.make_transition(context, ask.known(context, node), transition)
    say("Transitioning successful")
