"""The forms of the plan language: par, pursue, goals, policies, as functions for every language.

Where the parts are: `operators` par, pursue, try-in-order and their like · `orderings` partial-order · `plans` plan functions and goals ·
`policies` · and for Python `python_forms`, `branch_blocks`, `named_steps`, `plan_run`.
"""
