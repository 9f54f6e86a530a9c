"""Programs that attack whoever grades them. Each is a submission in Python, which prints what it could do, a line for each thing.

`test_sandbox.py` hands them in. A program here knows cramhy, and means harm. ``ESCAPED`` begins a line that no sandbox may let happen.
"""

from pathlib import Path

HERE = Path(__file__).parent
NAMES = sorted(path.stem for path in HERE.glob("*.py") if path.stem != "__init__")


def text(name, **values):
    """The text of an attack. values: what stands in it for ``GIVEN_NAME``."""
    found = (HERE / f"{name}.py").read_text(encoding="utf-8")
    for word, value in values.items():
        found = found.replace(f"GIVEN_{word}", str(value))
    return found
