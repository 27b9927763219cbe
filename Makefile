# SPDX-License-Identifier: LGPL-2.1-or-later
#
# Every target provides by itself what it runs with: FreeCAD by tools/freecad, the linters in .venv.

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.PHONY: help demo test slow addon oldest lint format translations fuzz soak conformance linuxcnc package docs release-check clean

PYTHON ?= python3
VENV := .venv
FUZZ_VENV := .venv-fuzz
TRANSLATIONS_VENV := .venv-translations
PACKAGE_VENV := .venv-package
OLDEST_VENV := .venv-oldest
OLDEST ?= yes
OLDEST_TESTS ?= tests/test_executors.py tests/cli/test_batch.py tests/test_numpy_names.py tests/report \
	tests/machine/kinematics/test_jacobian.py tests/certificate/test_certify.py tests/system/test_decimals.py \
	tests/writing/controllers/test_posted_controllers.py
# NumPy 1.26 has wheels for Python up to 3.12: the first such Python on the path, or nothing.
FIND_OLDEST = for python in python3 python3.12 python3.11; do \
	$$python -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 13))' 2>/dev/null && echo $$python && break; done
DOCS_VENV := .venv-docs
CONFORMANCE := .conformance
NPM_PACKAGES := kaitai-struct-compiler@0.11.0 kaitai-struct@0.11.0 js-yaml@5.5.0
FUZZ_SECONDS ?= 120
SOAK_DOWNLOADS ?= 10000
SOAK_KILLS ?= 1000
SOAK_PLAYS ?= 60
OUT ?= out
ARGS ?=

# FreeCAD keeps compiled modules whatever this says; the processes that its tests start shall find and keep them, too.
unexport PYTHONDONTWRITEBYTECODE

# FreeCAD with the add-on, as with an add-on that is installed. It starts with default settings, so that
# neither the user's own nor those of an earlier run decide what comes out.
define FREECAD
settings=$$(mktemp -d); trap 'rm -rf "$$settings"' EXIT; \
export FREECAD_USER_HOME=$$settings MPLBACKEND=Agg; \
tools/freecad -M "$$PWD" tools/run_script.py --
endef

help: ## print this list
	@echo "make TARGET, where TARGET is one of"
	@sed -n 's/^\([a-z-]*\):.*## /  \1\t/p' Makefile | expand -t 16
	@echo "PKM_FREECAD=1.0 or 1.1 chooses the FreeCAD; 'tools/freecad --help' tells which one it is otherwise."

demo: export PKM_MODULES = numpy matplotlib
demo: ## post-process the tapered column; its files and pictures are in out/ then (OUT=directory)
	@$(FREECAD) examples/tapered_column/demo.py --out "$(OUT)"

test slow: export PKM_MODULES = numpy lark serial paramiko pytest hypothesis matplotlib
test: ## run the tests but slow ones inside FreeCAD, then `make oldest` (ARGS="-k feed -x": these, slow or not; OLDEST=no)
	@$(FREECAD) tools/run_tests.py $(if $(ARGS),$(ARGS),-m "not slow")
	@$(if $(ARGS),,$(if $(filter yes,$(OLDEST)),$(if $(shell $(FIND_OLDEST)),$(MAKE) --no-print-directory oldest,\
		echo "Not run: make oldest, since NumPy 1.26 has no wheel for Pythons beyond 3.12, and there is no other.")))

slow: ## run the slow tests inside FreeCAD: long series, damage of every kind, programs played to their end
	@$(FREECAD) tools/run_tests.py -m slow

lint: $(VENV)/made ## check style, layout and types
	@failed=0; \
	for check in "ruff check" "ruff format --check" mypy "shellcheck tools/freecad tools/freecad_root .ci/run"; do \
		echo "$$check"; $(VENV)/bin/$$check || failed=1; \
	done; exit $$failed

format: $(VENV)/made ## lay out the Python files and sort their imports
	@$(VENV)/bin/ruff check --quiet --select I --fix || true
	@$(VENV)/bin/ruff format

