"""Node of a package that pages of the manual speak of."""
