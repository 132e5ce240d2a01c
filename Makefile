# Everything runs in .venv, which the first target asked for makes: python3 (3.11 or later) and make are enough.

PYTHON ?= python3
BIN := .venv/bin
# Processes that share the tests: all cores unless told otherwise, as in `make test CORES=1`.
CORES ?= auto
# Drawings of each package that `make bench-files` takes; all if empty.
SAMPLE ?= 300
# Random results of each kind that `make check-removal` and `make check-geometry` work out again.
NUMBER ?= 1000

.PHONY: help demo book docs test slow thorough bounds lint bench bench-batch bench-fonts bench-files pictures-files bench-removal check-removal check-geometry methods crossovers accuracy clean

help:  ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-14s %s\n", $$1, $$2 }' Makefile

demo: .venv/installed  ## reduce a drawing and a coastline, and show what happened
	$(BIN)/python examples/demo.py

book: .venv/installed  ## draw all figures and tables of the book on one page, build/book.html
	$(BIN)/python docs/book/book.py

docs: .venv/documented  ## build the site, build/site/index.html: warnings are errors
	$(BIN)/python -m sphinx -E -W --keep-going -q -b html docs build/site

test: .venv/tested  ## run the tests on all cores
	$(BIN)/python -m pytest --numprocesses $(CORES) --dist loadgroup

slow: .venv/tested  ## the tests that compile much or work long, which `make test` leaves out
	$(BIN)/python -m pytest -m slow --numprocesses $(CORES) --dist loadgroup

thorough: .venv/tested  ## all tests, with a thousand new random examples for each property: takes long
	HYPOTHESIS_PROFILE=explore $(BIN)/python -m pytest -m "" --numprocesses $(CORES) --dist loadgroup

bounds: .venv/tested  ## the tests, all compiled and with every index checked, and random periods with knots close together
	KNOTWORK_JIT=always NUMBA_BOUNDSCHECK=1 $(BIN)/python -m pytest -m "" --numprocesses $(CORES) --dist loadgroup
	KNOTWORK_JIT=always NUMBA_BOUNDSCHECK=1 $(BIN)/python tests/test_periodic.py 300000

lint: .venv/linted  ## ruff check, ruff format --check, mypy --strict src
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy --strict src

bench: .venv/tested  ## race this library and the peers that are installed
	$(BIN)/python benchmarks/peers.py

bench-batch: .venv/tested  ## how many tracks a second `batch` reduces, and in how much memory
	$(BIN)/python benchmarks/bulk.py

bench-fonts: .venv/tested  ## points of glyphs beside cu2qu and qu2cu
	$(BIN)/python benchmarks/fonts.py

bench-files: .venv/tested  ## thousands of drawings made lighter, drawn before and after, beside svgo and Inkscape: make bench-files SAMPLE=
	$(BIN)/python benchmarks/drawings.py $(if $(SAMPLE),--sample $(SAMPLE))

pictures-files: .venv/tested  ## drawings and maps before and after, to be looked at: build/pictures
	$(BIN)/python benchmarks/pictures.py

bench-removal: .venv/tested  ## control points that `reduce` leaves, and its time, beside peers
	$(BIN)/python benchmarks/removal.py
	$(BIN)/python benchmarks/removal_shapes.py
	$(BIN)/python benchmarks/removal_surfaces.py

check-removal: .venv/tested  ## bounds of random reductions, worked out again in fractions: make check-removal NUMBER=10000
	$(BIN)/python tests/removal/again.py $(NUMBER)

check-geometry: .venv/tested  ## zeros and crossings of random splines, counted again by Sylvester's resultants and FLINT: make check-geometry NUMBER=100000
	$(BIN)/python tests/sylvester.py $(NUMBER)

methods: .venv/tested  ## race all methods of knot insertion; docs/figures/insertion_study.py draws the result
	$(BIN)/python benchmarks/methods.py

crossovers: .venv/tested  ## measure and print what insert(method="auto") goes by
	$(BIN)/python benchmarks/crossovers.py

accuracy: .venv/tested  ## errors of all methods of knot insertion against exact results
	$(BIN)/python benchmarks/accuracy.py

clean:  ## remove .venv and all that was built
	rm -rf .venv demo build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --upgrade "pip>=25.1"
	$(BIN)/python -m pip install --quiet --editable ".[all]"
	touch $@

.venv/tested: .venv/installed
	$(BIN)/python -m pip install --quiet --group test
	touch $@

.venv/documented: .venv/installed
	$(BIN)/python -m pip install --quiet --group docs
	touch $@

.venv/linted: .venv/tested
	$(BIN)/python -m pip install --quiet --group dev
	touch $@
