"""Common Lisp, in one folder for each part of the standard.

On the ground: data, packages, special variables, conditions, equality, and the table that makes the package COMMON-LISP. Above it
`reader`, `compiler`, `evaluation` (macros, definitions, places), `objects` (CLOS and structures), `types`, `numbers`,
`collections` (lists, arrays, strings, sequences, hash tables), `loop`, `format`, `printer`, `streams`, `files`, `symbols`;
`systems` loads programs, `tools` answers at the prompt, `python` joins the two languages. What a lower part needs of a higher one
goes through `late`.
"""
