# For users: `make demo` and `make test`. Everything is installed into .venv, pinned and checked by hash.
# A Python other than the first one found that is new enough: make demo PYTHON=/path/to/python3

PYTHON ?= $(shell for p in python3 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11, 2))' 2>/dev/null && echo $$p && exit; done; echo python3)
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --no-input
EDITABLE := $(PIP) install --quiet --no-deps --no-build-isolation -e .
COMPILE := $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
	--no-annotate --no-header --group build --extra all --extra docs --extra test

# Modules are compiled once and kept, whatever the shell says: tests read them in hundreds of processes.
export PYTHONDONTWRITEBYTECODE :=

TOGETHER := -rs --durations 25 --durations-min 5 -n auto --maxprocesses 4 --dist loadscope --no-loadscope-reorder

.DELETE_ON_ERROR:
.PHONY: demo test shapes slow long real check lint types imports docs site notebooks oracle lock page clean

demo: $(VENV)/core.stamp
	@$(BIN)/geocontact demo

# Without checks of shapes at every call, which cost as much as a third of the tests do. As .ci/run calls it after `shapes`,
# with SLOW=too SHAPED=before, slow tests as well, and quick ones of the rooms of `shapes` not once more: each test is
# collected and each sample made once
test: $(VENV)/full.stamp
	@GEOCONTACT_UNCHECKED=1 GEOCONTACT_CHECKED="$(if $(SHAPED),$(SHAPES))" $(BIN)/python -m pytest \
		-m "not shapes and not $(if $(SLOW),long,slow) and not oracle and not real" $(TOGETHER)

# Shapes and types of all arguments are checked while the unit tests of these rooms run
SHAPES := below_knee_prosthesis chain contact data dynamics house/test_checked_shapes.py identify io loads shoulder_exoskeleton \
	standing_up systems trial_checks

shapes: $(VENV)/full.stamp
	@$(BIN)/python -m pytest -m "not slow and not oracle and not real" $(TOGETHER) $(addprefix tests/,$(SHAPES))

# What takes longer than a few seconds: notebooks, whole diagnoses, browsers, long recordings
slow: $(VENV)/full.stamp
	@GEOCONTACT_UNCHECKED=1 $(BIN)/python -m pytest -m "slow and not long and not oracle and not real" $(TOGETHER)

# What lasts longest of it and is not run with every change: before a release
long: $(VENV)/full.stamp
	@GEOCONTACT_UNCHECKED=1 $(BIN)/python -m pytest -m "long and not oracle and not real" $(TOGETHER)

# Needs the real data: $GEOCONTACT_DATA, else ../shared/data
real: $(VENV)/full.stamp
	@$(BIN)/python -m pytest -m "real and not oracle" $(TOGETHER) tests/real

check:
	@.ci/run

lint: $(VENV)/full.stamp
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/full.stamp
	$(BIN)/mypy --strict -p geocontact

imports: $(VENV)/full.stamp
	$(BIN)/lint-imports

# Every notebook run anew, with what is kept of its outputs; some of them: python -m website.notebooks NAME ...
notebooks: $(VENV)/full.stamp
	@$(BIN)/python -m website.notebooks

# The site with every notebook run anew and its pages live: build/docs/html/index.html
docs: $(VENV)/full.stamp
	@$(BIN)/python -m website.pages
	@$(BIN)/python -m website --execute
	@echo "open build/docs/html/index.html"

# The same with outputs as kept, for .ci/run, where tests/notebooks runs one notebook and looks at all (`make long`
# runs the others); a warning is an error
site: $(VENV)/full.stamp
	@$(BIN)/python -m website

oracle: $(VENV)/oracle.stamp

# Pins stay as they are unless a requirement forces a change; newer versions: make lock UPGRADE=--upgrade
lock: $(BIN)/python
	$(PIP) install --quiet --upgrade uv
	$(COMPILE) $(UPGRADE) pyproject.toml -o requirements.lock
	$(COMPILE) $(UPGRADE) --extra oracle -c requirements.lock pyproject.toml -o requirements-oracle.lock

# The front end of the pages, for those who change it: needs Node; everybody else uses the built file in the package
page:
	cd geocontact/view/page/front && npm ci && npm run build

clean:
	rm -rf $(VENV) geocontact/view/page/front/node_modules build dist demo-result .benchmarks .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find geocontact meshes tests benchmarks -name __pycache__ -prune -exec rm -rf {} +

$(BIN)/python:
	@command -v $(PYTHON) >/dev/null || { echo "$(PYTHON) not found: install Python 3.11.2 or newer" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11, 2))' || \
		{ echo "$(PYTHON) is older than 3.11.2: name a newer one, make demo PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
		{ echo "$(PYTHON) cannot make virtual environments: on Debian and Ubuntu, apt install python3-venv" >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); exit 1; }

# What the demo needs is a third of the whole lock. Python compiles what is imported when it is: all at once takes longer and
# 160 MB. Tests of packages are a tenth of them.
$(VENV)/core.stamp: requirements.lock pyproject.toml | $(BIN)/python
	@echo "Installing the core packages into $(VENV) (once) ..."
	@$(BIN)/python .ci/core_lock.py > $(VENV)/core.lock
	@$(PIP) install --quiet --require-hashes --no-deps --no-compile -r $(VENV)/core.lock
	@$(EDITABLE)
	@$(BIN)/python .ci/lighten.py
	@touch $@

$(VENV)/full.stamp: requirements.lock pyproject.toml | $(BIN)/python
	@echo "Installing all packages of requirements.lock into $(VENV) (once) ..."
	@$(PIP) install --quiet --require-hashes -r requirements.lock
	@$(EDITABLE)
	@touch $(VENV)/core.stamp $@

$(VENV)/oracle.stamp: requirements-oracle.lock $(VENV)/full.stamp
	@echo "Installing the comparison libraries of requirements-oracle.lock into $(VENV) (once) ..."
	@$(PIP) install --quiet --require-hashes -r requirements-oracle.lock
	@touch $@
