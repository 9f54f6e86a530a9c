"""The kitchen's plans in plain Hy: `cram_my_pick_place_tutorial`, file by file, as somebody writes it who knows Hy."""

import hy  # noqa: F401  teaches Python to import the .hy files beside this one
