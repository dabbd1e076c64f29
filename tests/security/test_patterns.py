"""Patterns of names: a simple reference agrees, and no pattern takes long, whoever wrote it."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robolink.security.patterns import fits, problem

PARTS = st.sampled_from(["a", "b", "ab", "*", "a*"])


def _fits(wanted: list[str], parts: list[str]) -> bool:
    """Try all lengths of text for each `*`: exponential, and plain to see that it is right."""
    if not wanted or not parts:
        return not wanted and not parts
    first, *others = wanted
    if first == "*":
        return any(_fits(others, parts[length:]) for length in range(1, len(parts) + 1))
    if first.endswith("*"):
        return parts[0].startswith(first[:-1])  # the last, behind which anything may come
    return parts[0] == first and _fits(others, parts[1:])


@given(
    st.lists(PARTS.filter(lambda part: part != "a*"), max_size=5),
    PARTS,
    st.lists(st.sampled_from(["a", "b", "ab", "abc"]), min_size=1, max_size=8),
)
def test_names_fit_as_a_reference_says(inner: list[str], last: str, parts: list[str]) -> None:
    wanted = [*inner, last]
    assert fits("".join(f"/{part}" for part in wanted), "".join(f"/{part}" for part in parts)) is _fits(wanted, parts)


def test_a_pattern_of_stars_ends() -> None:
    """It was tried in more ways than there are atoms: a policy from somebody else would have stopped a node."""
    pattern = "/*" * 100 + "/x"
    assert not problem(pattern)
    assert not fits(pattern, "/a" * 127)
    assert fits(pattern, "/a" * 126 + "/x")


def test_what_is_no_name_fits_no_star() -> None:
    assert not any(fits("/*", name) for name in ("", "/", "//", "a", "/a/", "/a//b"))
    assert not any(fits("/a*", name) for name in ("/a/", "/a//b", "a"))
