"""Fields, constants and texts of every type of the standard packages."""

import importlib

from probe import say, typed

for pkg in "action_msgs builtin_interfaces diagnostic_msgs geometry_msgs lifecycle_msgs nav_msgs rcl_interfaces rosgraph_msgs sensor_msgs service_msgs std_msgs std_srvs trajectory_msgs type_description_interfaces unique_identifier_msgs visualization_msgs".split():
    for kind_ in ("msg", "srv", "action"):
        try:
            m = importlib.import_module(f"{pkg}.{kind_}")
        except ImportError:
            say(f"{pkg}.{kind_}: none")
            continue
        names = sorted(
            x
            for x in dir(m)
            if x[0].isupper()
            and isinstance(getattr(m, x), type)
            and "_" not in x
            and getattr(m, x).__module__.startswith(f"{pkg}.{kind_}")
        )
        say(f"attr {pkg}.{kind_}: {names}")
        if kind_ == "msg":
            for x in names:
                c = getattr(m, x)
                typed(
                    f"{pkg}/{x}",
                    lambda: (
                        c.get_fields_and_field_types(),
                        sorted(
                            (k, getattr(c, k))
                            for k in dir(c)
                            if k.isupper() and k != "SLOT_TYPES" and not k.startswith("_")
                        ),
                        repr(c()),
                    ),
                )
        if kind_ == "srv":
            for x in names:
                c = getattr(m, x)
                typed(
                    f"{pkg}/{x}",
                    lambda: (
                        c.Request.get_fields_and_field_types(),
                        c.Response.get_fields_and_field_types(),
                        sorted(
                            (k, getattr(c.Response, k))
                            for k in dir(c.Response)
                            if k.isupper() and k != "SLOT_TYPES" and not k.startswith("_")
                        ),
                    ),
                )
