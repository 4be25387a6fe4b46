# Two commands do everything: `make demo` and `make test`.
PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin

.DEFAULT_GOAL := help
.PHONY: help demo test coverage lint pages docs bench sealed release lock clean

help:
	@echo "make demo   install, run a small simulated campaign, analyse it, write a report to demo/"
	@echo "make test   install and run the tests, but for those that take long"
	@echo "make coverage  run the tests, say which lines they run; .coverage says by which test"
	@echo "make lint   formatting, types, imports"
	@echo "make pages  write the pages that are made from the code, once it has changed"
	@echo "make docs   build the pages as a site in site/, every warning an error"
	@echo "make bench  draw many inputs for the tests, measure speed and coverage, write benchmarks/results/"
	@echo "make sealed answer and score campaigns whose truth is withheld (an hour and more)"
	@echo "make release  run the tests that take long, build wheel and source distribution, use each from a fresh environment"
	@echo "make lock   write the locks anew, once dependencies or their versions have changed"
	@echo "make clean  remove the virtual environment and what the demo wrote"

# What each lock adds to comes with it; an installation marks the smaller ones in it as done.
$(VENV)/.user $(VENV)/.dev $(VENV)/.docs $(VENV)/.bench $(VENV)/.sealed: pyproject.toml $(wildcard lock/*.txt)
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip uninstall -qqq --yes pmm  # its name before, whose entry points would stay
	$(BIN)/python -m pip install --quiet --no-deps --require-hashes --requirement lock/$(@:$(VENV)/.%=%).txt
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	@touch $(VENV)/.user $(if $(filter %.user,$@),,$(VENV)/.dev) $@

# The locks anew, once pyproject.toml or constraints.txt have changed.
lock: $(VENV)/.dev
	$(BIN)/python -m pip install --quiet uv
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python lock/make.py

demo: $(VENV)/.user
	$(BIN)/pmm demo --output demo

# A file's tests stay together: what they prepare is prepared once. Files go in the order of their
# names: those of few and long tests would else be left for the end. The tests share the cores, so a
# library's own threads would only get in each other's way. Commands that they start find compiled
# sources, whatever the environment says.
WORKERS := -n auto --dist loadfile --no-loadscope-reorder
PYTEST  := env -u PYTHONDONTWRITEBYTECODE OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 \
	$(BIN)/python -m pytest $(WORKERS)
test: $(VENV)/.dev
	$(PYTEST)

# A context for each test: `python -m benchmarks.mutants` asks which tests run a line.
coverage: $(VENV)/.dev
	$(PYTEST) -m "" --cov --cov-context=test --cov-report=term:skip-covered

lint: $(VENV)/.dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports

# Effects, errors and plan checks are made from the code; tests hold them to it.
pages: $(VENV)/.dev
	$(BIN)/python docs/effects.py
	$(BIN)/python docs/errors.py
	$(BIN)/python docs/plan_checks.py

docs: $(VENV)/.docs
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --quiet --jobs auto docs site

# First the tests that draw their inputs, with many more of them than `make test` draws.
bench: $(VENV)/.bench
	$(PYTEST) -m hypothesis --hypothesis-profile=full
	$(BIN)/python -m benchmarks

# First the tests of what makes and scores the campaigns. Scored once for each commit: the commit's
# hash is the seed. Goes on where it was broken off.
sealed: $(VENV)/.sealed
	$(PYTEST) -m "" tests/sealed
	$(BIN)/python -m tests.sealed whole --commit $$(git rev-parse HEAD) --output board --left-out 100

# First the tests that take long. Of a commit a step is done once: goes on where it was broken off.
release: $(VENV)/.dev
	$(PYTEST) -m slow
	$(BIN)/python -m benchmarks.release

clean:
	rm -rf $(VENV) demo site docs/api/*/
