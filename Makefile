# SPDX-License-Identifier: LGPL-2.1-or-later
# Every target makes the environment it needs; nothing else has to be typed.

PYTHON ?= python3
JOBS   ?= 2

BIN    := .venv/bin
STAMP  := .venv/installed.stamp
LOCK   := requirements-dev.lock

.DEFAULT_GOAL := help
.PHONY: help demo paper paper-calibration paper-page test verify bench docs lint lock clean clean-all

help:
	@echo "make demo     the paper's two blades, from case file to sound power"
	@echo "make paper    the paper's study claim by claim, at its size (resumable; half an hour)"
	@echo "make paper-calibration  what the paper leaves open: search and sensitivities (two hours)"
	@echo "make paper-page  the page of the paper, from the runs of its study"
	@echo "make test     the tests, on $(JOBS) processes (JOBS=1 for one)"
	@echo "make verify   the reference checks, written to build/verification.json"
	@echo "make bench    the benchmarks, written to build/benchmarks.json"
	@echo "make docs     the documentation, built in build/docs"
	@echo "make lint     style, types and the layer rule"
	@echo "make lock     pin the newest versions of the dependencies in $(LOCK)"
	@echo "make clean    remove build/, runs/ and caches (make clean-all: .venv too)"
	@echo "PYTHON=python3.12 chooses the interpreter of a new environment"

# The interpreter is looked at before anything is installed; an environment that is there is kept.
$(STAMP): pyproject.toml $(LOCK) tools/check_system.py
	@$(PYTHON) tools/check_system.py
	@$(BIN)/python -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' \
		2>/dev/null || $(PYTHON) -m venv --clear .venv
	@echo "installing the environment in .venv (a few minutes the first time)"
	@$(BIN)/python -m pip install -qq --disable-pip-version-check -r $(LOCK)
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-deps -e .
	@touch $@

demo: $(STAMP)
	$(BIN)/quietblade run --brief cases/paper-aluminium.toml --out runs/paper-aluminium
	$(BIN)/quietblade run --brief cases/paper-composite.toml --out runs/paper-composite
	@$(BIN)/quietblade plot --joint runs/paper-aluminium runs/paper-composite --quiet
	@$(BIN)/quietblade show runs/paper-aluminium
	@$(BIN)/quietblade show runs/paper-composite
	@$(BIN)/quietblade report runs/paper-aluminium
	@$(BIN)/quietblade report runs/paper-composite
	@echo "pictures: runs/paper-aluminium/figures, runs/paper-composite/figures, runs/figures"

paper: $(STAMP)
	$(BIN)/quietblade study cases/paper.toml

# A search that ends for want of evaluations (exit code 2) has its table of the best all the same.
paper-calibration: $(STAMP)
	$(BIN)/quietblade study cases/paper-alignment.toml
	$(BIN)/quietblade study --calibrate cases/paper-calibration.toml || test $$? -eq 2
	$(BIN)/quietblade study --calibrate --reading tensor cases/paper-calibration.toml || test $$? -eq 2
	$(BIN)/quietblade study --sensitivities cases/paper-calibration.toml

# What goes beyond the paper, on a middle mesh, and the page; the study itself: make paper.
paper-page: $(STAMP)
	$(BIN)/python -m tools.paper_beyond
	$(BIN)/quietblade study cases/paper-beyond.toml --out runs/paper/beyond
	$(BIN)/python -m tools.paper_page
	$(BIN)/python -m tools.draw_start

# Many small problems: one thread each, so that processes do not fight for the cores.
test: export OMP_NUM_THREADS = 1
test: export RAYON_NUM_THREADS = 1
test: $(STAMP)
	$(BIN)/python -m pytest -n $(JOBS) --dist loadscope

verify: $(STAMP)
	$(BIN)/python -m verification.run

bench: $(STAMP)
	$(BIN)/python -m benchmarks.run

docs: $(STAMP)
	$(BIN)/python -m verification.report
	$(BIN)/python tools/case_reference.py
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs build/docs
	@echo "documentation: build/docs/index.html"

lint: $(STAMP)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports

lock: $(STAMP)
	$(BIN)/python -m pip install -qq --disable-pip-version-check uv
	$(BIN)/uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest --upgrade \
		--no-emit-index-url --no-annotate --no-header --group dev --group docs pyproject.toml -o $(LOCK)

clean:
	rm -rf build runs docs/_generated
	rm -rf .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache
	find src tests verification benchmarks tools -name __pycache__ -type d -prune -exec rm -rf {} +

clean-all: clean
	rm -rf .venv
