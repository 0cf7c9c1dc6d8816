# Everything a fresh clone needs is Python >= 3.11 with its headers and venv, a C++17 compiler and make.
#
#   make demo     solve the first example with both engines, compare, and say where the report is (AXIS=strong)
#   make test     unit, verification and regression tests, 300 random inputs, and whether every refusal of the
#                 code is reached by them or listed in tests/fuzz/unreached.txt
#   make fuzz     attack it with N random inputs (N=2000); findings in out/fuzz
#   make check    format, lint, types, import contract, sizes, circles of imports
#   make verify   slow verification too, pages with slow frames, another processor's rounding, native code under
#                 sanitizers, lowest and newest versions of what users install, and docs/verification.md written
#                 again
#   make concordance   how far multibody models agree with stored shell results: docs/concordance.md
#   make web      the scripts of all pages from web/ (needs Node with npm)
#   make bench    speed, as ratios within one run
#   make wheel    a wheel in dist/, tested in an environment without a compiler
#   make clean    remove what make made

VENV ?= .venv
PYTHON ?= $(firstword $(foreach p,python3 python3.14 python3.13 python3.12 python3.11 python,\
	$(shell $(p) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $(p))))
BIN := $(VENV)/bin
NATIVE := $(shell find native -type f -name '*.[ch]pp') CMakeLists.txt pyproject.toml
KERNEL_TESTS := tests/unit/core
# one process a core; a file stays in one process, since its tests may share a solution
PARALLEL ?= --numprocesses auto --dist loadfile
DEMO := out/demo
# cases of `make fuzz`; another seed gives other cases
N ?= 2000
SEED ?= 0
# AXIS=strong turns the section of the tube upright
TUBE := $(if $(filter strong,$(AXIS)),out/tube_upright.yaml,examples/01_tube_bending.yaml)
# exact versions for every environment but those of `make verify` that test users' ranges; older versions of pip
# apply PIP_CONSTRAINT to isolated builds too, newer ones (25.3) read a variable of its own
CONSTRAINTS ?= tools/constraints.txt
export PIP_CONSTRAINT := $(abspath $(CONSTRAINTS))
export PIP_BUILD_CONSTRAINT := $(abspath $(CONSTRAINTS))
# with it, every process that a test starts would compile all modules again
unexport PYTHONDONTWRITEBYTECODE
RANGES := build/ranges
SANITIZED := build/sanitized
SANITIZERS_address := address,undefined,float-cast-overflow
SANITIZERS_thread := thread

.PHONY: demo test fuzz check verify concordance bench wheel clean install lowest newest web

demo: $(VENV)/installed $(TUBE)
	$(BIN)/crumple compare $(TUBE) --out $(DEMO) --second-mesh 2
	@echo "Report: $(CURDIR)/$(DEMO)/report.html"

out/tube_upright.yaml: examples/01_tube_bending.yaml
	@mkdir -p out
	sed -e 's/roll: 0 deg /roll: 90 deg/' -e 's/weak axis/strong axis/' $< > $@

test: $(VENV)/installed-test
	$(BIN)/python -m pytest -m "not slow" $(PARALLEL) --sites=build/sites.json
	$(BIN)/python -m tests.fuzz.sites build/sites.json

fuzz: $(VENV)/installed-test
	$(BIN)/python -m tests.fuzz $(N) --seed $(SEED)

check: $(VENV)/installed-test $(VENV)/installed-check
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python tools/sizes.py
	$(BIN)/python tools/circles.py
	$(BIN)/python tools/web.py --check
	$(if $(CONSTRAINTS),$(BIN)/python tools/pinned.py $(CONSTRAINTS))

