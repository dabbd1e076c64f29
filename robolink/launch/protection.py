"""Security of a launched system: keys of what is started beside its nodes, and who is left without."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence

from robolink.exceptions import SecurityError
from robolink.launch.entry import Entry


def check_keys(enclave: str, started: Mapping[str, bool]) -> None:
    """Raise SecurityError, once for all that is started beside the nodes, if it cannot have keys that it must have.

    Args:
        enclave: Its enclave; '' is `/`.
        started: Whether each part of the system is started: by its name for people, such as `recorder`.
    """
    from robolink.networks.asked import domain_id
    from robolink.security import session  # few systems have keys

    names = [name for name, is_started in started.items() if is_started]
    try:
        if names:
            session.wanted(os.environ, domain_id(os.environ), enclave or None)
    except SecurityError as error:
        raise SecurityError(f"--enclave NAME gives the {' and the '.join(names)} keys: {error}") from None


def unprotected(entries: Sequence[Entry], environ: Mapping[str, str]) -> Iterator[str]:
    """Yield a line for the nodes and commands whose `env` switches security off, or lets them do without keys.

    Nothing is said where security is on neither in the environment nor for any of them.

    Args:
        entries: Nodes and commands of a system.
        environ: Environment of the launcher.
    """
    if not any(name.startswith("ROS_SECURITY_") for each in entries for name in each.node.env):
        return
    from robolink.security import session

    for variable, strong, weak, what in (
        (session.ENABLE, "true", "false", "is off for {}"),
        (session.STRATEGY, "enforce", "permissive", "does not insist on keys for {}"),
    ):
        values = [each.node.env.get(variable) for each in entries]
        if strong not in {(value or "").strip().lower() for value in (environ.get(variable), *values)}:
            continue
        # '' is what is usual, and that is the weak one.
        concerned = [
            each.name
            for each, value in zip(entries, values, strict=True)
            if value is not None and (value.strip().lower() or weak) == weak
        ]
        if concerned:
            names = ", ".join(concerned[:3]) + (f" and {len(concerned) - 3} more" if concerned[3:] else "")
            yield f"security {what.format(names)}: the launch file's `env` sets {variable}"
