# SPDX-License-Identifier: BSD-3-Clause
# The two commands: `make demo` and `make test`. Each does all the set-up it needs (tools/setup.sh).

JOBS ?= $(shell nproc)
VENV := .venv/bin
# Of the tests in Python, which also wait: for processes, deadlines and sockets.
WORKERS ?= $(shell expr $(JOBS) + 1)
# JOBS processes run beside each other, on matrices that are too small for threads: those of the tests' references took
# five times the processor time with two.
export OPENBLAS_NUM_THREADS := 1

.PHONY: help docs docs-links demo demo-paper test wheels page check fuzz coverage sanitize sanitize-sample mutate damage corpus heavy adversary windows macos kernel conformance bench lint format lock sbom api deb release versions clean

help:  ## what there is to make
	@sed -n 's/^\([a-z-]*\):.*## /  make \1\t/p' $(MAKEFILE_LIST) | expand -t 16

demo:  ## touch the built-in grating, or a file: make demo IMAGE=path OUT=folder
	@tools/setup.sh demo
	@$(VENV)/nanotouch touch $(if $(IMAGE),"$(IMAGE)") $(if $(OUT),--out "$(OUT)")
	@$(VENV)/python -m nanotouch_app.live.offer $(if $(IMAGE),"$(IMAGE)")

demo-paper:  ## the paper's work from scan to push as one film, build/demo-paper/workflow.gif; a minute
	@tools/setup.sh demo
	@$(VENV)/nanotouch workflow --out build/demo-paper --overwrite

docs:  ## the site, with its gallery and the examples of its pages run; warnings are errors; build/docs/index.html
	@tools/setup.sh docs
	@$(VENV)/sphinx-build -q -W --keep-going -b html docs build/docs
	@$(VENV)/sphinx-build -q -W -b doctest docs build/docs/doctest
	@echo "written to build/docs/index.html"

docs-links:  ## whether the links of the site lead somewhere; needs the net
	@tools/setup.sh docs
	@$(VENV)/sphinx-build -q -b linkcheck docs build/docs/linkcheck

test:  ## all tests: C, checks, cross compilers, consumers, Python, the demo
	@tools/setup.sh test
	@cmake --preset dev --log-level WARNING
	@cmake --build --preset dev
	@failed=0; ctest --preset dev -j $(JOBS) || failed=1; $(VENV)/python -m pytest -n $(WORKERS) --dist worksteal || failed=1; exit $$failed

wheels:  ## a wheel for each Python of 3.11 to 3.14 that is here, with a Ceres free of the GPL, tested; PYTHONS=3.11 limits it; build/wheels
	@tools/setup.sh wheels
	@tools/wheels.sh build/wheels $(PYTHONS)

page:  ## the touch in one HTML file, build/page/nanotouch-touch.html; needs node and npm
	@tools/setup.sh page
	@$(VENV)/python apps/page/build.py build/page/nanotouch-touch.html
	@cp build/page/nanotouch-touch.html "$$($(VENV)/python -c 'import nanotouch_app.browser as b; print(b.__path__[0])')"

check: page  ## the page in Chromium: touched, changed, offline, attacked; some minutes
	@nice node --test --test-concurrency=1 tests/page/test_*.mjs

fuzz:  ## random input to each entry of the C library, with sanitizers, going on from the last run: make fuzz HOURS=1; else two minutes
	@tools/setup.sh fuzz
	@cmake --preset fuzz --log-level WARNING
	@cmake --build --preset fuzz
	@tools/fuzz.sh $(or $(HOURS),0.033) $(JOBS)

coverage:  ## lines, branches and MC/DC that the C tests reach, against their floors (docs/assurance.md); a quarter of an hour
	@tools/setup.sh coverage
	@NANOTOUCH_ALL_DRAWS=1 python3 tools/coverage.py --jobs $(JOBS) $(if $(RAISE),--raise) $(if $(MISSING),--missing $(MISSING))

sanitize:  ## clang's address, undefined-behaviour and thread sanitizers over all C tests and those of the Python extensions
	@tools/setup.sh sanitize
	@JOBS=$(JOBS) tools/sanitize.sh all

sanitize-sample:  ## the same over what crosses a border and is soon built: foreign bytes, shared memory, threads; half a minute
	@tools/setup.sh sanitize
	@JOBS=$(JOBS) tools/sanitize.sh sample

