# Every target makes the virtual environment when it is missing: a fresh clone needs nothing but Python. A demo needs
# a quarter of what developers do, so that is installed first, and the rest when something asks for it.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
DEMO := $(VENV)/.demo
READY := $(VENV)/.ready
SITE := $(VENV)/.docs
# Four processes for two cores: pages and systems that run in real time wait for much of theirs (7:18; with three 8:26).
PARALLEL ?= -n 4 --dist loadfile --no-loadscope-reorder

# Compiled modules are kept, whatever the environment says: tests start robolink a few hundred times.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: help demo test record docs fast lowest check lint types floors coverage format pages bench hooks node clean

help:  ## This list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/\1\t\2/p' $(MAKEFILE_LIST) | awk -F'\t' '{printf "make %-9s %s\n", $$1, $$2}'

demo: $(DEMO)  ## A robot wanders in a simulated room, in the browser, until Ctrl-C
	$(BIN)/robolink launch wander --view

test: $(READY)  ## Every test, on two cores; ARGS go to pytest
	$(BIN)/python -m pytest $(PARALLEL) $(ARGS)

# Three workers for two cores: little of the time is waiting, and each worker imports all files of tests (eight seconds).
fast: $(READY)  ## Every test that starts no process and is not slow; ARGS go to pytest
	$(BIN)/python -m pytest -n 3 --dist worksteal -m "not processes and not slow" --hypothesis-profile quick $(ARGS)

check: lint types floors test  ## What must be green before a commit: lint, types, floors and test

lint: $(READY)  ## Style and format (ruff)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

# What of a system's own calls is there differs by system, and only one of them runs here: the types of the others show
# at least that nothing is called which they lack. Each has a cache of its own, since another system's is worth nothing
# to it. What is unreachable on one system is not on another: only the first looks for that.
types: $(READY)  ## Types (mypy), as on Linux, Windows and macOS
	$(BIN)/mypy
	$(BIN)/mypy --platform win32 --cache-dir .mypy_cache/win32 --no-warn-unreachable
	$(BIN)/mypy --platform darwin --cache-dir .mypy_cache/darwin --no-warn-unreachable

floors: $(READY)  ## Which room may import which (import-linter)
	$(BIN)/lint-imports

# A few tests of speed fail while lines are counted: the figure counts, not they.
coverage: $(READY)  ## The share of lines that the tests run, processes included; htmlcov/ shows which
	$(BIN)/coverage erase
	-$(BIN)/coverage run -m pytest $(PARALLEL) $(ARGS)
	$(BIN)/coverage combine --quiet
	$(BIN)/coverage html --quiet
	$(BIN)/coverage report --skip-covered --sort cover

format: $(READY)  ## Mend what ruff can mend
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

pages: $(READY)  ## Write the picture of the floors, and a page of all rooms and modules into build/docs
	$(BIN)/python tools/development_docs.py

docs: $(SITE)  ## The documentation site, in English and Portuguese, into build/docs/site
	$(BIN)/python tools/development_docs.py
	$(BIN)/python -m tools.docs_site

# Python 3.10, since later ones have no wheels of some of the lowest versions. What those take of newer ones warns.
lowest:  ## The fast tests with the lowest versions that pyproject.toml allows
	$(PYTHON) -m venv $(VENV)-lowest
	$(PYTHON) tools/lowest.py > $(VENV)-lowest/lowest.txt
	$(VENV)-lowest/bin/python -m pip install --quiet "pip>=25.1"
	$(VENV)-lowest/bin/python -m pip install --quiet --constraint $(VENV)-lowest/lowest.txt --editable . --group dev
	$(VENV)-lowest/bin/python -m pytest -W ignore::DeprecationWarning -n 4 --dist worksteal -m "not processes and not slow" --hypothesis-profile quick $(ARGS)

record: $(READY)  ## The benchmark of record beside all peers, which it installs: writes the tables of README and docs
	$(BIN)/python benchmarks/peers.py --install

bench: $(READY)  ## Speed beside peers, in one run each
	$(BIN)/python benchmarks/messaging.py --all --rounds 3 --seconds 0.3
	$(BIN)/python benchmarks/commands.py
	$(BIN)/python benchmarks/launching.py
	$(BIN)/python benchmarks/securing.py
	$(BIN)/python benchmarks/executors.py
	$(BIN)/python benchmarks/virtual_time.py
	$(BIN)/python benchmarks/simulating.py
	$(BIN)/python benchmarks/simulator.py
	$(BIN)/python benchmarks/camera.py
	$(BIN)/python benchmarks/fleet.py
	$(BIN)/python benchmarks/tf2.py
	$(BIN)/python benchmarks/recording.py
	$(BIN)/python benchmarks/viewing.py
	$(BIN)/python benchmarks/bags.py --rounds 3

$(DEMO): pyproject.toml
	@$(PYTHON) tools/make.py --venv $(VENV) install-demo

$(READY): pyproject.toml
	@$(PYTHON) tools/make.py --venv $(VENV) install-test

$(SITE): pyproject.toml
	@$(PYTHON) tools/make.py --venv $(VENV) install-docs

hooks: $(READY)  ## Have git run ruff before each commit
	$(BIN)/pre-commit install

node:  ## What tests run in node (bag readers, clients of the view), by npm into tests/node/node_modules
	npm install --prefix tests/node --no-package-lock --no-audit --no-fund --loglevel=error

clean:  ## Remove the virtual environment and what the tools keep
	rm -rf $(VENV) tests/node/node_modules dist htmlcov .coverage* .mypy_cache .pytest_cache .ruff_cache .import_linter_cache
