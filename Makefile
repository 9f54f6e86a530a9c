# make tutorial: both lectures, typed into the REPL. make view: the turtle draws a house on a page. make test: everything.
# make docs: the pages with what happens now. make site: the pages as a site, in site/index.html.
# The first call of any of them makes the environment.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.ready

.PHONY: tutorial view test docs site bench golden lint soak clean

tutorial: $(READY)
	@$(BIN)/python tutorials/lectures.py --png turtle.png

view: $(READY)
	@$(BIN)/roslisp_repl --view --time virtual --load cram-my-beginner-tutorial --package tut --eval '(start-ros-node "turtle1")' \
	    --eval '(init-ros-turtle "turtle1")' --eval '(perform-draw-house)'

test: $(READY)
	@$(BIN)/python -m pytest --numprocesses=auto --dist=loadfile --no-loadscope-reorder

golden: $(READY)
	@$(BIN)/python tests/golden/score.py

docs: $(READY)
	@$(BIN)/python tests/lisp/standard_page.py
	@$(BIN)/python tests/operators/page.py
	@$(BIN)/python tests/docs/command_line.py
	@$(BIN)/python tests/docs/pages.py

site: $(READY)
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

bench: $(READY)
	@for file in benchmarks/*_bench.py; do echo "== $$file"; $(BIN)/python $$file; done

soak: $(READY)
	@CRAMHY_SOAK=1 $(BIN)/python -m pytest
	@CRAMHY_LATE=$$$$ $(BIN)/python -m pytest tests/rosbridge tests/ros_tools tests/view tests/chronicle tests/repl tests/actionlib

lint: $(READY)
	@$(BIN)/ruff check src hy_src tests benchmarks tutorials
	@$(BIN)/ruff format --check .

$(READY): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "cramhy needs Python 3.11 or later; try make PYTHON=python3.11")'
	@echo "Making the environment in .venv (once) ..."
	@$(PYTHON) -m venv .venv
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(READY)

clean:
	rm -rf .venv .pytest_cache .hypothesis site