mutate:  ## whether the tests notice small faults: a seeded sample of mutants by folder, of C and Python; SEED, COUNT; half an hour
	@tools/setup.sh mutate
	@$(VENV)/python tools/mutate c libnanotouch/control libnanotouch/session libnanotouch/hal --count $(or $(COUNT),100) --seed $(or $(SEED),1)
	@$(VENV)/python tools/mutate python --count $(or $(COUNT),20) --seed $(or $(SEED),1)

damage:  ## 2000 damaged files through the readers of images and curves, and as many scenes, rigs, recordings, messages; COUNT; some minutes
	@tools/setup.sh test
	@$(VENV)/python tests/python/mutations.py --count $(or $(COUNT),2000) --seed $(or $(SEED),1)
	@$(VENV)/python tests/heavy/descriptions.py --count $(or $(COUNT),2000) --seed $(or $(SEED),1)

corpus:  ## 2000 made files with known answers (SEED=first), or every file under a folder against other readers: make corpus DIR=folder
	@tools/setup.sh test
	@$(VENV)/python $(if $(DIR),tests/python/corpus.py $(DIR) $(if $(PAGE),--write $(PAGE)),tests/corpus/generated.py --first $(or $(SEED),1))

heavy:  ## 22 000 random scenes, energy of 1.5 million closed paths, recordings of an hour and under 50 kills, fits without memory; half an hour
	@tools/setup.sh test
	@build/dev/tests/c/test_rheology_loop 100000
	@build/dev/tests/c/test_scene_relaxation 300
	@$(VENV)/python tests/heavy/plans.py --jobs $(JOBS)
	@$(VENV)/python tests/heavy/plan_pairs.py --jobs $(JOBS)
	@$(VENV)/python tests/heavy/refusals.py
	@$(VENV)/python tests/heavy/bridges.py
	@NANOTOUCH_ALL_BRIDGES=1 $(VENV)/python -m pytest -q tests/python/test_bridges.py
	@NANOTOUCH_ALL_DRAWS=1 build/dev/tests/c/test_session_faults_three
	@NANOTOUCH_ALL_DRAWS=1 build/dev/tests/c/test_session_adversary
	@NANOTOUCH_ALL_DRAWS=1 build/dev/tests/c/test_scene_facts
	@NANOTOUCH_LOOP_CASES=24 build/dev/tests/c/test_scan_answer
	@NANOTOUCH_ALL_DRAWS=1 $(VENV)/python -m pytest -q -n $(JOBS) $(shell grep -l '^import draws' tests/python/test_*.py)
	@$(VENV)/python tests/heavy/lines.py
	@$(VENV)/python tests/heavy/extremes.py
	@$(VENV)/python tests/heavy/force_tables.py
	@$(VENV)/python tests/heavy/energy.py
	@$(VENV)/python tests/heavy/deformation.py
	@$(VENV)/python tests/heavy/kills.py
	@$(VENV)/python tests/heavy/hour.py
	@$(VENV)/python tests/heavy/large_map.py
	@$(VENV)/python tests/heavy/push.py
	@$(VENV)/python tests/heavy/rods.py
	@$(VENV)/python tests/heavy/fit_ting.py
	@cmake --preset dev --log-level WARNING
	@cmake --build --preset dev --target test_fit_memory
	@build/dev/tests/c/test_fit_memory every
	@cmake --build --preset dev --target test_session_adversary test_session_mailbox test_session_limits
	@$(VENV)/python tests/heavy/limits.py
	@build/dev/tests/c/test_session_mailbox 1000
	@$(VENV)/python tests/heavy/guarantee.py
	@$(VENV)/python tests/heavy/verdicts.py 300
	@$(VENV)/python tests/heavy/verdicts.py 300 --held-out

adversary:  ## 20 000 runs by all doors of a person (session, live, devices, mailbox) against every printed number; FIRST=seed COUNT=n ROWS=file
	@tools/setup.sh test
	@$(VENV)/python tests/heavy/adversary.py --first $(or $(FIRST),0) --count $(or $(COUNT),20000) $(if $(ROWS),--rows $(ROWS))

