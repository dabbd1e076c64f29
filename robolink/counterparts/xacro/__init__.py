"""Counterpart of xacro's command: macros of XML, expanded by the package `xacro` of PyPI."""

from robolink.counterparts.xacro.expansion import XacroError, expanded

__all__ = ["XacroError", "expanded"]
