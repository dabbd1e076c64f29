"""The serialized bytes of every type of the standard packages."""

import hashlib
import importlib
import random
import re

import rclpy.serialization as S
from probe import masked, show

R = random.Random(7)
INT = {
    "uint8": (0, 255),
    "int8": (-128, 127),
    "char": (0, 255),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
}


def one(t):
    if t in INT:
        return R.randint(*INT[t])
    if t == "boolean":
        return R.random() < 0.5
    if t == "octet":
        return bytes([R.randrange(256)])
    if t == "float":
        return R.randrange(-1000, 1000) / 8
    if t == "double":
        return R.uniform(-1e6, 1e6)
    if t.startswith(("string", "wstring")):
        return "".join(R.choice("abcé€ß z") for _ in range(R.randrange(6)))
    p, n = t.split("/")
    return fill(getattr(importlib.import_module(p + ".msg"), n))


def fill(c):
    m = c()
    for f, t in c.get_fields_and_field_types().items():
        s = re.fullmatch(r"sequence<(.*?)(?:, (\d+))?>", t)
        a = re.fullmatch(r"(.*)\[(\d+)\]", t)
        if a and not s:
            v = [one(a[1]) for _ in range(int(a[2]))]
        elif s:
            v = [one(s[1]) for _ in range(R.randrange(min(int(s[2] or 4), 4)))]
        else:
            v = one(t)
        setattr(m, f, v)
    return m


for pkg in "action_msgs builtin_interfaces diagnostic_msgs geometry_msgs lifecycle_msgs nav_msgs rcl_interfaces rosgraph_msgs sensor_msgs service_msgs std_msgs trajectory_msgs type_description_interfaces unique_identifier_msgs visualization_msgs test_msgs".split():
    mod = importlib.import_module(pkg + ".msg")
    for x in sorted(
        x
        for x in dir(mod)
        if x[0].isupper()
        and isinstance(getattr(mod, x), type)
        and "_" not in x
        and "Keyed" not in x
        and "NestedKey" not in x
        and getattr(mod, x).__module__.startswith(pkg + ".msg")
    ):
        R.seed(x)

        def go():
            m = fill(getattr(mod, x))
            b = S.serialize_message(m)
            k = masked(m, b)
            r = S.deserialize_message(b, type(m))
            return (
                len(k) // 2,
                hashlib.sha256(k.encode()).hexdigest()[:16],
                r == m,
                hashlib.sha256(repr(r).encode()).hexdigest()[:16],
            )

        show(f"{pkg}/{x}", go)