windows:  ## a wheel for 64-bit Windows in build/wheels, tested under Wine, and the C tests there; some ten minutes
	@tools/setup.sh windows
	@tools/wheel_windows.sh build/wheels
	@tests/windows/run.sh

macos:  ## the C library and the programs in apps/c for macOS (arm64), compiled and linked by zig; nothing is run
	@tools/setup.sh page
	@PYTHON_WITH_ZIG=$(CURDIR)/$(VENV)/python cmake -S . -B build/macos -G Ninja -DCMAKE_BUILD_TYPE=Release --log-level WARNING \
	  -DCMAKE_TOOLCHAIN_FILE=$(CURDIR)/cmake/toolchains/arm64-apple-darwin.cmake -DBUILD_SHARED_LIBS=ON -DNANOTOUCH_WERROR=ON \
	  -DNANOTOUCH_TESTS=OFF -DNANOTOUCH_FIT=OFF
	@cmake --build build/macos -j $(JOBS)

kernel:  ## the SPI and GPIO drivers, and `nanotouch touch`, on a Linux kernel that runs as a program; builds that kernel once, some minutes; then seconds
	@tools/setup.sh kernel
	@cmake --preset release --log-level WARNING >/dev/null
	@cmake --build --preset release --target test_kernel
	@tests/kernel/run.sh build/release/tests/kernel/test_kernel $(VENV)/python

IIO_TEST = $(if $(shell pkg-config --exists libiio && echo here),test_hal_iio)
conformance:  ## what each backend keeps of the rules in docs/hal.md, as a table
	@tools/setup.sh test
	@cmake --preset release --log-level WARNING >/dev/null
	@cmake --build --preset release --target test_hal_conformance test_hal_mailbox test_hal_spi test_hal_spi_fuse test_session_tapping_converters $(IIO_TEST) >/dev/null
	@$(VENV)/python tools/conformance.py build/release/tests/c $(IIO_TEST:%=build/release/tests/c/%)

bench:  ## what one call costs on this machine; JSON in build/release/tests/bench (docs/speed.md: tests/bench/speed.py)
	@tools/setup.sh test
	@tools/setup.sh bench
	@cmake --preset release --log-level WARNING >/dev/null
	@cmake --build --preset release --target bench
	@$(VENV)/python tests/bench/bench_session.py
	@$(VENV)/python tests/bench/peer_loops.py build/release/tests/bench

# generated tables keep the generator's lines, a part of a kernel the kernel's style
C_FILES = $(filter-out tests/reference/%_table.h apps/mcu/plan.h tests/kernel/spi_bus.c tests/kernel/nanotouch_bus.h, $(shell git ls-files '*.c' '*.h' '*.cpp' '*.hpp'))

lint:  ## format, style and types, without changing anything
	@tools/setup.sh lint
	@$(VENV)/clang-format --dry-run --Werror $(C_FILES)
	@$(VENV)/ruff check .
	@$(VENV)/ruff format --check .
	@$(VENV)/mypy
	@$(VENV)/python -m pytest -q tests/python/test_docs_types.py

format:  ## format all sources
	@tools/setup.sh lint
	@$(VENV)/clang-format -i $(C_FILES)
	@$(VENV)/ruff check --fix-only .
	@$(VENV)/ruff format .

lock:  ## the packages of demo and test by version and SHA-256, tools/lock; needs the net
	@tools/setup.sh demo
	@tools/lock.sh

sbom:  ## the list of parts, CycloneDX, build/sbom.json
	@mkdir -p build
	@python3 tools/sbom.py tools/lock/demo.txt >build/sbom.json

api:  ## the public API of C and Python as two listings, docs/api; a test compares them with the sources
	@tools/setup.sh test
	@$(VENV)/python tools/api.py

deb:  ## Debian packages of the C library, build/packages; needs debhelper
	@tools/deb.sh build/packages

release:  ## all files of a release in build/release-files, each tried where nothing of this checkout is; half an hour; PYTHONS=3.11 limits the wheels
	@tools/release.sh build/release-files $(or $(PYTHONS),3.11 3.12 3.13 3.14)

versions:  ## the oldest and the newest packages that are allowed, tested; needs the net; some minutes
	@tools/setup.sh test
	@tools/versions.sh

clean:  ## forget everything that was built
	@rm -rf build .venv
