# Everything a fresh machine needs is Python >= 3.11 and make. `make run` and `make test` set up the rest.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# nothing that is not in a lock, nothing whose hash is another, no script of a package while it installs
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check
LOCKED := $(PIP) install --require-hashes --only-binary :all:
READY := $(VENV)/.installed
DOCS_READY := $(VENV)/.installed-docs

.PHONY: help run test test-all bench bench-batch bench-docs lint types format docs pages reference studies lock campaign fuzz everywhere clean

help:
	@echo "make run       one stop of the paper's wagon, results in outputs/paper-80-liquid/"
	@echo "make test      the tests (a few minutes; the first call also sets up .venv)"
	@echo "make test-all  the tests with the slow studies"
	@echo "make campaign  random wagons and trains, judged: N=1000 TRAINS=50"
	@echo "make bench     slosh beside other ways of computing a stop, in ratios (a quarter of an hour); results in outputs/bench/"
	@echo "make bench-batch  ten thousand stops, make bench-docs: put the last results into docs/speed.md"
	@echo "make lint      ruff, make types: mypy, make format: ruff format"
	@echo "make docs      the manuals as a web site in outputs/docs/"
	@echo "make pages     the pages of the documentation that are made from the code, after a change of it"
	@echo "make studies   the studies of the documentation again (some forty minutes)"
	@echo "make everywhere the same stops with oldest and newest dependencies on every Python found (half an hour)"
	@echo "make lock      the lock files from pyproject.toml (UPGRADE=--upgrade: newer versions too)"
	@echo "make fuzz      100,000 spoilt inputs, or N=... of them (hours); what fails is kept in outputs/fuzz/"
	@echo "make reference recompute the oracle numbers in tests/data with the plain implementation"

$(READY): pyproject.toml requirements.lock
	$(PYTHON) -c 'import sys; sys.exit("slosh needs Python 3.11 or newer; call make PYTHON=python3.11") if sys.version_info < (3, 11) else None'
	$(PYTHON) -m venv $(VENV)
	$(LOCKED) -r requirements.lock
	$(PIP) install --no-deps --no-build-isolation -e .
	touch $(READY)

run: $(READY)
	$(BIN)/slosh run scenarios/paper_80.yaml

# a file of tests stays in one process: what its tests share is computed once
test: $(READY)
	$(BIN)/python -m pytest -m "not slow" -n auto --dist loadfile

test-all: $(READY)
	$(BIN)/python -m pytest

# a fourth of them are compared with finer, stronger and mirrored runs; CAMPAIGN='--seed wagon:17' repeats one
TRAINS ?= 50
campaign: $(READY)
	nice $(BIN)/python -m tests.campaign --wagons $(or $(N),1000) --trains $(TRAINS) $(CAMPAIGN)

# `make test` never runs the benchmarks: their files are not named test_*
PARTS ?= contestants floor scaling startup liquids
BENCH = $(BIN)/python -m pytest -q --benchmark-sort=name --benchmark-columns=median,iqr,rounds

bench: $(READY)
	mkdir -p outputs/bench
	for part in $(PARTS); do \
	  $(BENCH) tests/benchmarks/bench_$$part.py --benchmark-json=outputs/bench/$$part.json || exit 1; \
	done
	$(BIN)/python -m tests.benchmarks

bench-batch: PARTS = batch
bench-batch: bench

bench-docs: $(READY)
	$(BIN)/python -m tests.benchmarks --docs

lint: $(READY)
	$(BIN)/ruff check
	$(BIN)/ruff format --check

types: $(READY)
	$(BIN)/mypy

format: $(READY)
	$(BIN)/ruff format
	$(BIN)/ruff check --fix

# the tools are fetched once; the pages themselves are built without a network
$(DOCS_READY): $(READY) .ci/docs.lock
	$(LOCKED) -r .ci/docs.lock
	touch $(DOCS_READY)

docs: $(DOCS_READY)
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build -f .mkdocs.yml

pages: $(READY)
	$(BIN)/python docs/answers.py
	$(BIN)/python docs/reference.py
	$(BIN)/python docs/gallery.py
	$(BIN)/python docs/notebooks.py

# the locks of all environments with the hashes of their packages; versions stay, but for `make lock UPGRADE=--upgrade`
UPGRADE ?=
COMPILE = $(BIN)/uv pip compile pyproject.toml --quiet --generate-hashes --no-annotate --universal $(UPGRADE) \
  --custom-compile-command "make lock"

lock: $(READY)
	$(COMPILE) --python-version 3.11 --extra dev -o requirements.lock
	$(COMPILE) --python-version 3.11.5 --extra docs -c requirements.lock -o .ci/docs.lock
	$(COMPILE) --python-version 3.11 --extra validation -c requirements.lock -o .ci/validation.lock
	$(COMPILE) --python-version 3.11 --resolution lowest-direct -o .ci/oldest.lock

everywhere: $(READY)
	$(BIN)/python -m tests.everywhere environments

reference: $(READY)
	$(BIN)/python -m tests.reference_code

fuzz: $(READY)
	PYTHONPATH=tests/results $(BIN)/python tests/hostile/fuzzing.py --inputs $(or $(N),100000) --folder outputs/fuzz

studies: $(READY)
	$(BIN)/python docs/identifiability.py
	$(BIN)/python docs/real_brakes.py
	$(BIN)/python docs/train_couplers.py
	$(BIN)/python docs/baffles.py

clean:
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache
