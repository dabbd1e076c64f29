# Every target makes the virtual environment when it is missing: a fresh clone needs nothing but Python. A demo needs
# a quarter of what developers do, so that is installed first, and the rest when something asks for it.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
DEMO := $(VENV)/.demo
READY := $(VENV)/.ready
# Two cores for three processes: one of them waits for robots that drive for two minutes.
PARALLEL ?= -n 3 --dist loadfile --no-loadscope-reorder

# Compiled modules are kept, whatever the environment says: tests start robolink a few hundred times.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: demo test lint types floors check format bench clean

demo: $(DEMO)  ## A robot wanders in a simulated room, until Ctrl-C
	$(BIN)/robolink launch wander

test: $(READY)  ## Every test, on two cores; ARGS go to pytest
	$(BIN)/python -m pytest $(PARALLEL) $(ARGS)

check: lint types floors test  ## What must be green before a commit

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

# What of a system's own calls is there differs by system, and only one of them runs here: the types of the others show
# at least that nothing is called which they lack. Each has a cache of its own, since another system's is worth nothing
# to it. What is unreachable on one system is not on another: only the first looks for that.
types: $(READY)
	$(BIN)/mypy
	$(BIN)/mypy --platform win32 --cache-dir .mypy_cache/win32 --no-warn-unreachable
	$(BIN)/mypy --platform darwin --cache-dir .mypy_cache/darwin --no-warn-unreachable

floors: $(READY)
	$(BIN)/lint-imports

format: $(READY)
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

bench: $(READY)  ## Speed beside peers, in one run each
	$(BIN)/python benchmarks/messaging.py
	$(BIN)/python benchmarks/commands.py
	$(BIN)/python benchmarks/launching.py
	$(BIN)/python benchmarks/executors.py
	$(BIN)/python benchmarks/virtual_time.py
	$(BIN)/python benchmarks/simulator.py
	$(BIN)/python benchmarks/fleet.py
	$(BIN)/python benchmarks/tf2.py

$(DEMO): pyproject.toml
	@$(PYTHON) tools/make.py --venv $(VENV) install-demo

$(READY): pyproject.toml
	@$(PYTHON) tools/make.py --venv $(VENV) install-test

clean:
	rm -rf $(VENV) dist .mypy_cache .pytest_cache .ruff_cache .import_linter_cache
