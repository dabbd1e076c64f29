"""Helper of the programs: prints one line for each behaviour, the same under a real rclpy and under robolink."""

import time

COMMON = ("Exception", "BaseException", "object", "RobolinkError")


def kind(e):
    """The class of an error with those by which it is caught as well."""
    bases = [c.__name__ for c in type(e).__mro__[1:] if c.__name__ not in COMMON]
    return type(e).__name__ + (f"({','.join(bases)})" if bases else "")


def text(e):
    return " | ".join(str(e).strip().splitlines())


def show(label, f, *a, **k):
    """Call f; print its result's repr, or what it raised."""
    try:
        r = f(*a, **k)
    except BaseException as e:
        print(f"{label}: raises {kind(e)}: {text(e)}", flush=True)
        return None
    print(f"{label}: {r!r}", flush=True)
    return r


def kindof(label, f, *a, **k):
    """Call f; print only the type of its result, or what it raised."""
    try:
        r = f(*a, **k)
    except BaseException as e:
        print(f"{label}: raises {kind(e)}: {text(e)}", flush=True)
        return None
    print(f"{label}: <{type(r).__name__}>", flush=True)
    return r


def typed(label, f, *a, **k):
    """Call f; print repr, or only the type of what it raised."""
    try:
        r = f(*a, **k)
    except BaseException as e:
        print(f"{label}: raises {kind(e)}", flush=True)
        return None
    print(f"{label}: {r!r}", flush=True)
    return r


def took(label, f, *a, unit=0.1, **k):
    """Call f; print its result and how long it took, rounded to units."""
    t = time.monotonic()
    try:
        r = repr(f(*a, **k))
    except BaseException as e:
        r = f"raises {kind(e)}: {text(e)}"
    d = time.monotonic() - t
    print(f"{label}: {r} took {round(d / unit) * unit:.1f}", flush=True)


def say(first, *rest):
    """Print values; the first of several is the label of the others."""
    print(f"{first}:" if rest and isinstance(first, (str, int)) else first, *rest, flush=True)


def until(node_or_ex, cond, limit=5.0):
    """Spin until cond() or limit; returns cond()."""
    import rclpy

    t = time.monotonic()
    while not cond() and time.monotonic() - t < limit:
        if hasattr(node_or_ex, "add_node"):
            node_or_ex.spin_once(timeout_sec=0.05)
        else:
            rclpy.spin_once(node_or_ex, timeout_sec=0.05)
    return bool(cond())


SIZES = {
    "boolean": 1,
    "octet": 1,
    "uint8": 1,
    "int8": 1,
    "char": 1,
    "int16": 2,
    "uint16": 2,
    "int32": 4,
    "uint32": 4,
    "float": 4,
    "int64": 8,
    "uint64": 8,
    "double": 8,
}


def masked(m, data):
    """The hex of a CDR message, '..' where the bytes are padding (Fast CDR leaves junk there)."""
    import importlib
    import re

    used = set(range(4))
    at = 0

    def take(n, align=None):
        nonlocal at
        a = align or n
        at = (at + a - 1) // a * a
        used.update(range(4 + at, 4 + at + n))
        at += n

    def u32():
        nonlocal at
        at = (at + 3) // 4 * 4
        v = int.from_bytes(data[4 + at : 8 + at], "little")
        take(4)
        return v

    def one(t):
        nonlocal at
        if t in SIZES:
            take(SIZES[t])
        elif t.startswith("string"):
            take(u32(), 1)
        elif t.startswith("wstring"):
            for _ in range(u32()):
                take(4)
        else:
            pkg, name = t.split("/")
            cls(getattr(importlib.import_module(pkg + ".msg"), name))

    def cls(c):
        f = c.get_fields_and_field_types()
        if not f:
            take(1)
        for t in f.values():
            s = re.fullmatch(r"sequence<(.*?)(?:, \d+)?>", t)
            a = re.fullmatch(r"(.*)\[(\d+)\]", t)
            if s and not a:
                for _ in range(u32()):
                    one(s[1])
            elif a:
                for _ in range(int(a[2])):
                    one(a[1])
            else:
                one(t)

    cls(type(m))
    data = data[: 4 + at]  # what follows is the room that rmw_fastrtps's estimate left over
    return "".join(f"{b:02x}" if i in used else ".." for i, b in enumerate(data))
