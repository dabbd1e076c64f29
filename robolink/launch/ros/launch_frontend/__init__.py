"""What XML and YAML launch files share: their elements, and the tables of the actions and substitutions in them."""