verify: $(VENV)/installed-test $(SANITIZED)/address/installed $(SANITIZED)/thread/installed lowest newest
	mkdir -p out
	$(BIN)/python -m pytest $(PARALLEL) --durations=40 --figures=out/figures.json
	SLOW_FRAMES=1 $(BIN)/python -m pytest $(PARALLEL) tests/unit/app tests/unit/report tests/unit/cli/test_view.py
	tools/another_processor.sh $(BIN)/python -m pytest -m "not slow" $(PARALLEL)
	$(BIN)/python tools/verification_table.py out/figures.json docs
	tools/sanitized.sh address $(SANITIZED)/address/bin/python -m pytest $(PARALLEL) --durations=40 tests/verification $(KERNEL_TESTS) -m "not slow" --capture=sys
	tools/sanitized.sh thread $(SANITIZED)/thread/bin/python -m pytest $(KERNEL_TESTS) -k "threads or team" --capture=sys
	$(BIN)/python tools/portability.py

concordance: $(VENV)/installed-test
	$(BIN)/python -m tests.concordance judge

bench: $(VENV)/installed-test
	@set -e; for script in tests/benchmark/*.py; do echo "== $$script"; $(BIN)/python $$script; done

web:
	$(PYTHON) tools/web.py

wheel: $(VENV)/installed-wheel
	$(BIN)/python tools/wheel.py

clean:
	rm -rf $(VENV) build dist out

install: $(VENV)/installed

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "Crumple needs Python 3.11 or newer; none was found. Install it, or run: make PYTHON=/path/to/python3 ..."; exit 1; }
	$(PYTHON) -m venv $(VENV)

# what the build needs stays in the environment: so the next build compiles only what changed
$(VENV)/installed-build: tools/extra.py $(BIN)/python $(CONSTRAINTS)
	$(BIN)/python $< build > $(VENV)/build.txt
	$(BIN)/python -m pip install --quiet --requirement $(VENV)/build.txt
	@touch $@

$(VENV)/installed: $(VENV)/installed-build $(NATIVE)
	PATH="$(abspath $(BIN)):$$PATH" $(BIN)/python -m pip install --quiet --no-build-isolation --editable .
	@touch $@

$(VENV)/installed-%: tools/extra.py $(VENV)/installed
	$(BIN)/python $< $* > $(VENV)/$*.txt
	$(BIN)/python -m pip install --quiet --requirement $(VENV)/$*.txt
	@touch $@

# fresh environments with the lowest, and with the newest, versions that pyproject.toml allows.  What an old
# version says of its own newer dependencies is no error of Crumple; what the newest versions say will be one
lowest: PIP_CONSTRAINT = $(RANGES)/lowest/constraints.txt
lowest: WARNINGS = -W default::DeprecationWarning
lowest: export PYTHONWARNINGS = default::DeprecationWarning
newest: PIP_CONSTRAINT =
lowest newest: PIP_BUILD_CONSTRAINT = $(PIP_CONSTRAINT)
lowest newest: $(BIN)/python
	$(BIN)/python -m venv --clear $(RANGES)/$@
	$(if $(PIP_CONSTRAINT),$(RANGES)/$@/bin/python tools/lowest.py > $(PIP_CONSTRAINT))
	$(RANGES)/$@/bin/python -m pip install --quiet --upgrade '.[test]' --config-settings=build-dir=build/ranges-kernels/$@
	$(RANGES)/$@/bin/python -m pip freeze > $(RANGES)/$@/versions.txt
	$(RANGES)/$@/bin/python -m pytest -m "not slow" $(PARALLEL) $(WARNINGS)

# environments that borrow the packages of the first, but not its editable Crumple
$(SANITIZED)/%/installed: $(VENV)/installed-test $(NATIVE) $(shell find src -name '*.py')
	$(BIN)/python -m venv $(@D)
	$(BIN)/python tools/borrow.py $(@D)
	$(@D)/bin/python -m pip install --quiet --no-deps --force-reinstall . \
		--config-settings=build-dir=build/sanitized-kernels/$* \
		--config-settings=cmake.build-type=RelWithDebInfo \
		--config-settings=cmake.define.CRUMPLE_SANITIZE=$(SANITIZERS_$*)
	@touch $@
