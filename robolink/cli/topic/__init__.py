"""Topics on the command line: listing, printing, measuring and publishing them."""