translations: $(TRANSLATIONS_VENV)/made ## gather the texts that users see, and compile their translations
	@find pkm_post/freecad_app pkm_post/freecad_gui -name '*.py' | LC_ALL=C sort >$(TRANSLATIONS_VENV)/sources
	@$(TRANSLATIONS_VENV)/bin/python tools/core_texts.py $(TRANSLATIONS_VENV)/core_texts.py
	@echo $(TRANSLATIONS_VENV)/core_texts.py >>$(TRANSLATIONS_VENV)/sources
	@for texts in resources/translations/*.ts; do \
		$(TRANSLATIONS_VENV)/bin/pyside6-lupdate -silent -no-obsolete -locations none -disable-heuristic sametext \
			-disable-heuristic similartext @$(TRANSLATIONS_VENV)/sources -ts "$$texts"; \
		$(TRANSLATIONS_VENV)/bin/pyside6-lrelease "$$texts"; \
		$(TRANSLATIONS_VENV)/bin/python tools/make_compact_translation.py "$${texts%.ts}.qm"; \
	done

fuzz: $(FUZZ_VENV)/made ## feed the readers with bytes, and verify with trajectories that lie (FUZZ_SECONDS=120)
	@PYTHONPATH=. $(FUZZ_VENV)/bin/python fuzz/part_programs.py -max_total_time=$(FUZZ_SECONDS) \
		-timeout=20 -rss_limit_mb=2048 -print_final_stats=1
	@PYTHONPATH=. $(FUZZ_VENV)/bin/python tests/lying_trajectories.py $(FUZZ_SECONDS)

soak: $(VENV)/made ## sessions and downloads over faulty links, killed posts (SOAK_DOWNLOADS=10000 SOAK_KILLS=1000 SOAK_PLAYS=60)
	@folder=$$(mktemp -d); trap 'rm -rf "$$folder"' EXIT; \
	PYTHONPATH=. $(VENV)/bin/python tests/system/killed_posts.py "$$folder" $(SOAK_KILLS)
	@PYTHONPATH=. $(VENV)/bin/python tests/control/link/soak.py $(SOAK_DOWNLOADS)
	@PYTHONPATH=. $(VENV)/bin/python tests/control/player/soak.py luck $(SOAK_PLAYS)
	@PYTHONPATH=. timeout 600 $(VENV)/bin/python tests/control/player/soak.py links

conformance: $(VENV)/made $(CONFORMANCE)/made ## compile pkmt.ksy with Kaitai's compiler, and read files with it
	@$(VENV)/bin/python tests/writing/trajectory_file/conformance.py $(CONFORMANCE)

linuxcnc: $(VENV)/made ## run both outputs for LinuxCNC in LinuxCNC, without a screen, and compare (where it is installed)
	@PYTHONPATH=. MPLBACKEND=Agg $(VENV)/bin/python tests/linuxcnc/compare.py

package: $(VENV)/made $(PACKAGE_VENV)/made ## build a wheel in dist/, and post G-code and a document with it by pipx run
	@rm -f dist/*.whl
	@$(VENV)/bin/python -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir dist .
	@$(FREECAD) tests/freecad_app/save_one_job.py "$$PWD/$(PACKAGE_VENV)/trial.FCStd"
	@wheel=$$(echo "$$PWD"/dist/*.whl); trial=$$(mktemp -d); trap 'rm -rf "$$trial"' EXIT; \
	run() { "$$pipx" run --quiet --spec "$$wheel[gcode]" pkm-post "$$@"; }; pipx=$$PWD/$(PACKAGE_VENV)/bin/pipx; \
	export PIPX_HOME=$$trial/pipx PIPX_BIN_DIR=$$trial/bin; \
	printf '#!/bin/sh\nFREECADCMD="%s" exec "%s" "$$@"\n' "$${FREECADCMD-}" "$$PWD/tools/freecad" >"$$trial/freecadcmd"; \
	chmod +x "$$trial/freecadcmd"; cp examples/first.ngc $(PACKAGE_VENV)/trial.FCStd "$$trial"; cd "$$trial"; \
	export FREECADCMD="$$trial/freecadcmd"; \
	run machine check example_6tps; \
	run post first.ngc trial.FCStd --tool-length 1=120 --work-offset=0,0,250 --out out; \
	test -s out/first.pmc -a -s out/trial.pmc

addon: ## install an archive of the add-on with FreeCAD's Addon Manager, and post with it
	@mkdir -p dist; tree=$$(git stash create); \
	git archive --format=zip --prefix=pkm-post-main/ --output=dist/pkm-post-addon.zip "$${tree:-HEAD}"
	@trial=$$(mktemp -d); trap 'rm -rf "$$trial"' EXIT; export FREECAD_USER_HOME=$$trial MPLBACKEND=Agg; \
	tools/freecad tools/run_script.py -- tests/addon/install_addon.py dist/pkm-post-addon.zip; \
	tools/freecad tools/run_script.py -- tests/addon/use_addon.py "$$trial"

oldest: $(OLDEST_VENV)/made ## run some tests with the oldest NumPy that is allowed, Dask and MPI (OLDEST_TESTS=tests/planning)
	@PYTHONPATH=. MPLBACKEND=Agg $(OLDEST_VENV)/bin/python -m pytest -q -p no:cacheprovider -n 2 $(OLDEST_TESTS) $(ARGS)

docs: $(DOCS_VENV)/made ## make the pages as a site in site/, with every link checked
	@$(DOCS_VENV)/bin/python tools/make_site.py $(DOCS_VENV)/pages
	@$(DOCS_VENV)/bin/mkdocs build --quiet --strict

release-check: ## say what a release still lacks
	@$(PYTHON) tools/release.py --check

clean: ## remove what the targets left in this directory
	rm -rf out dist $(VENV) $(FUZZ_VENV) $(TRANSLATIONS_VENV) $(PACKAGE_VENV) $(OLDEST_VENV) $(DOCS_VENV) site $(CONFORMANCE) .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -not -path './.git/*' -prune -exec rm -rf {} +

# Kaitai's compiler is a package of npm; it is not needed to use or to test PKM Post, so .ci/run does without.
$(CONFORMANCE)/made: Makefile
	@type -P node npm >/dev/null || { echo "Node.js and npm are needed: sudo apt-get install nodejs npm" >&2; exit 1; }
	@echo "making $(@D)"
	@mkdir -p $(@D) && echo '*' >$(@D)/.gitignore
	@npm install --loglevel=error --no-audit --no-fund --prefix $(@D) $(NPM_PACKAGES) || \
		{ echo "npm could not install $(NPM_PACKAGES): is its registry reachable?" >&2; exit 1; }
	@touch $@

# A virtual environment with the packages of one dependency group of pyproject.toml.
$(OLDEST_VENV)/made: LATEST = 3.12
$(OLDEST_VENV)/made: PYTHON = $(or $(shell $(FIND_OLDEST)),python3)
$(VENV)/made: GROUP = dev
$(FUZZ_VENV)/made: GROUP = fuzz
$(TRANSLATIONS_VENV)/made: GROUP = translations
$(OLDEST_VENV)/made: GROUP = oldest
$(DOCS_VENV)/made: GROUP = docs
$(PACKAGE_VENV)/made: GROUP = package
$(VENV)/made $(FUZZ_VENV)/made $(TRANSLATIONS_VENV)/made $(OLDEST_VENV)/made $(DOCS_VENV)/made $(PACKAGE_VENV)/made: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Python 3.11 or newer is needed: make PYTHON=python3.NN" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] > tuple(map(int, "$(or $(LATEST),9.9)".split("."))))' || \
		{ echo "$(@D) is for Python up to $(LATEST): make PYTHON=python$(LATEST)" >&2; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || \
		{ echo "$(PYTHON) cannot make a virtual environment. Please type: sudo apt-get install python3-venv" >&2; exit 1; }
	@echo "making $(@D)"
	@$(PYTHON) -m venv --clear $(@D)
	@$(@D)/bin/python -c 'import tomllib; \
		print(*tomllib.load(open("pyproject.toml", "rb"))["dependency-groups"]["$(GROUP)"], sep="\n")' >$(@D)/requirements.txt
	@$(@D)/bin/python -m pip install --quiet --disable-pip-version-check --requirement $(@D)/requirements.txt
	@touch $@
