"""Algorithms of navigation (costmaps, planning, localization, mapping) in numpy: they know no nodes and no clock."""
