"""What is looked at while a system runs: the files that its processes are made of, and what they use.

`watch` starts anew what is made of a file that was saved, `imports` finds these files; `resources` measures.
"""
