# make run     set up .venv, run the redesigned GX120 into runs/gx120, print verdict and report
# make test    set up .venv, run ruff, mypy and the tests
# make verify  the slow tests, or PART="sizes ends" of them; writes docs/verification.md
# make bench   benchmarks, and all of the slow tests of which make verify runs a sample
# make docs    the documentation site, into build/docs/site           make lint  ruff and mypy only
# make fuzz    20,000 mutated input files     make pins   write the pinned figures of the cases anew

PYTHON ?= python3
CASE ?= cases/gx120-redesign.toml
OUT ?= runs/gx120

BIN := .venv/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
# The project is parallel by processes; threads inside them would only fight.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: help setup run test verify docs fuzz pins lint typing bench clean

help:
	@sed -n 's/^# make/make/p' Makefile

setup: .venv/installed typing

.venv/system: scripts/system_libraries.py
	@$(PYTHON) scripts/system_libraries.py
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	@touch $@

.venv/installed: pyproject.toml .venv/system
	@echo "installing into .venv (once, about a minute)"
	@$(PIP) install --editable .
	@touch $@

.venv/developing: .venv/installed
	@$(PIP) install --editable '.[dev]'
	@touch $@

run: .venv/installed
	@$(BIN)/camwright run $(CASE) --out $(OUT) --replace

# Bytecode is kept, since the tests start many processes; files go out in their order, the longest,
# those of tests/end_to_end, first. A process that dies ends the run: with another in its place the
# run would wait for tests that nobody runs. Its status is printed, and all tests run once more.
TESTS := PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -q -m "not slow" -n 2 --dist loadfile \
	--no-loadscope-reorder --max-worker-restart=0

test: lint
	$(TESTS) || if test $$? = 70; then $(TESTS); else exit 1; fi

verify: .venv/developing
	$(BIN)/python tests/slow_parts.py $(PART)

docs: .venv/developing
	$(BIN)/python scripts/build_site.py

fuzz: .venv/developing
	$(BIN)/python tests/mutated_inputs.py 20000

pins: .venv/developing
	$(BIN)/python tests/pins.py

# The package as type checkers look for it.
typing:
	@$(PYTHON) scripts/typing_tree.py

# It ends with status 2 where its processes do not answer within 3 s, as on a busy machine.
MYPY := $(BIN)/mypy

lint: .venv/developing typing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(MYPY) --num-workers 2 || if test $$? = 2; then $(MYPY); else exit 1; fi

bench: .venv/developing
	@set -e; for script in benchmarks/*.py; do echo "== $$script"; $(BIN)/python $$script; done
	$(BIN)/python tests/slow_parts.py whole

clean:
	rm -rf .venv .typing .pytest_cache .mypy_cache .ruff_cache .hypothesis *.egg-info
