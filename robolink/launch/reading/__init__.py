"""From the text of a launch file to the nodes and commands that it stands for: `entries` gives them."""
