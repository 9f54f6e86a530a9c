# make tutorial: both lectures, typed into the REPL. make view: the turtle draws a house on a page. make kitchen: a robot sets a table.
# make test: the tests but those that are marked for the soak. make soak: all of them, in their long forms, for hours.
# make docs: the pages with what happens now. make site: the pages as a site, in site/index.html.
# make bench: what things cost, beside their goals and beside others. make bench-compare COMMIT=HEAD~1: this checkout beside that one.
# make house: counts the house and writes docs/explanation/house.md.
# make recorded: what SBCL and its libraries answered, asked again, where they are installed.
# make notebooks OUT=folder: the tutorial as notebooks.
# make course: the course for a browser's tab, as static files in course-site. make pyodide: fetches what that needs from npm.
# The first call of tutorial, view, kitchen or course makes a small environment in .venv; the first call of any other target adds the rest to it.
PYTHON ?= python3
COMMIT ?= release
BIN := .venv/bin
LIGHT := .venv/.light
ROBOT := .venv/.robot
READY := .venv/.ready
PEERS := .venv/.peers

.PHONY: tutorial view kitchen test interpreters recorded house docs notebooks site pyodide course bench bench-compare golden lint soak clean

tutorial: $(LIGHT)
	@$(BIN)/python tutorials/lectures.py --png turtle.png

view: $(LIGHT)
	@$(BIN)/roslisp_repl --view --time virtual --load cram-my-beginner-tutorial --package tut --eval '(start-ros-node "turtle1")' \
	    --eval '(init-ros-turtle "turtle1")' --eval '(perform-draw-house)'

kitchen: $(ROBOT)
	@$(BIN)/python tutorials/kitchen/make_kitchen.py --png kitchen.png --gif kitchen.gif

test: $(READY)
	@$(BIN)/python -m pytest --numprocesses=auto --dist=loadfile --no-loadscope-reorder

interpreters: $(READY)
	@CRAMHY_INTERPRETERS=all $(BIN)/python -m pytest -rs tests/test_interpreters.py

recorded: $(READY)
	@$(BIN)/python tests/recorded.py

house: $(READY)
	@$(BIN)/python tests/docs/house.py

golden: $(READY)
	@$(BIN)/python tests/golden/score.py

docs: $(READY)
	@$(BIN)/python tests/lisp/standard_page.py
	@$(BIN)/python tests/operators/page.py
	@$(BIN)/python tests/operators/differences_page.py
	@$(BIN)/python tests/docs/command_line.py
	@$(BIN)/python tests/docs/pages.py

notebooks: $(READY)
	@$(BIN)/python tests/docs/notebooks.py $(OUT)

site: $(READY)
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

pyodide:
	@cd webassembly && npm ci --ignore-scripts --no-audit --no-fund --silent

course: $(LIGHT) pyodide
	@$(BIN)/cramhy browser --out course-site

bench: $(PEERS)
	@$(BIN)/python benchmarks/table.py
	@for file in benchmarks/*_bench.py; do echo "== $$file"; $(BIN)/python $$file; done

bench-compare: $(READY)
	@$(BIN)/python benchmarks/compare.py $(COMMIT) $(ARGUMENTS)

soak: $(READY)
	@CRAMHY_SOAK=1 $(BIN)/python -m pytest
	@CRAMHY_LATE=$$$$ $(BIN)/python -m pytest -m "soak or not soak" tests/rosbridge tests/ros_tools tests/view tests/chronicle tests/repl tests/actionlib

lint: $(READY)
	@$(BIN)/ruff check src hy_src tests benchmarks tutorials
	@$(BIN)/ruff format --check .

# What the lectures and the page need, and no more. Python compiles what it imports, so pip need not compile everything.
$(LIGHT): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "cramhy needs Python 3.11 or later; try make PYTHON=python3.11")'
	@echo "Making the environment in .venv (once) ..."
	@$(PYTHON) -m venv .venv
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable '.[repl,web,fast]'
	@$(BIN)/python -m pip uninstall -qq --disable-pip-version-check --yes setuptools # which Python 3.11 adds: 10 MB, not needed
	@touch $(LIGHT)

# The robot of the kitchen needs MuJoCo and numpy.
$(ROBOT): $(LIGHT)
	@echo "Adding what the kitchen needs to .venv (once) ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable '.[repl,web,fast,robot]'
	@touch $(ROBOT)

# The rest: what tests, pages and wheels are made with.
$(READY): $(LIGHT)
	@echo "Adding what tests and pages need to .venv (once) ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(ROBOT) $(READY)

# What the benchmarks look at beside ours. Without network they run without it.
$(PEERS): $(READY)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check trio simpy py_trees || echo "Not all peers are to be had here."
	@touch $(PEERS)

clean:
	rm -rf .venv .pytest_cache .hypothesis site course-site
