# Two commands do everything on a fresh machine: `make demo` and `make test`.
# `make help` lists the others.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
TRY := $(VENV)/.ready-to-try

# An environment of ROS wheels exports these to its children; ours must find its own.
unexport PYTHONPATH LD_LIBRARY_PATH _ROS_WHEELS_BOOTSTRAP_COMPLETE
# Images of containers often set it; each of a thousand processes would then compile every module anew.
unexport PYTHONDONTWRITEBYTECODE
# The matrices are small: two threads of OpenBLAS mostly wait for each other.
export OPENBLAS_NUM_THREADS = 1

.PHONY: help setup demo test lint mypy ruff imports machine-code bench evidence peers recordings docs pictures lock clean

help:  ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## /{printf "make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

setup: $(READY)  ## the environment .venv with everything in it

$(READY): EXTRAS := all
$(READY): SIZE := 260 packages, about 1.3 GB when unpacked, two minutes
$(TRY): EXTRAS := ros,workbench,simulation,fast,gps
$(TRY): SIZE := 160 packages, about 0.9 GB when unpacked, a minute

# pip would compile all packages; Python compiles the modules in use when it first imports them.
$(READY) $(TRY): setup.py setup.cfg constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(0 if (3, 10) <= sys.version_info[:2] <= (3, 13) else "werrimbi_odom needs Python 3.10 to 3.13 (the ROS 2 Jazzy wheels do); try: make PYTHON=python3.12 " + " ".join(sys.argv[1:]))'
	@echo "Setting up $(VENV): ROS 2 Jazzy, scipy, MuJoCo, NiceGUI$(if $(filter all,$(EXTRAS)), and what tests need) come from PyPI, once:"
	@echo "some $(SIZE). All of pip's words: $(VENV)/setup.log"
	@$(PYTHON) -m venv $(VENV)
	@{ $(BIN)/python -m pip install --no-input --disable-pip-version-check --progress-bar off --no-compile \
	    --constraint constraints.txt --editable '.[$(EXTRAS)]' 2>&1; echo "pip ended with $$?"; } \
	  | tee $(VENV)/setup.log | $(PYTHON) -u -c "$$PROGRESS" \
	  || { tail -n 20 $(VENV)/setup.log; exit 1; }
	@touch $(TRY) $@

# What pip says, as one line that counts.
define PROGRESS
import sys
unit = {"MB)": 1.0, "kB)": 1e-3, "bytes)": 1e-6}
screen, count, megabytes, code = sys.stderr.isatty(), 0, 0.0, 0

def tell(words):
    here = f"{count} packages, {megabytes:.0f} MB downloaded{words}"
    print(f"\r  {here:74}" if screen else f"  {here}", end="" if screen else "\n")

for line in sys.stdin:
    words = line.split()
    if words[:1] == ["Downloading"] and ".metadata" not in line and words[-1] in unit:
        megabytes += float(words[-2].strip("(")) * unit[words[-1]]
    elif line.startswith(("Collecting ", "Processing ")):
        count += 1
        if screen or count % 25 == 0:
            tell("")
    elif line.startswith("Installing collected packages"):
        tell("; unpacking them ...")
    elif line.startswith("pip ended with "):
        code = int(words[-1])
print("" if not code else "\npip could not do it; its last words:")
sys.exit(code)
endef
export PROGRESS

demo: $(TRY)  ## ticks through the real node, then a robot that finds out what it lacks; ROBOT=robot.yaml RUN=folder-or-bag for your own
	$(BIN)/python -m werrimbi_odom.demo $(if $(ROBOT),--robot '$(ROBOT)') $(if $(RUN),--run '$(RUN)') --out demo

test: setup  ## linters, then all tests but the long ones
	@$(MAKE) --no-print-directory --jobs 2 --output-sync mypy ruff imports machine-code
	$(BIN)/python -m pytest -m 'not evidence' --numprocesses $$(( $$(nproc) + 1 )) --dist loadfile --no-loadscope-reorder

# mypy takes most of it, and does not wait for the others.
lint: setup
	@$(MAKE) --no-print-directory --jobs 2 --output-sync mypy ruff imports

mypy ruff imports machine-code: setup
mypy:
	$(BIN)/mypy
ruff:
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
imports:
	$(BIN)/lint-imports
machine-code:
	$(BIN)/python -m test.machine_code

bench: setup  ## how fast, as ratios measured side by side
	$(BIN)/python benchmark/core_speed.py
	$(BIN)/python benchmark/piece_tolerance.py
	$(BIN)/python benchmark/node_cost.py
	$(BIN)/python benchmark/diagnosis_hour.py
	$(BIN)/python benchmark/diagnosis_four_hours.py
	$(BIN)/python benchmark/draft.py
	$(BIN)/python benchmark/page_hour.py

evidence: setup  ## the long tests: fresh hidden effects (to docs/evidence.md; ALL=1: all of them), many seeds, soaks
	$(BIN)/python -m test.hidden
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[docs,release]'
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[evidence]' || echo "no atheris for this Python: tests that need it will skip"
	$(BIN)/python -m pytest -m evidence

peers: setup  ## general learners (SINDy, boosting, a Gaussian process) on the same hidden effects, to docs/peers.md
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[peers]'
	$(BIN)/python -m test.hidden.peers

recordings: setup  ## run folders of real robots, from public repositories (docs/real_robots.md), to recordings/
	$(BIN)/python -m test.recorded_robots.make_runs

docs: setup  ## the site of docs/ and of the docstrings, to build/site/index.html
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[docs]'
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs build/site
	@echo "build/site/index.html"

pictures: setup  ## the pictures of the README, made anew (needs Chrome or Chromium)
	$(BIN)/python docs/make_pictures.py
	$(BIN)/python docs/make_scans_picture.py
	$(BIN)/python docs/make_report_pictures.py
	$(BIN)/python docs/make_workbench_pictures.py

lock: setup  ## constraints.txt from what .venv holds
	$(BIN)/python -m pip freeze --exclude-editable --exclude werrimbi_odom | grep -v '@' > constraints.txt

clean:
	rm -rf $(VENV) build install log demo
