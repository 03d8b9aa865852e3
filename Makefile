# Two targets matter: `make run` and `make test`. What they need is installed into .venv and node_modules
# of this folder, once; a later run only looks at the stamps.

HOST = 127.0.0.1
PORT = 8000
PYTEST_ARGS ?=
# A file of tests stays on one worker; PYTEST_WORKERS=0 runs all of them in one process.
PYTEST_WORKERS ?= auto

VENV := .venv
BIN := $(VENV)/bin
NPM_FLAGS := --no-package-lock --no-audit --no-fund --no-update-notifier --loglevel=error
# the newest python3 that will do
PYTHON ?= $(shell for p in python3.13 python3.12 python3.11 python3; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && { echo $$p; break; }; done)

export PIP_DISABLE_PIP_VERSION_CHECK = 1
# One test process a core is enough.
export OPENBLAS_NUM_THREADS = 1

.PHONY: help run test fix lock clean need-node need-chromium lint types imports js pytest
.DEFAULT_GOAL := help

help:
	@echo "make run          make the environment and start the server; HOST=0.0.0.0 PORT=8080 to change where"
	@echo "make test         everything that must pass: style, types, import arrows, JavaScript, all tests"
	@echo "make pytest       the tests alone; PYTEST_ARGS='tests/engine -k margins' for some of them"
	@echo "make fix          format the Python code and mend what ruff can"
	@echo "make lock         write requirements.lock anew from the newest versions"
	@echo "make clean        remove .venv, node_modules and what the tools left"

# --- run -----------------------------------------------------------------------------------------------

run: $(VENV)/.stamp-run node_modules/.stamp-run
	@$(BIN)/looplab serve --host $(HOST) --port $(PORT)

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "looplab needs Python 3.11 or newer (Debian: apt-get install python3 python3-venv)" >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
		echo "$(PYTHON) cannot make a virtual environment (Debian: apt-get install python3-venv)" >&2; exit 1; }

$(VENV)/.stamp-run: pyproject.toml requirements.lock | $(BIN)/python
	@echo "Installing looplab into $(VENV) (the first time takes a minute or two) ..."
	@$(BIN)/python -m pip install --quiet -c requirements.lock --editable .
	@touch $@

# The small Plotly bundle makes pages load three times faster; without npm the pip package's own serves.
node_modules/.stamp-run: package.json
	@mkdir -p node_modules
	@if command -v npm >/dev/null; then \
		npm install --omit=dev --fetch-retries=0 $(NPM_FLAGS) </dev/null \
			|| echo "npm did not get the small Plotly bundle; serving the pip package's instead"; \
	fi
	@touch $@

# --- test ----------------------------------------------------------------------------------------------

test: need-node need-chromium lint types imports js pytest

$(VENV)/.stamp-dev: pyproject.toml requirements.lock | $(BIN)/python
	@echo "Installing looplab and its test tools into $(VENV) ..."
	@$(BIN)/python -m pip install --quiet -c requirements.lock --editable '.[dev]'
	@touch $@ $(VENV)/.stamp-run

node_modules/.stamp-dev: package.json
	@npm install $(NPM_FLAGS) </dev/null
	@touch $@ node_modules/.stamp-run

need-node:
	@command -v node >/dev/null && command -v npm >/dev/null || { \
		echo "make test checks the pages' JavaScript with node and npm (Debian: apt-get install nodejs npm)" >&2; exit 1; }

need-chromium:
	@command -v "$${LOOPLAB_CHROMIUM:-chromium}" >/dev/null || { \
		echo "make test drives the pages in Chromium (Debian: apt-get install chromium; elsewhere: LOOPLAB_CHROMIUM=/path/to/it)" >&2; exit 1; }

lint: $(VENV)/.stamp-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.stamp-dev
	$(BIN)/mypy

imports: $(VENV)/.stamp-dev
	$(BIN)/lint-imports

js: need-node node_modules/.stamp-dev
	node_modules/.bin/tsc --project tsconfig.json
	node_modules/.bin/oxlint web

pytest: $(VENV)/.stamp-dev node_modules/.stamp-dev
	$(BIN)/python -m pytest --numprocesses $(PYTEST_WORKERS) --maxprocesses 4 --dist loadfile --no-loadscope-reorder $(PYTEST_ARGS)

# --- upkeep --------------------------------------------------------------------------------------------

fix: $(VENV)/.stamp-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

lock:
	rm -rf build/lock
	$(PYTHON) -m venv build/lock
	build/lock/bin/pip install --quiet '.[dev]'
	build/lock/bin/python tests/packaging/write_lock.py > build/requirements.lock
	mv build/requirements.lock requirements.lock
	rm -rf build/lock

clean:
	rm -rf $(VENV) node_modules build dist .mypy_cache .pytest_cache .ruff_cache .import_linter_cache
