# Everything runs in .venv, which the first target asked for makes: python3 (3.11 or later) and make are enough.

PYTHON ?= python3
BIN := .venv/bin

.PHONY: demo test bench race crossovers accuracy lint clean

demo: .venv/installed  ## reduce a coastline and a drawing, and show what happened
	$(BIN)/python examples/demo.py

test: .venv/tested
	$(BIN)/python -m pytest

bench: .venv/tested
	$(BIN)/python benchmarks/run.py

race: .venv/tested  ## all methods of knot insertion and the peers; then docs/figures_insertion_study.py draws them
	$(BIN)/python benchmarks/race.py

crossovers: .venv/tested  ## measure what insert(method="auto") goes by
	$(BIN)/python benchmarks/race.py --crossovers

accuracy: .venv/tested  ## errors of all methods of knot insertion against exact results
	$(BIN)/python benchmarks/accuracy.py

lint: .venv/linted
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy --strict src

clean:
	rm -rf .venv demo build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --upgrade "pip>=25.1"
	$(BIN)/python -m pip install --quiet --editable ".[all]"
	touch $@

.venv/tested: .venv/installed
	$(BIN)/python -m pip install --quiet --group test
	touch $@

.venv/linted: .venv/tested
	$(BIN)/python -m pip install --quiet --group dev
	touch $@
