"""Launch files in XML and YAML (`launch.frontend`): their substitutions."""

from robolink.companions.launch.frontend.parse_substitution import parse_substitution

__all__ = ["parse_substitution"]
